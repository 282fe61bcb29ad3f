#include "goshawk/trajectory_optimizer/rivals.hpp"

#include <algorithm>
#include <cmath>

#include "goshawk/trajectory_optimizer/polynomial_spline.hpp"
#include "goshawk/trajectory_optimizer/time_profile.hpp"
#include "usage.hpp"

namespace goshawk::trajectory_optimizer {
namespace {

constexpr double kLongestPiece_s = 0.1;  // of the pieces that stand for a polynomial
constexpr double kLeastLength_m = 1e-3;
constexpr int kMostPlans = 40;

/// Waypoints, and which segment of the caller's each segment came from.
struct Route {
  std::vector<Vec3> waypoints;
  std::vector<int> origin;
};

Route route_of(std::span<const Vec3> waypoints) {
  Route route{{waypoints.begin(), waypoints.end()}, {}};
  for (int k = 0; k + 1 < int(waypoints.size()); ++k) route.origin.push_back(k);
  return route;
}

// Each segment as long as from rest to rest: the thesis' time allocation.
std::vector<double> durations_of(const Route& route, const Limits& limits) {
  std::vector<double> durations;
  for (std::size_t k = 0; k + 1 < route.waypoints.size(); ++k) {
    const double length = (route.waypoints[k + 1] - route.waypoints[k]).norm();
    durations.push_back(rest_to_rest_duration_s(std::max(length, kLeastLength_m), limits.v_max_m_s,
                                                limits.a_max_m_s2));
  }
  return durations;
}

// A longer duration of the same shape is slower everywhere, where both ends rest.
Result<Trajectory> plan(const Route& route, const FlatState& start, const FlatState& goal,
                        const Limits& limits, Smoothness smoothness) {
  std::vector<double> durations = durations_of(route, limits);
  for (int pass = 0;; ++pass) {
    const auto spline =
        PolynomialSpline::through(route.waypoints, durations, start, goal, smoothness);
    if (!spline) return spline.error();
    const double longest =
        std::min(kLongestPiece_s, *std::ranges::min_element(durations) * 0.5 + 1e-3);
    Trajectory trajectory = spline->to_trajectory(std::max(longest, 0.01));
    double most = 0.0;
    for (const BezierPiece& piece : trajectory.pieces) {
      most = std::max(most, time_factor(usage_of(piece, limits)));
    }
    if (most <= 1.0 || pass >= 20) return trajectory;
    for (double& duration : durations) duration *= most * (1.0 + 1e-9);
  }
}

Status check(std::span<const Vec3> waypoints, const Limits& limits) {
  if (auto status = limits.check(); !status) return status;
  if (waypoints.size() < 2) {
    return fail(ErrorCode::invalid_input, "a trajectory needs two waypoints or more");
  }
  for (const Vec3& p : waypoints) {
    if (!is_finite(p)) return fail(ErrorCode::invalid_input, "a waypoint is not finite");
  }
  return success();
}

}  // namespace

Result<Trajectory> minimum_snap(std::span<const Vec3> waypoints, const FlatState& start,
                                const FlatState& goal, const Limits& limits) {
  if (auto status = check(waypoints, limits); !status) return status.error();
  return plan(route_of(waypoints), start, goal, limits, Smoothness::snap);
}

Result<RecheckedPolynomial> rechecked_polynomial(
    std::span<const Vec3> waypoints, const FlatState& start, const FlatState& goal,
    const Limits& limits, const std::function<bool(const BezierPiece&)>& is_free) {
  if (auto status = check(waypoints, limits); !status) return status.error();
  Route route = route_of(waypoints);
  RecheckedPolynomial answer;
  while (answer.plans < kMostPlans) {
    auto trajectory = plan(route, start, goal, limits, Smoothness::jerk);
    if (!trajectory) return trajectory.error();
    ++answer.plans;
    std::vector<char> blocked(route.origin.size(), 0);
    bool free = true;
    for (BezierPiece& piece : trajectory->pieces) {
      const auto segment = std::size_t(piece.polytope);
      piece.polytope = route.origin[segment];
      if (is_free(piece)) continue;
      blocked[segment] = 1;
      free = false;
    }
    if (free) {
      answer.trajectory = *std::move(trajectory);
      return answer;
    }
    Route denser;
    for (std::size_t k = 0; k < route.origin.size(); ++k) {
      denser.waypoints.push_back(route.waypoints[k]);
      denser.origin.push_back(route.origin[k]);
      if (blocked[k] == 0) continue;
      denser.waypoints.push_back(0.5 * (route.waypoints[k] + route.waypoints[k + 1]));
      denser.origin.push_back(route.origin[k]);
    }
    denser.waypoints.push_back(route.waypoints.back());
    if (denser.origin.size() > 400) break;
    route = std::move(denser);
  }
  return fail(ErrorCode::trajectory_infeasible,
              "the polynomial through the waypoints still collides after " +
                  std::to_string(answer.plans) + " plans: use a method with a corridor");
}

}  // namespace goshawk::trajectory_optimizer
