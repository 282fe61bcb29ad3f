#include "goshawk/simulator/attitude_controller.hpp"

namespace goshawk::simulator {

Wrench attitude_control(const AttitudeGains& gains, const Eigen::Matrix3d& inertia_kg_m2,
                        const RigidBodyState& state, const AttitudeSetpoint& wanted) {
  Eigen::Quaterniond left = state.q_map_base.conjugate() * wanted.q_map_base;
  if (left.w() < 0.0) left.coeffs() = -left.coeffs();
  const Vec3 angle_error = 2.0 * left.vec();
  const Vec3& omega = state.angular_velocity_base;
  // The wanted rates are in the wanted body's axes; `left` turns them into the axes of the real
  // one.
  const Vec3 rate_error = left * wanted.angular_velocity_base - omega;

  const Vec3 angle_gain(gains.tilt_1_s2, gains.tilt_1_s2, gains.yaw_1_s2);
  const Vec3 rate_gain(gains.tilt_rate_1_s, gains.tilt_rate_1_s, gains.yaw_rate_1_s);
  const Vec3 angular_acceleration =
      angle_gain.cwiseProduct(angle_error) + rate_gain.cwiseProduct(rate_error);
  return {wanted.thrust_n,
          inertia_kg_m2 * angular_acceleration + omega.cross(inertia_kg_m2 * omega)};
}

}  // namespace goshawk::simulator
