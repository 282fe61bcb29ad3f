#include "goshawk/core/vehicle.hpp"

#include <cmath>

namespace goshawk {

double yaw_of(const Quaternion& q_map_base) {
  const Vec3 x_base = q_map_base * Vec3::UnitX();
  return std::atan2(x_base.y(), x_base.x());
}

}  // namespace goshawk
