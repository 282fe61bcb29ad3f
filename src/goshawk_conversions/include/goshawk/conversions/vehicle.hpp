#pragma once

#include "goshawk/conversions/geometry.hpp"
#include "goshawk/core/vehicle.hpp"
#include "nav_msgs.h"

namespace goshawk::conversions {

/// Pose in map, twist in base_link, as ROS has it (REP 147).
/// @return wrong_frame, or invalid_input if something is not finite or the quaternion is far
/// from length 1
Result<RigidBodyState> from_msg(const nav_msgs::msg::Odometry& m);
void fill_msg(const RigidBodyState& state, nav_msgs::msg::Odometry& m);

Result<AttitudeSetpoint> from_msg(const goshawk_msgs::msg::AttitudeSetpoint& m);
void fill_msg(const AttitudeSetpoint& command, goshawk_msgs::msg::AttitudeSetpoint& m);

/// @return invalid_input if it is far from length 1
Result<Quaternion> from_msg(const geometry_msgs::msg::Quaternion& m);
geometry_msgs::msg::Quaternion to_msg(const Quaternion& q);

}  // namespace goshawk::conversions
