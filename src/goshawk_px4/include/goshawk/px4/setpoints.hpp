#pragma once

#include "goshawk/core/trajectory.hpp"
#include "goshawk/px4/config.hpp"
#include "goshawk/px4/map_frame.hpp"
#include "goshawk/px4_wire/commands.hpp"

namespace goshawk::px4 {

/// A state in `map` for PX4's position controller, in its own frame.
/// @param yaw_map_rad heading, from map x to y
TrajectorySetpoint trajectory_setpoint(const FlatState& state_map, double yaw_map_rad,
                                       const MapFrame& frame);

/// Thrust and attitude in `map` for PX4's attitude controller.
VehicleAttitudeSetpoint attitude_setpoint(const AttitudeSetpoint& command, const Config& config,
                                          const MapFrame& frame);

/// The throttle from 0 to 1 that gives this thrust, from the one that hovers: the share of full
/// thrust is f u^2 + (1 - f) u, f the thrust_curve.
double throttle_of(double thrust_n, const Config& config);

}  // namespace goshawk::px4
