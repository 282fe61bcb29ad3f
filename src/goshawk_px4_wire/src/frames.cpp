#include "goshawk/px4_wire/frames.hpp"

#include <cmath>
#include <numbers>

namespace goshawk::px4 {

Vec3 swap_world(const Vec3& v) {
  return {v.y(), v.x(), -v.z()};
}

Vec3 swap_body(const Vec3& v) {
  return {v.x(), -v.y(), -v.z()};
}

Vec3 swap_variance(const Vec3& v) {
  return {v.y(), v.x(), v.z()};
}

// q_enu_ned * q * q_frd_flu, both half turns: about (1, 1, 0) and about x.
Quaternion swap_attitude(const Quaternion& q) {
  const double half = 1.0 / std::numbers::sqrt2;
  const Quaternion swapped(half * (q.w() + q.z()), half * (q.x() + q.y()), half * (q.x() - q.y()),
                           half * (q.w() - q.z()));
  if (swapped.w() >= 0.0) return swapped;
  return Quaternion(Eigen::Vector4d(-swapped.coeffs()));
}

double swap_yaw(double yaw_rad) {
  return std::remainder(0.5 * std::numbers::pi - yaw_rad, 2.0 * std::numbers::pi);
}

double swap_yaw_rate(double yaw_rate_rad_s) {
  return -yaw_rate_rad_s;
}

Vec3 from_array(const Vec3f& v) {
  return {v[0], v[1], v[2]};
}

Vec3f to_array(const Vec3& v) {
  return {float(v.x()), float(v.y()), float(v.z())};
}

Quaternion from_array(const std::array<float, 4>& q) {
  return {q[0], q[1], q[2], q[3]};
}

std::array<float, 4> to_array(const Quaternion& q) {
  return {float(q.w()), float(q.x()), float(q.y()), float(q.z())};
}

}  // namespace goshawk::px4
