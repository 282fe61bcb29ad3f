#include "goshawk/px4/setpoints.hpp"

#include <algorithm>
#include <cmath>

#include "goshawk/px4_wire/frames.hpp"

namespace goshawk::px4 {

TrajectorySetpoint trajectory_setpoint(const FlatState& state_map, double yaw_map_rad,
                                       const MapFrame& frame) {
  TrajectorySetpoint setpoint;
  setpoint.position = to_array(swap_world(frame.point_to_local(state_map.position)));
  setpoint.velocity = to_array(swap_world(frame.vector_to_local(state_map.velocity)));
  setpoint.acceleration = to_array(swap_world(frame.vector_to_local(state_map.acceleration)));
  setpoint.yaw = float(swap_yaw(frame.yaw_to_local(yaw_map_rad)));
  return setpoint;
}

VehicleAttitudeSetpoint attitude_setpoint(const AttitudeSetpoint& command, const Config& config,
                                          const MapFrame& frame) {
  VehicleAttitudeSetpoint setpoint;
  setpoint.q_d = to_array(swap_attitude(frame.attitude_to_local(command.q_map_base)));
  setpoint.thrust_body = {0.0f, 0.0f, -float(throttle_of(command.thrust_n, config))};
  return setpoint;
}

double throttle_of(double thrust_n, const Config& config) {
  const double f = config.thrust_curve, h = config.hover_thrust;
  const double hover_share = f * h * h + (1.0 - f) * h;
  const double share = hover_share * std::max(0.0, thrust_n) / (config.mass_kg * kGravity_m_s2);
  if (f < 1e-6) return std::min(share, 1.0);
  const double linear = 1.0 - f;
  return std::min((std::sqrt(linear * linear + 4.0 * f * share) - linear) / (2.0 * f), 1.0);
}

}  // namespace goshawk::px4
