#include "checks.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstdio>
#include <limits>

namespace goshawk::conformance {
namespace {

constexpr double kTolerance = 1e-6;  // [m], [m/s], [m/s^2]
using Point = geometry_msgs::msg::Point;

Vec3 vec(const Point& p) {
  return {p.x(), p.y(), p.z()};
}
Vec3 vec(const geometry_msgs::msg::Vector3& v) {
  return {v.x(), v.y(), v.z()};
}

std::string at(const char* what, std::size_t k, const char* fault, double by) {
  return fmt::format("{} {} {} ({:.3g})", what, k, fault, by);
}

/// The point is in the interior of an occupied voxel, or outside the map.
bool is_blocked(const VoxelGrid& grid, const Vec3& p) {
  const Vec3 g = grid.geometry.to_grid(p);
  const double slack = kTolerance / grid.geometry.resolution_m;
  for (const double side : {-slack, slack}) {  // on a face it belongs to both voxels
    const Vec3 q = g.array() + side;
    if (!grid.grown.test(
            {int(std::floor(q.x())), int(std::floor(q.y())), int(std::floor(q.z()))})) {
      return false;
    }
  }
  return true;
}

/// @return whether the line meets an obstacle, in steps of a twentieth of a voxel
bool is_blocked(const VoxelGrid& grid, const Vec3& a, const Vec3& b) {
  const int steps = 1 + int(std::ceil((b - a).norm() / (0.05 * grid.geometry.resolution_m)));
  for (int k = 0; k <= steps; ++k) {
    if (is_blocked(grid, a + (b - a) * (double(k) / steps))) return true;
  }
  return false;
}

template <typename Message>
std::string fault_of_head(const Message& m, const VoxelGrid& grid) {
  if (m.header().frame_id() != "map") return "its frame is '" + m.header().frame_id() + "'";
  if (m.header().stamp().sec() == 0) return "it has no stamp";
  if (m.implementation().empty()) return "its implementation is empty";
  if (m.map_version() != grid.version) {
    return fmt::format("it names map version {} instead of {}", m.map_version(), grid.version);
  }
  return "";
}

/// @return [m] how far outside; negative inside; infinity if it is not a polytope
double outside(const msg::Polytope& polytope, const Vec3& p) {
  const auto& n = polytope.normals();
  const auto& b = polytope.offsets();
  if (b.empty() || n.size() != 3 * b.size()) return std::numeric_limits<double>::infinity();
  double worst = -std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < b.size(); ++i) {
    const Vec3 normal(n[3 * i], n[3 * i + 1], n[3 * i + 2]);
    const double distance = normal.dot(p) - b[i];
    if (!std::isfinite(distance) || std::abs(normal.norm() - 1.0) > 1e-6) {
      return std::numeric_limits<double>::infinity();
    }
    worst = std::max(worst, distance);
  }
  return worst;
}

// No corner and no centre of an occupied voxel may be inside.
std::string fault_of_space(const msg::Polytope& polytope, std::size_t k, const VoxelGrid& grid) {
  const Index3 size = grid.geometry.size;
  for (int z = 0; z < size.z; ++z) {
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x) {
        if (!grid.grown.get({x, y, z})) continue;
        double deepest = outside(polytope, grid.geometry.center({x, y, z}));
        // Farther than a voxel's diagonal: none of its corners can be in.
        if (deepest > 1.8 * grid.geometry.resolution_m) continue;
        for (int c = 0; c < 8; ++c) {
          const Index3 corner{x + (c & 1), y + (c >> 1 & 1), z + (c >> 2)};
          deepest = std::min(deepest, outside(polytope, grid.geometry.lower_corner(corner)));
        }
        if (deepest < -kTolerance) return at("polytope", k, "holds an obstacle [m]", -deepest);
      }
    }
  }
  return "";
}

