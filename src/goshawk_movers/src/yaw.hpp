#pragma once

#include <cmath>

#include "goshawk/core/flatness.hpp"
#include "goshawk/core/vehicle.hpp"

namespace goshawk::movers {

/// Turned about map's z axis.
inline Quaternion from_yaw(double yaw_rad) {
  return Quaternion(std::cos(0.5 * yaw_rad), 0.0, 0.0, std::sin(0.5 * yaw_rad));
}

/// [rad] from one heading to another, the shorter way: -pi to pi
inline double shorter_turn(double from_rad, double to_rad) {
  return wrapped(to_rad - from_rad);
}

}  // namespace goshawk::movers
