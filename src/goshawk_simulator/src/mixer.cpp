#include "goshawk/simulator/mixer.hpp"

#include <algorithm>
#include <cmath>

namespace goshawk::simulator {

using plant::VehicleParameters;

namespace {

using Vec4 = Vec4;

// Signs for front left, rear left, rear right, front right. Thrust at +y gives a positive
// roll torque about x; thrust at +x pitches the nose up, a negative torque about y.
const Vec4 kRoll(1, 1, -1, -1);
const Vec4 kPitch(-1, 1, 1, -1);
const Vec4 kYaw(1, -1, 1, -1);

constexpr double kYawReserve = 0.1;  // of a motor's maximum

// The largest share of `change` that keeps every rotor in [0, max].
double share_that_fits(const Vec4& thrust, const Vec4& change, double max) {
  double share = 1.0;
  for (int i = 0; i < 4; ++i) {
    if (change[i] > 0.0) share = std::min(share, (max - thrust[i]) / change[i]);
    if (change[i] < 0.0) share = std::min(share, thrust[i] / -change[i]);
  }
  return std::max(0.0, share);
}

}  // namespace

Mixer::Mixer(const VehicleParameters& parameters)
    : max_n_(parameters.max_motor_thrust_n),
      lever_m_(parameters.arm_length_m / std::sqrt(2.0)),
      yaw_per_thrust_m_(parameters.torque_coefficient_nm_s2 / parameters.thrust_coefficient_n_s2) {}

Wrench Mixer::wrench(const Vec4& rotor_thrust_n) const {
  return {rotor_thrust_n.sum(),
          {lever_m_ * kRoll.dot(rotor_thrust_n), lever_m_ * kPitch.dot(rotor_thrust_n),
           yaw_per_thrust_m_ * kYaw.dot(rotor_thrust_n)}};
}

Vec4 Mixer::allocate(const Wrench& wanted) const {
  Vec4 tilt = wanted.torque_base_nm.x() / (4.0 * lever_m_) * kRoll +
              wanted.torque_base_nm.y() / (4.0 * lever_m_) * kPitch;
  const double spread = tilt.maxCoeff() - tilt.minCoeff();
  if (spread > max_n_) tilt *= max_n_ / spread;

  const Vec4 yaw = wanted.torque_base_nm.z() / (4.0 * yaw_per_thrust_m_) * kYaw;
  const Vec4 exact = (tilt + yaw).array() + wanted.thrust_n / 4.0;
  if (exact.minCoeff() >= 0.0 && exact.maxCoeff() <= max_n_) return exact;

  const double lowest = -tilt.minCoeff();
  const double highest = std::max(lowest, max_n_ - tilt.maxCoeff());
  const double reserve =
      std::min({std::abs(yaw[0]), kYawReserve * max_n_, (highest - lowest) / 2.0});
  const double mean =
      std::max(lowest + reserve, std::min(highest - reserve, wanted.thrust_n / 4.0));

  const Vec4 thrust = (tilt.array() + mean).cwiseMax(0.0).cwiseMin(max_n_).matrix();
  const Vec4 all = thrust + share_that_fits(thrust, yaw, max_n_) * yaw;
  return all.cwiseMax(0.0).cwiseMin(max_n_);
}

}  // namespace goshawk::simulator
