#include "goshawk/core/polytope.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace goshawk {
namespace {

using Vec4 = Eigen::Vector4d;

// Maximise r subject to n . x + r <= b: a linear programme in (x, r). Solved by the simplex
// method on its dual, whose basis is four constraints and whose multipliers are the current
// (x, r): the constraint most violated by it enters. Starts from a tetrahedron so large that it
// only stays in the basis where the polytope is unbounded.
//
// The inverse of the basis is kept and corrected by one pivot an iteration; it is computed anew
// before the answer is believed, and after every few pivots, so that rounding does not gather.
class LargestBall {
 public:
  explicit LargestBall(std::span<const HalfSpaces> polytopes) : polytopes_(polytopes) {}

  Ball solve() {
    if (!finite()) return {Vec3::Zero(), -std::numeric_limits<double>::infinity()};
    start();
    bool fresh = true;  // nothing was pivoted since the inverse was computed
    for (int iteration = 0; iteration < 1000; ++iteration) {
      // Most violated first (few iterations); after many, first violated (cannot cycle for long).
      if (!find_entering(iteration > 200)) {
        if (fresh) break;
        refresh();
        fresh = true;
        continue;
      }
      if (!pivot()) break;
      fresh = iteration % kPivotsUntilRefresh == kPivotsUntilRefresh - 1;
      if (fresh) refresh();
    }
    // The simplex method comes from outside: whatever rounding, or the iteration limit, left
    // undone, the ball that is returned is inside.
    return {point_.head<3>(), std::min(point_[3], room_at(point_.head<3>()))};
  }

 private:
  static constexpr int kPivotsUntilRefresh = 24;

  bool finite() const {
    return std::ranges::all_of(polytopes_, [](const HalfSpaces& p) {
      using Row = Eigen::Map<const Eigen::VectorXd>;
      return p.count >= 0 && Row(p.normals, 3 * p.count).allFinite() &&
             Row(p.offsets, p.count).allFinite();
    });
  }

  void start() {
    const double far = 1e6;
    const double s = 1.0 / std::sqrt(3.0);
    basis_ << -1, 0, 0, 1, 0, -1, 0, 1, 0, 0, -1, 1, s, s, s, 1;
    bound_.setConstant(far);
    refresh();
  }

  void refresh() {
    inverse_ = basis_.inverse();
    point_ = inverse_ * bound_;
  }

  // Distance to the nearest face, negative outside.
  double room_at(const Vec3& p) const {
    double room = std::numeric_limits<double>::infinity();
    for (const HalfSpaces& polytope : polytopes_) {
      const double* n = polytope.normals;
      for (int i = 0; i < polytope.count; ++i, n += 3) {
        room = std::min(room, polytope.offsets[i] - (n[0] * p[0] + n[1] * p[1] + n[2] * p[2]));
      }
    }
    return room;
  }

  // The entering constraint takes the place of one of the basis. @return false where none can
  // leave, which finite data do not allow: the dual is bounded
  bool pivot() {
    const Vec4 direction = inverse_.transpose() * entering_;
    const int leaving = find_leaving(inverse_.row(3).transpose(), direction);
    if (leaving < 0) return false;
    const Vec4 column = inverse_.col(leaving) / direction[leaving];
    point_ -= (entering_.dot(point_) - entering_bound_) * column;
    Vec4 change = direction;
    change[leaving] -= 1.0;
    inverse_.noalias() -= column * change.transpose();
    basis_.row(leaving) = entering_;
    bound_[leaving] = entering_bound_;
    return true;
  }

  // Ratio test. Boxes make ties the rule (weights of zero); of those the largest pivot leaves,
  // which keeps the basis far from singular.
  static int find_leaving(const Vec4& weights, const Vec4& direction) {
    constexpr double smallest = 1e-9;
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 4; ++i) {
      if (direction[i] > smallest) {
        least = std::min(least, std::max(0.0, weights[i]) / direction[i]);
      }
    }
    int leaving = -1;
    for (int i = 0; i < 4; ++i) {
      if (direction[i] <= smallest || weights[i] / direction[i] > least + 1e-12) continue;
      if (leaving < 0 || direction[i] > direction[leaving]) leaving = i;
    }
    return leaving;
  }

