#include "goshawk/simulator/position_hold.hpp"

#include <algorithm>

#include "goshawk/core/flatness.hpp"
#include "goshawk/simulator/force_limits.hpp"

namespace goshawk::simulator {

using plant::VehicleParameters;

namespace {

constexpr double kVelocityGain_1_s = 5.0;    // braking and damping
constexpr double kPositionGain_1_s2 = 6.25;  // critically damped with the above
constexpr double kAtRest_m_s = 0.25;         // slow enough to choose the place to hover

}  // namespace

PositionHold::PositionHold(const VehicleParameters& parameters, double max_tilt_rad)
    : parameters_(parameters), max_tilt_rad_(max_tilt_rad) {}

void PositionHold::engage(const RigidBodyState& state) {
  braking_ = true;
  position_map_ = state.position_map;
  yaw_rad_ = yaw_of(state.q_map_base);
}

void PositionHold::engage_at(const Vec3& position_map, double yaw_rad) {
  braking_ = false;
  position_map_ = position_map;
  yaw_rad_ = yaw_rad;
}

void PositionHold::lower(double step_m, double floor_map_m) {
  const double height = position_map_.z();
  if (height > floor_map_m) position_map_.z() = std::max(floor_map_m, height - step_m);
}

AttitudeSetpoint PositionHold::step(const RigidBodyState& state, const Vec3& disturbance_map) {
  if (braking_ && state.velocity_map.norm() < kAtRest_m_s) {
    braking_ = false;
    position_map_ = state.position_map;
  }
  Vec3 acceleration = -kVelocityGain_1_s * state.velocity_map - disturbance_map;
  if (!braking_) acceleration += kPositionGain_1_s2 * (position_map_ - state.position_map);
  const Vec3 force = limited_force(parameters_, max_tilt_rad_, acceleration);
  return thrust_attitude_of(force / parameters_.mass_kg, Vec3::Zero(), yaw_rad_, 0.0,
                            parameters_.mass_kg);
}

}  // namespace goshawk::simulator
