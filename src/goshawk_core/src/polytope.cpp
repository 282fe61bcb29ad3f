#include "goshawk/core/polytope.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace goshawk {
namespace {

using Row4 = Eigen::Vector4d;
using Faces = std::span<const HalfSpace>;

// Maximise r subject to n . x + r <= b: a linear programme in (x, r). Solved by the simplex
// method on its dual, whose basis is four constraints and whose multipliers are the current
// (x, r): the constraint most violated by it enters. Starts from a tetrahedron so large that it
// only stays in the basis if the polytope is unbounded.
//
// The inverse of the basis is kept and corrected by one pivot an iteration; it is computed anew
// before the answer is believed, and after every few pivots, so that rounding does not gather.
class LargestBall {
 public:
  explicit LargestBall(std::span<const Faces> polytopes) : polytopes_(polytopes) {}

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
    return std::ranges::all_of(polytopes_, [](const Faces& faces) {
      return std::ranges::all_of(faces, &HalfSpace::is_finite);
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
    for (const Faces& faces : polytopes_) {
      for (const HalfSpace& face : faces) room = std::min(room, -face.distance_m(p));
    }
    return room;
  }

  // The entering constraint takes the place of one of the basis. @return false if none can
  // leave, which finite data do not allow: the dual is bounded
  bool pivot() {
    const Row4 direction = inverse_.transpose() * entering_;
    const int leaving = find_leaving(inverse_.row(3).transpose(), direction);
    if (leaving < 0) return false;
    const Row4 column = inverse_.col(leaving) / direction[leaving];
    point_ -= (entering_.dot(point_) - entering_bound_) * column;
    Row4 change = direction;
    change[leaving] -= 1.0;
    inverse_.noalias() -= column * change.transpose();
    basis_.row(leaving) = entering_;
    bound_[leaving] = entering_bound_;
    return true;
  }

  // Ratio test. Boxes make ties the rule (weights of zero); of those the largest pivot leaves,
  // which keeps the basis far from singular.
  static int find_leaving(const Row4& weights, const Row4& direction) {
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
    const HalfSpace* most = nullptr;
    for (const Faces& faces : polytopes_) {
      for (const HalfSpace& face : faces) {
        const Vec3& n = face.normal;
        const double excess = n[0] * x + n[1] * y + n[2] * z + r - face.offset_m;
        if (excess <= worst) continue;
        worst = excess;
        most = &face;
        if (first) break;
      }
      if (first && most != nullptr) break;
    }
    if (most == nullptr) return false;
    entering_ << most->normal, 1.0;
    entering_bound_ = most->offset_m;
    return true;
  }

  std::span<const Faces> polytopes_;
  Eigen::Matrix4d basis_;    // rows are constraints
  Eigen::Matrix4d inverse_;  // of basis_
  Row4 bound_;
  Row4 point_;
  Row4 entering_;
  double entering_bound_ = 0.0;
};

}  // namespace

double Polytope::violation(const Vec3& p_map) const {
  double worst = -std::numeric_limits<double>::infinity();
  for (const HalfSpace& face : half_spaces) {
    const double distance = face.distance_m(p_map);
    // NaN is the worst of all and stays.
    if (distance > worst || std::isnan(distance)) worst = distance;
  }
  return worst;
}

Status Polytope::check() const {
  if (half_spaces.empty()) return fail(ErrorCode::invalid_input, "a polytope has no face");
  if (!std::ranges::all_of(half_spaces, &HalfSpace::is_finite)) {
    return fail(ErrorCode::invalid_input, "a polytope has a face that is not finite");
  }
  for (const HalfSpace& face : half_spaces) {
    const double length = face.normal.norm();
    if (std::abs(length - 1.0) <= 1e-6) continue;
    return fail(ErrorCode::invalid_input,
                fmt::format("a polytope has a normal of length {:.6g}: it must be 1", length));
  }
  const bool finite = std::isfinite(valid_from_s) && std::isfinite(valid_until_s);
  if (always_valid() || (finite && valid_from_s < valid_until_s)) return success();
  return fail(ErrorCode::invalid_input,
              fmt::format("a polytope is valid from {:.3g} s to {:.3g} s: an interval must end "
                          "after it begins (both 0: always)",
                          valid_from_s, valid_until_s));
}

Polytope Polytope::box(const Vec3& lower_map, const Vec3& upper_map) {
  Polytope polytope;
  polytope.half_spaces.reserve(6);
  for (int i = 0; i < 3; ++i) polytope.add(Vec3::Unit(i), upper_map[i]);
  for (int i = 0; i < 3; ++i) polytope.add(-Vec3::Unit(i), -lower_map[i]);
  return polytope;
}

Ball chebyshev_ball(std::span<const Faces> polytopes) {
  return LargestBall(polytopes).solve();
}

Ball chebyshev_ball(const Polytope& polytope) {
  const Faces parts[] = {polytope.half_spaces};
  return chebyshev_ball(parts);
}

Ball chebyshev_ball(const Polytope& a, const Polytope& b) {
  const Faces parts[] = {a.half_spaces, b.half_spaces};
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
                fmt::format("a corridor of {} polytopes has {} waypoints and {} overlaps: n, n + 1 "
                            "and n - 1 are needed",
                            polytopes.size(), waypoints_map.size(), overlaps.size()));
  }
  for (std::size_t k = 0; k < overlaps.size(); ++k) {
    if (!is_finite(overlaps[k].center_map) || !std::isfinite(overlaps[k].radius_m)) {
      return fail(ErrorCode::invalid_input, fmt::format("overlap {} is not finite", k));
    }
  }
  for (std::size_t k = 0; k < polytopes.size(); ++k) {
    if (auto status = polytopes[k].check(); !status) {
      return fail(status.code(), fmt::format("polytope {}: {}", k, status.error().message));
    }
    for (const std::size_t end : {k, k + 1}) {
      if (!(polytopes[k].violation(waypoints_map[end]) <= 1e-6)) {
        return fail(ErrorCode::invalid_input,
                    fmt::format("waypoint {} {} lies outside polytope {} or is not finite", end,
                                to_text(waypoints_map[end]), k));
      }
    }
  }
  return success();
}

}  // namespace goshawk
