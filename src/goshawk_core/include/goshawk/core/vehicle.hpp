#pragma once

#include <Eigen/Geometry>

#include "goshawk/core/vector.hpp"

namespace goshawk {

using Quaternion = Eigen::Quaternion<double, Eigen::DontAlign>;  // see vector.hpp

inline constexpr double kGravity_m_s2 = 9.80665;  // standard gravity

/// The 12 states of the vehicle. Frames: `map` (ENU), `base_link` (FLU).
struct RigidBodyState {
  Vec3 position_map = Vec3::Zero();                // [m]
  Vec3 velocity_map = Vec3::Zero();                // [m/s]
  Quaternion q_map_base = Quaternion::Identity();  // base_link to map
  Vec3 angular_velocity_base = Vec3::Zero();       // [rad/s]

  bool is_finite() const {
    return position_map.allFinite() && velocity_map.allFinite() &&
           q_map_base.coeffs().allFinite() && angular_velocity_base.allFinite();
  }
};

/// What a tracker asks of a vehicle: collective thrust along the body's z axis, the attitude to
/// take, and the body rates that go with it (feedforward).
struct AttitudeSetpoint {
  double thrust_n = 0.0;                           // [N] >= 0
  Quaternion q_map_base = Quaternion::Identity();  // wanted attitude
  Vec3 angular_velocity_base = Vec3::Zero();       // [rad/s] feedforward
};

/// Heading of the body's x axis. @return [rad] map, from x to y
double yaw_of(const Quaternion& q_map_base);

}  // namespace goshawk
