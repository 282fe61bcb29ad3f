#pragma once

#include <optional>

#include "goshawk/core/plan_request.hpp"
#include "goshawk/core/trajectory.hpp"
#include "goshawk/core/yaw_curve.hpp"
#include "goshawk/trajectory_optimizer/config.hpp"

namespace goshawk::trajectory_optimizer {

/// Where config.yaw looks from a state, in (-pi, pi]; nothing if it does not say: mode none, motion
/// that is slow or vertical, a point right above or below.
std::optional<double> wanted_yaw_rad(const FlatState& state, const PlanRequest& request,
                                     const Config& config);

/// Begins with the request's yaw and yaw rate (no faster than config.yaw_rate_max_rad_s), turns the
/// shorter way round to where config.yaw looks as fast as that rate allows, and then follows it.
/// While the vehicle moves up, down or hardly at all, or is over the point, yaw stays.
/// @return nothing for mode none. @pre request and config valid, at least one piece
std::optional<YawCurve> plan_yaw(const Trajectory& trajectory, const PlanRequest& request,
                                 const Config& config);

}  // namespace goshawk::trajectory_optimizer
