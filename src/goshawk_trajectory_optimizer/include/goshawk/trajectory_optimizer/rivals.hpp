#pragma once

#include <functional>
#include <span>

#include "goshawk/core/certificate.hpp"
#include "goshawk/core/polytope.hpp"
#include "goshawk/core/result.hpp"
#include "goshawk/core/trajectory.hpp"

namespace goshawk::trajectory_optimizer {

/// The two planners that the thesis compares itself with (its Table 3), as far as a trajectory
/// stage goes. Neither promises to be free of obstacles.

/// Ref. [40]: minimum snap through the waypoints, durations from the trapezoid, stretched until
/// speed and acceleration respect the limits. No corridor: between waypoints it goes anywhere.
/// @return invalid_input, solver_failed
Result<Trajectory> minimum_snap(std::span<const Vec3> waypoints_map, const FlatState& start,
                                const FlatState& goal, const Limits& limits);

struct RecheckedPolynomial {
  Trajectory trajectory;
  int plans = 0;  // how often it was planned
};

/// Ref. [42]: minimum jerk through the waypoints; where `is_free` says that a piece collides, a
/// waypoint is put in the middle of that segment and all is planned again.
/// @param is_free of one piece; its polytope is the number of the segment of waypoints_map
/// @return trajectory_infeasible where it still collides after 40 plans
Result<RecheckedPolynomial> rechecked_polynomial(
    std::span<const Vec3> waypoints_map, const FlatState& start, const FlatState& goal,
    const Limits& limits, const std::function<bool(const BezierPiece&)>& is_free);

}  // namespace goshawk::trajectory_optimizer
