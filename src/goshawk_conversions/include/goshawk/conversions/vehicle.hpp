#pragma once

#include "goshawk/conversions/geometry.hpp"
#include "goshawk/core/fallback_stop.hpp"
#include "goshawk/core/vehicle.hpp"
#include "nav_msgs.h"

namespace goshawk::conversions {

/// Pose in map, twist in base_link, as ROS has it (REP 147).
/// @return wrong_frame, or invalid_input if something is not finite or the quaternion is zero
Result<RigidBodyState> from_msg(const nav_msgs::msg::Odometry& m);
void fill_msg(const RigidBodyState& state, nav_msgs::msg::Odometry& m);

Result<AttitudeSetpoint> from_msg(const goshawk_msgs::msg::AttitudeSetpoint& m);
void fill_msg(const AttitudeSetpoint& command, goshawk_msgs::msg::AttitudeSetpoint& m);

/// @return wrong_frame, or invalid_input as FallbackStop::check()
Result<FallbackStop> from_msg(const goshawk_msgs::msg::FallbackStop& m);
/// Allocates only if the message never held as many states.
void fill_msg(const FallbackStop& stop, goshawk_msgs::msg::FallbackStop& m);

struct GoalPose {
  Vec3 position_map = Vec3::Zero();
  double yaw_rad = 0.0;  // heading, map x to y
};
/// @return wrong_frame, or invalid_input if something is not finite or the quaternion is zero
Result<GoalPose> from_msg(const geometry_msgs::msg::PoseStamped& m);

/// Of any length: what comes back has length 1.
/// @return invalid_input if it is zero or not finite
Result<Quaternion> from_msg(const geometry_msgs::msg::Quaternion& m);
geometry_msgs::msg::Quaternion to_msg(const Quaternion& q);

}  // namespace goshawk::conversions
