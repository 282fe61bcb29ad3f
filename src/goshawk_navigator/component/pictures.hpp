#pragma once

#include "goshawk/conversions/plan.hpp"
#include "nav_msgs.h"
#include "visualization_msgs.h"

namespace goshawk::navigator {

/// The trajectory as points every `step_s`, for viewers that draw nav_msgs/Path.
nav_msgs::msg::Path path_line(const Trajectory& trajectory, std::int64_t stamp_ns, double step_s);

/// The corridor's edges and the start and the goal, for viewers that draw markers.
visualization_msgs::msg::MarkerArray corridor_markers(const CommittedTrajectory& committed,
                                                      std::int64_t stamp_ns);

}  // namespace goshawk::navigator