// The k-th derivative's control point j of a quintic, from its control points.
Vec3 derivative(const msg::BezierPiece& piece, int order, std::size_t j) {
  const auto& c = piece.control_points();
  if (order == 0) return vec(c[j]);
  const double duration_s = piece.duration();
  if (order == 1) return 5.0 / duration_s * (vec(c[j + 1]) - vec(c[j]));
  if (order == 3) {
    return 60.0 / (duration_s * duration_s * duration_s) *
           (vec(c[j + 3]) - 3.0 * vec(c[j + 2]) + 3.0 * vec(c[j + 1]) - vec(c[j]));
  }
  return 20.0 / (duration_s * duration_s) * (vec(c[j + 2]) - 2.0 * vec(c[j + 1]) + vec(c[j]));
}

/// How much of a limit a vector uses: 1 at the limit.
double usage(const Vec3& v, int norm, double limit, double vertical) {
  using namespace goshawk_msgs::msg::Limits_Constants;
  if (norm == NORM_EUCLIDEAN) return v.norm() / limit;
  if (norm == NORM_PER_AXIS) return v.cwiseAbs().maxCoeff() / limit;
  return std::max(v.head<2>().norm() / limit,
                  std::abs(v.z()) / (vertical > 0.0 ? vertical : limit));
}

std::string fault_of_piece(const msg::BezierPiece& piece, std::size_t k, double begin_s,
                           const std::vector<msg::Polytope>& polytopes, const msg::Limits& limits) {
  if (!(piece.duration() > 0.0)) return at("piece", k, "lasts [s]", piece.duration());
  if (piece.polytope() >= polytopes.size()) {
    return at("piece", k, "names a polytope that does not exist", double(piece.polytope()));
  }
  const msg::Polytope& home = polytopes[piece.polytope()];
  double position = -1.0, velocity = 0.0, acceleration = 0.0, jerk = 0.0;
  for (std::size_t j = 0; j < 6; ++j) {
    position = std::max(position, outside(home, derivative(piece, 0, j)));
    if (j < 5) {
      velocity = std::max(velocity, usage(derivative(piece, 1, j), limits.norm(), limits.v_max(),
                                          limits.v_max_vertical()));
    }
    if (j < 4) {
      acceleration = std::max(acceleration, usage(derivative(piece, 2, j), limits.norm(),
                                                  limits.a_max(), limits.a_max_vertical()));
    }
    if (j < 3) jerk = std::max(jerk, derivative(piece, 3, j).norm());
  }
  if (!(position <= kTolerance)) return at("piece", k, "leaves its polytope [m]", position);
  if (!(velocity <= 1.0 + kTolerance)) return at("piece", k, "is too fast", velocity);
  if (!(acceleration <= 1.0 + kTolerance)) {
    return at("piece", k, "accelerates too much", acceleration);
  }
  if (limits.j_max() > 0.0 && !(jerk <= limits.j_max() + kTolerance)) {
    return at("piece", k, "has too much jerk", jerk);
  }
  if (home.valid_from() == 0.0 && home.valid_until() == 0.0) return "";
  const double by_s =
      std::max(home.valid_from() - begin_s, begin_s + piece.duration() - home.valid_until());
  return by_s <= kTolerance ? "" : at("piece", k, "outlasts its polytope [s]", by_s);
}

double state_error(const msg::FlatState& state, const msg::BezierPiece& piece, bool end) {
  const double p = (derivative(piece, 0, end ? 5 : 0) - vec(state.position())).norm();
  const double v = (derivative(piece, 1, end ? 4 : 0) - vec(state.velocity())).norm();
  const double a = (derivative(piece, 2, end ? 3 : 0) - vec(state.acceleration())).norm();
  return std::max({p, v, a});
}

}  // namespace

