#pragma once

#include "goshawk/conversions/geometry.hpp"
#include "goshawk/core/vehicle.hpp"
#include "nav_msgs.h"

namespace goshawk::conversions {

/// Pose in map, twist in base_link, as ROS has it (REP 147).
/// @return wrong_frame, or invalid_input where something is not finite or the quaternion is far
/// from length 1
Result<RigidBodyState> from_msg(const nav_msgs::msg::Odometry& m);
void fill_msg(const RigidBodyState& state, nav_msgs::msg::Odometry& m);

Result<AttitudeSetpoint> from_msg(const goshawk_msgs::msg::AttitudeSetpoint& m);
void fill_msg(const AttitudeSetpoint& command, goshawk_msgs::msg::AttitudeSetpoint& m);

geometry_msgs::msg::Quaternion to_msg(const Eigen::Quaterniond& q);

/// Heading of the body's x axis. @return [rad] map, from x to y
double yaw_of(const Eigen::Quaterniond& q_map_base);
Eigen::Quaterniond yaw_rotation(double yaw_rad);

}  // namespace goshawk::conversions