  bool find_entering(bool first) {
    double worst = 1e-12 * (1.0 + point_.head<3>().cwiseAbs().maxCoeff());
    const double x = point_[0], y = point_[1], z = point_[2], r = point_[3];
    const double* row = nullptr;
    for (const HalfSpaces& polytope : polytopes_) {
      const double* n = polytope.normals;
      const double* b = polytope.offsets;
      for (int i = 0; i < polytope.count && !(first && row); ++i, n += 3) {
        const double excess = n[0] * x + n[1] * y + n[2] * z + r - b[i];
        if (excess <= worst) continue;
        worst = excess;
        row = n;
        entering_bound_ = b[i];
      }
    }
    if (row) entering_ << row[0], row[1], row[2], 1.0;
    return row != nullptr;
  }

  std::span<const HalfSpaces> polytopes_;
  Eigen::Matrix4d basis_;    // rows are constraints
  Eigen::Matrix4d inverse_;  // of basis_
  Vec4 bound_;
  Vec4 point_;
  Vec4 entering_;
  double entering_bound_ = 0.0;
};

// A negative count where the sizes disagree.
HalfSpaces half_spaces(const Polytope& polytope) {
  static_assert(Polytope::Normals::IsRowMajor);
  const int count = polytope.A.rows() == polytope.b.size() ? polytope.faces() : -1;
  return {polytope.A.data(), polytope.b.data(), count};
}

}  // namespace

void Polytope::add(const Vec3& outward_normal, double offset_m) {
  A.conservativeResize(faces() + 1, 3);
  b.conservativeResize(A.rows());
  A.row(A.rows() - 1) = outward_normal;
  b[A.rows() - 1] = offset_m;
}

Status Polytope::check() const {
  if (A.rows() != b.size() || A.rows() == 0) {
    return fail(ErrorCode::invalid_input, "a polytope has " + std::to_string(A.rows()) +
                                              " normals and " + std::to_string(b.size()) +
                                              " offsets: equal numbers above zero are needed");
  }
  if (!A.allFinite() || !b.allFinite()) {
    return fail(ErrorCode::invalid_input, "a polytope has a face that is not finite");
  }
  if ((A.rowwise().norm().array() - 1.0).abs().maxCoeff() > 1e-6) {
    return fail(ErrorCode::invalid_input, "a polytope has a normal that is not of length 1");
  }
  return success();
}

Polytope Polytope::box(const Vec3& lower_map, const Vec3& upper_map) {
  Polytope polytope;
  polytope.A.resize(6, 3);
  polytope.b.resize(6);
  polytope.A << Eigen::Matrix3d::Identity(), -Eigen::Matrix3d::Identity();
  polytope.b << upper_map, -lower_map;
  return polytope;
}

Ball chebyshev_ball(std::span<const HalfSpaces> polytopes) {
  return LargestBall(polytopes).solve();
}

Ball chebyshev_ball(const Polytope& polytope) {
  const HalfSpaces parts[] = {half_spaces(polytope)};
  return chebyshev_ball(parts);
}

Ball chebyshev_ball(const Polytope& a, const Polytope& b) {
  const HalfSpaces parts[] = {half_spaces(a), half_spaces(b)};
  return chebyshev_ball(parts);
}

double Corridor::min_overlap_radius_m() const {
  double least = std::numeric_limits<double>::infinity();
  for (const Ball& ball : overlaps) {
    if (std::isnan(ball.radius_m)) return ball.radius_m;
    least = std::min(least, ball.radius_m);
  }
  return least;
}

Status Corridor::check() const {
  if (polytopes.empty() || waypoints_map.size() != polytopes.size() + 1 ||
      overlaps.size() + 1 != polytopes.size()) {
    return fail(ErrorCode::invalid_input,
                "a corridor of " + std::to_string(polytopes.size()) + " polytopes has " +
                    std::to_string(waypoints_map.size()) + " waypoints and " +
                    std::to_string(overlaps.size()) + " overlaps: n, n + 1 and n - 1 are needed");
  }
  for (std::size_t k = 0; k < overlaps.size(); ++k) {
    if (!is_finite(overlaps[k].center_map) || !std::isfinite(overlaps[k].radius_m)) {
      return fail(ErrorCode::invalid_input, "overlap " + std::to_string(k) + " is not finite");
    }
  }
  for (std::size_t k = 0; k < polytopes.size(); ++k) {
    if (auto status = polytopes[k].check(); !status) {
      return fail(status.error().code,
                  "polytope " + std::to_string(k) + ": " + status.error().message);
    }
    for (const std::size_t end : {k, k + 1}) {
      if (!(polytopes[k].violation(waypoints_map[end]) <= 1e-6)) {
        return fail(ErrorCode::invalid_input,
                    "waypoint " + std::to_string(end) + " " + to_text(waypoints_map[end]) +
                        " lies outside polytope " + std::to_string(k) + " or is not finite");
      }
    }
  }
  return success();
}

}  // namespace goshawk
