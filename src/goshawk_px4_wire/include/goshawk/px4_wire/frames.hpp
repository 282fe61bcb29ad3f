#pragma once

#include "goshawk/core/vehicle.hpp"
#include "goshawk/px4_wire/messages.hpp"

namespace goshawk::px4 {

/// PX4's world is north, east, down (NED), its body forward, right, down (FRD); ours are east,
/// north, up (ENU) and forward, left, up (FLU). Each conversion is its own inverse. NaN stays NaN.

/// Positions, velocities, accelerations: (x, y, z) to (y, x, -z).
Vec3 swap_world(const Vec3& v);
/// Body rates, forces in the body: (x, y, z) to (x, -y, -z).
Vec3 swap_body(const Vec3& v);
/// Variances along the world's axes: (x, y, z) to (y, x, z).
Vec3 swap_variance(const Vec3& v);
/// FRD to NED into FLU to ENU, and back. @return of the same length, w >= 0
Quaternion swap_attitude(const Quaternion& q);
/// Headings: from north to east, and from east to north. [rad] @return in [-pi, pi]
double swap_yaw(double yaw_rad);
/// [rad/s]
double swap_yaw_rate(double yaw_rate_rad_s);

Vec3 from_array(const Vec3f& v);
Vec3f to_array(const Vec3& v);
Quaternion from_array(const std::array<float, 4>& q);
std::array<float, 4> to_array(const Quaternion& q);

}  // namespace goshawk::px4
