#pragma once

#include <functional>
#include <span>

#include "goshawk/core/certificate.hpp"
#include "goshawk/core/polytope.hpp"
#include "goshawk/core/result.hpp"
#include "goshawk/core/trajectory.hpp"

namespace goshawk::baselines {

/// Minimum snap through the waypoints (thesis, Ref. [40]): durations from rest to rest of each
/// segment, all stretched until speed and acceleration keep the limits. It knows no corridor:
/// between waypoints it goes anywhere.
/// @return invalid_input, invalid_limits, solver_failed
Result<Trajectory> minimum_snap(std::span<const Vec3> waypoints_map, const FlatState& start,
                                const FlatState& goal, const Limits& limits);

struct RecheckedPolynomial {
  Trajectory trajectory;
  int plans = 0;  // how often it was planned
};

/// Minimum jerk through the waypoints (thesis, Ref. [42]): a segment with a piece that is not free
/// gets a waypoint in its middle, and all is planned again.
/// @param is_free of one piece; its polytope is the number of the segment of waypoints_map
/// @return as minimum_snap(); trajectory_infeasible if it still collides after 40 plans
Result<RecheckedPolynomial> rechecked_polynomial(
    std::span<const Vec3> waypoints_map, const FlatState& start, const FlatState& goal,
    const Limits& limits, const std::function<bool(const BezierPiece&)>& is_free);

}  // namespace goshawk::baselines
