#pragma once

#include <optional>

#include "goshawk/conversions/geometry.hpp"
#include "goshawk/core/committed_trajectory.hpp"
#include "goshawk/core/plan_request.hpp"

/// Messages of the planning cycle. What comes out is as valid as its type promises: a
/// CertifiedTrajectory is proved here, once, from the control points; a Corridor is checked by who
/// uses it (Corridor::check()).
namespace goshawk::conversions {

/// @return wrong_frame, invalid_input or invalid_limits if the message is wrong
Result<PlanRequest> from_msg(const goshawk_msgs::msg::PlanRequest& m);
goshawk_msgs::msg::PlanRequest to_msg(const PlanRequest& request);

/// A norm that does not exist is invalid_limits. The values are not checked (Limits::check()).
Result<Limits> from_msg(const goshawk_msgs::msg::Limits& m);
goshawk_msgs::msg::Limits to_msg(const Limits& limits);

/// The pruned polyline of a path. @return wrong_frame, or invalid_input for fewer than two
/// waypoints or one that is not finite
Result<std::vector<Vec3>> waypoints_of(const goshawk_msgs::msg::Path& m);

/// @return wrong_frame, or invalid_input if a polytope's sizes disagree; overlaps are measured
/// anew, not believed
Result<Corridor> from_msg(const goshawk_msgs::msg::Corridor& m);

/// Certified against the limits and the ends of the request that the message carries, whatever
/// certificate it claims. @return wrong_frame, or all of certify()
Result<CertifiedTrajectory> from_msg(const goshawk_msgs::msg::BezierTrajectory& m);

/// @return nothing if the message has no curve of yaw; invalid_input for one that is none
Result<std::optional<YawCurve>> yaw_curve_of(const goshawk_msgs::msg::BezierTrajectory& m);
void fill_yaw(const YawCurve& curve, goshawk_msgs::msg::BezierTrajectory& m);

/// Both parts certified. @return wrong_frame, all of certify() and of CommittedTrajectory::make()
Result<CommittedTrajectory> from_msg(const goshawk_msgs::msg::CommittedTrajectory& m);
/// The header, and the nominal part as its optimizer published it, stay.
void fill_msg(const CommittedTrajectory& committed, goshawk_msgs::msg::CommittedTrajectory& m);

}  // namespace goshawk::conversions