std::string fault_of(const msg::Path& path, const msg::PlanRequest& sent, const VoxelGrid& grid) {
  if (auto fault = fault_of_head(path, grid); !fault.empty()) return fault;
  const auto& w = path.waypoints();
  if (w.size() < 2) return fmt::format("it has {} waypoints", w.size());
  if ((vec(w.front()) - vec(sent.start().position())).norm() > kTolerance) {
    return "it does not begin at the start";
  }
  if ((vec(w.back()) - vec(sent.goal().position())).norm() > kTolerance) {
    return "it does not end at the goal";
  }
  for (std::size_t k = 0; k + 1 < w.size(); ++k) {
    if (!vec(w[k]).allFinite()) return at("waypoint", k, "is not finite", w[k].x());
    const double length_m = (vec(w[k + 1]) - vec(w[k])).norm();
    if (length_m > 1000.0) return at("segment", k, "leaves the map [m]", length_m);
    if (is_blocked(grid, vec(w[k]), vec(w[k + 1]))) {
      return at("segment", k, "meets an obstacle [m long]", length_m);
    }
  }
  return "";
}

std::string fault_of(const msg::Corridor& corridor, const msg::Path& sent, const VoxelGrid& grid) {
  if (auto fault = fault_of_head(corridor, grid); !fault.empty()) return fault;
  const auto& w = corridor.waypoints();
  const auto& polytopes = corridor.polytopes();
  if (polytopes.empty() || w.size() != polytopes.size() + 1) {
    return fmt::format("{} polytopes need one waypoint more, but there are {}", polytopes.size(),
                       w.size());
  }
  if ((vec(w.front()) - vec(sent.waypoints().front())).norm() > kTolerance ||
      (vec(w.back()) - vec(sent.waypoints().back())).norm() > kTolerance) {
    return "its ends are not those of the path";
  }
  for (std::size_t k = 0; k < polytopes.size(); ++k) {
    const double out =
        std::max(outside(polytopes[k], vec(w[k])), outside(polytopes[k], vec(w[k + 1])));
    if (!(out <= kTolerance)) return at("polytope", k, "does not hold its waypoints [m]", out);
    if (auto fault = fault_of_space(polytopes[k], k, grid); !fault.empty()) return fault;
  }
  if (polytopes.size() > 1 && !(corridor.min_overlap_radius() > 0.0)) {
    return "its own min_overlap_radius is not above zero";
  }
  return "";
}

std::string fault_of(const msg::BezierTrajectory& t, const msg::Corridor& sent,
                     const VoxelGrid& grid) {
  if (auto fault = fault_of_head(t, grid); !fault.empty()) return fault;
  if (t.pieces().empty()) return "it has no pieces";
  if (!(t.polytopes() == sent.polytopes())) return "its polytopes are not the corridor's";
  const auto& limits = sent.request().limits();
  double begin_s = 0.0;
  for (std::size_t k = 0; k < t.pieces().size(); ++k) {
    const auto& piece = t.pieces()[k];
    if (auto fault = fault_of_piece(piece, k, begin_s, t.polytopes(), limits); !fault.empty()) {
      return fault;
    }
    begin_s += piece.duration();
    if (k == 0) continue;
    for (int order = 0; order < 3; ++order) {
      const double jump = (derivative(t.pieces()[k - 1], order, std::size_t(5 - order)) -
                           derivative(piece, order, 0))
                              .norm();
      if (!(jump <= kTolerance))
        return at("piece", k, "is not continuous with the previous piece", jump);
    }
  }
  const double start = state_error(sent.request().start(), t.pieces().front(), false);
  if (!(start <= kTolerance)) return at("piece", 0, "does not begin in the start state", start);
  const double goal = state_error(sent.request().goal(), t.pieces().back(), true);
  if (!(goal <= kTolerance)) return at("the end", 0, "is not the goal state", goal);
  const auto& c = t.certificate();
  if (!(std::max({c.position(), c.velocity(), c.acceleration()}) <= kTolerance)) {
    return "its own certificate does not hold";
  }
  return "";
}

}  // namespace goshawk::conformance
