#include "goshawk/simulator/position_hold.hpp"

#include <algorithm>
#include <cmath>

namespace goshawk::simulator {

using plant::VehicleParameters;

namespace {

constexpr double kVelocityGain_1_s = 5.0;    // braking and damping
constexpr double kPositionGain_1_s2 = 6.25;  // critically damped with the above
constexpr double kAtRest_m_s = 0.25;         // slow enough to choose the place to hover
constexpr double kThrustShare = 0.9;         // of the maximum; the rest is for attitude control

}  // namespace

PositionHold::PositionHold(const VehicleParameters& parameters, double max_tilt_rad)
    : mass_kg_(parameters.mass_kg),
      max_thrust_n_(std::max(parameters.weight_n(), kThrustShare * parameters.max_thrust_n())),
      max_tilt_rad_(max_tilt_rad) {}

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
  return thrust_along(acceleration);
}

// The vertical part of the force is served first: losing height is worse than braking later.
AttitudeSetpoint PositionHold::thrust_along(const Vec3& acceleration_map) const {
  Vec3 force = mass_kg_ * (acceleration_map + Vec3(0.0, 0.0, kGravity_m_s2));
  force.z() = std::clamp(force.z(), 0.3 * mass_kg_ * kGravity_m_s2, max_thrust_n_);
  const double side = force.head<2>().norm();
  const double side_max =
      std::min(force.z() * std::tan(max_tilt_rad_),
               std::sqrt(max_thrust_n_ * max_thrust_n_ - force.z() * force.z()));
  if (side > side_max) force.head<2>() *= side_max / side;

  const Vec3 z = force.normalized();
  const Vec3 x = Vec3(-std::sin(yaw_rad_), std::cos(yaw_rad_), 0.0).cross(z).normalized();
  Eigen::Matrix3d R_map_base;
  R_map_base << x, z.cross(x), z;
  return {force.norm(), Eigen::Quaterniond(R_map_base), Vec3::Zero()};
}

}  // namespace goshawk::simulator
