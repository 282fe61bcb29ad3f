#pragma once

#include "goshawk/conversions/geometry.hpp"

namespace goshawk::conversions {

/// A plan request, checked.
struct PlanRequest {
  std::uint64_t id = 0;
  std::int64_t stamp_ns = 0;
  FlatState start;
  FlatState goal;
  std::vector<Vec3> other_goals_map = {};  // [m] positions that will do as well as the goal's
  double goal_yaw_rad = 0.0;
  Limits limits;
  double deadline_s = 0.0;  // after the stamp; 0 for none
  double duration_s = 0.0;  // of the flight; 0: as fast as the limits allow
};

/// @return wrong_frame, invalid_input or invalid_limits where the message is wrong
Result<PlanRequest> from_msg(const goshawk_msgs::msg::PlanRequest& m);
goshawk_msgs::msg::PlanRequest to_msg(const PlanRequest& request);

/// @return deadline_exceeded where the request's deadline lies before now
Status check_deadline(const PlanRequest& request, std::int64_t now_ns);

/// Limits with a norm above 2 are invalid_limits, like those not above zero.
Result<Limits> from_msg(const goshawk_msgs::msg::Limits& m);
goshawk_msgs::msg::Limits to_msg(const Limits& limits);

/// The pruned polyline of a path. @return wrong_frame, or invalid_input for fewer than two
/// waypoints or one that is not finite
Result<std::vector<Vec3>> waypoints_of(const goshawk_msgs::msg::Path& m);

/// @return wrong_frame or invalid_input; overlaps are measured anew, not believed
Result<Corridor> from_msg(const goshawk_msgs::msg::Corridor& m);

/// A trajectory with what it must obey, as a receiver checks it.
struct ReceivedTrajectory {
  PlanRequest request;
  Trajectory trajectory;
  std::vector<Polytope> polytopes;
  Certificate certificate;  // recomputed here from the control points, not the sender's
};

/// @return wrong_frame, invalid_input, or not_certified where the recomputed certificate fails
Result<ReceivedTrajectory> from_msg(const goshawk_msgs::msg::BezierTrajectory& m);

}  // namespace goshawk::conversions
