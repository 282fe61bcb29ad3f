#pragma once

#include "goshawk/core/result.hpp"
#include "goshawk/guard/plan.hpp"
#include "goshawk_msgs.h"
#include "nav_msgs.h"
#include "trajectory_msgs.h"

/// Other planners' messages as plans. Start times stay on the sender's clock. What is checked here
/// is the frame, and what no plan can express; numbers are checked by curve_of() and check().
namespace goshawk::guard {

/// With stamps on its poses (growing; the first is the plan's start) these are its times. Without
/// (all the same) it is flown as fast as the limits allow. Orientations are not used.
/// @return wrong_frame
Result<Plan> plan_of(const nav_msgs::msg::Path& m);

/// Of one body. Rotations are not used. @return wrong_frame, or invalid_input for points without
/// exactly one transform or with velocities or accelerations of several bodies
Result<Plan> plan_of(const trajectory_msgs::msg::MultiDOFJointTrajectory& m);

/// @return wrong_frame
Result<Plan> plan_of(const goshawk_msgs::msg::PolynomialPlan& m);
Result<Plan> plan_of(const goshawk_msgs::msg::BsplinePlan& m);

}  // namespace goshawk::guard
