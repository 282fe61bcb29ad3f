#pragma once

#include <cstdint>
#include <string>

#include "goshawk/core/result.hpp"
#include "goshawk/core/vehicle.hpp"

namespace goshawk {

/// No list of moving things is longer: what is beyond is a mistake, or an attack.
inline constexpr std::size_t kMostMovingBoxes = 10'000;

/// A box that moves, at one moment. Frame `map`.
struct MovingBox {
  std::uint64_t id = 0;                           // the same as long as the same thing is seen
  std::string kind{};                             // "person", "vehicle", ...; empty: not known
  Vec3 position_map = Vec3::Zero();               // [m] of its centre
  Quaternion q_map_box = Quaternion::Identity();  // box to map
  Vec3 half_m = Vec3::Zero();                     // half of each edge, above 0
  Vec3 velocity_map = Vec3::Zero();               // [m/s] of its centre
  Vec3 angular_velocity_map = Vec3::Zero();       // [rad/s]
  double position_error_m = 0.0;                  // one standard deviation; 0: the truth
  double velocity_error_m_s = 0.0;                // one standard deviation; 0: the truth

  /// @return invalid_input that names the box and what is wrong: numbers that are not finite, no
  /// extent, a quaternion without length 1, errors below 0
  Status check() const;
};

}  // namespace goshawk
