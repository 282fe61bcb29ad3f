#include "goshawk/baselines/polynomial_baselines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "goshawk/baselines/polynomial_spline.hpp"
#include "goshawk/trajectory_optimizer/limit_usage.hpp"
#include "goshawk/trajectory_optimizer/time_profile.hpp"

namespace goshawk::baselines {
namespace {

using trajectory_optimizer::rest_to_rest_duration_s;
using trajectory_optimizer::time_factor;
using trajectory_optimizer::usage_of;

constexpr double kLongestPiece_s = 0.1;  // of the pieces that stand for a polynomial
constexpr double kLeastLength_m = 1e-3;
constexpr int kMostPlans = 40;
constexpr int kMostStretches = 20;

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

// A longer duration of the same shape is slower everywhere if both ends rest.
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
    if (most <= 1.0 || pass >= kMostStretches) return trajectory;
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

namespace {

// Pieces name the segments of the route; they get those of the caller.
// @return for each segment of the route, whether one of its pieces is not free
std::vector<bool> blocked_segments(const Route& route,
                                   const std::function<bool(const BezierPiece&)>& is_free,
                                   Trajectory& trajectory) {
  std::vector<bool> blocked(route.origin.size(), false);
  for (BezierPiece& piece : trajectory.pieces) {
    const auto segment = std::size_t(piece.polytope);
    piece.polytope = route.origin[segment];
    if (!is_free(piece)) blocked[segment] = true;
  }
  return blocked;
}

// A waypoint more in the middle of each blocked segment.
Route denser(const Route& route, const std::vector<bool>& blocked) {
  Route dense;
  for (std::size_t k = 0; k < route.origin.size(); ++k) {
    dense.waypoints.push_back(route.waypoints[k]);
    dense.origin.push_back(route.origin[k]);
    if (!blocked[k]) continue;
    dense.waypoints.push_back(0.5 * (route.waypoints[k] + route.waypoints[k + 1]));
    dense.origin.push_back(route.origin[k]);
  }
  dense.waypoints.push_back(route.waypoints.back());
  return dense;
}

}  // namespace

Result<RecheckedPolynomial> rechecked_polynomial(
    std::span<const Vec3> waypoints, const FlatState& start, const FlatState& goal,
    const Limits& limits, const std::function<bool(const BezierPiece&)>& is_free) {
  if (auto status = check(waypoints, limits); !status) return status.error();
  Route route = route_of(waypoints);
  int plans = 0;
  while (plans < kMostPlans && route.waypoints.size() <= PolynomialSpline::kMostWaypoints) {
    auto trajectory = plan(route, start, goal, limits, Smoothness::jerk);
    if (!trajectory) return trajectory.error();
    ++plans;
    const auto blocked = blocked_segments(route, is_free, *trajectory);
    if (std::ranges::none_of(blocked, std::identity{})) {
      return RecheckedPolynomial{*std::move(trajectory), plans};
    }
    route = denser(route, blocked);
  }
  return fail(ErrorCode::trajectory_infeasible,
              fmt::format("the polynomial through the waypoints still collides after {} plans: use "
                          "trajectory_optimizer, which knows the corridor",
                          plans));
}

}  // namespace goshawk::baselines
