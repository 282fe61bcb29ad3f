#include "goshawk/px4_stand_in/position_control.hpp"

#include <algorithm>
#include <cmath>

#include "goshawk/px4_wire/frames.hpp"

namespace goshawk::px4_stand_in {
namespace {

const Vec3 kPositionGain(0.95, 0.95, 1.0);  // [1/s]
const Vec3 kVelocityGain(1.8, 1.8, 4.0);    // [1/s]
const Vec3 kIntegralGain(0.4, 0.4, 2.0);    // [1/s^2]
constexpr double kFastest_m_s = 12.0, kFastestUp_m_s = 3.0, kFastestDown_m_s = 1.5;
constexpr double kLeastThrust = 0.12;
constexpr double kSteepest_rad = 0.785;  // MPC_TILTMAX_AIR

Vec3 limited_velocity(Vec3 v) {
  const double across = v.head<2>().norm();
  if (across > kFastest_m_s) v.head<2>() *= kFastest_m_s / across;
  v.z() = std::clamp(v.z(), -kFastestUp_m_s, kFastestDown_m_s);
  return v;
}

Eigen::Matrix3d attitude_of(const Vec3& force, double yaw_rad) {
  const Vec3 z = -force.normalized();
  const Vec3 right(-std::sin(yaw_rad), std::cos(yaw_rad), 0.0);
  const Vec3 x = right.cross(z).normalized();
  Eigen::Matrix3d attitude;
  attitude << x, z.cross(x), z;
  return attitude;
}

}  // namespace

Thrust PositionControl::step(const LocalState& state, const px4::TrajectorySetpoint& setpoint,
                             double hover_thrust, double dt_s) {
  const Vec3 position = px4::from_array(setpoint.position),
             feedforward = px4::from_array(setpoint.velocity);
  const Vec3 acceleration = px4::from_array(setpoint.acceleration);
  Vec3 wanted = Vec3::Zero();
  for (int i = 0; i < 3; ++i) {
    if (std::isfinite(position[i]))
      wanted[i] = kPositionGain[i] * (position[i] - state.position[i]);
    if (std::isfinite(feedforward[i])) wanted[i] += feedforward[i];
  }
  const Vec3 error = limited_velocity(wanted) - state.velocity;
  integral_ += dt_s * kIntegralGain.cwiseProduct(error);
  integral_ = integral_.cwiseMax(-kGravity_m_s2).cwiseMin(kGravity_m_s2);
  Vec3 a = kVelocityGain.cwiseProduct(error) + integral_;
  for (int i = 0; i < 3; ++i) {
    if (std::isfinite(acceleration[i])) a[i] += acceleration[i];
  }
  // Height first: what is left of the thrust and of the tilt goes sideways.
  const double most = kGravity_m_s2 / hover_thrust, least = kLeastThrust * most;
  Vec3 force = a - Vec3(0.0, 0.0, kGravity_m_s2);
  force.z() = std::clamp(force.z(), -most, -least);
  const double side = force.head<2>().norm();
  const double side_most = std::min(std::sqrt(most * most - force.z() * force.z()),
                                    -force.z() * std::tan(kSteepest_rad));
  if (side > side_most) force.head<2>() *= side_most / side;
  const double yaw = std::isfinite(setpoint.yaw)
                         ? double(setpoint.yaw)
                         : std::atan2(state.attitude(1, 0), state.attitude(0, 0));
  return {force.norm(), attitude_of(force, yaw)};
}

}  // namespace goshawk::px4_stand_in
