#pragma once

#include <span>
#include <vector>

#include "goshawk/obstacle_tracker/obstacle_tracker.hpp"
#include "goshawk_msgs.h"

namespace goshawk::obstacle_tracker {

/// Carried on at its velocity up to the horizon. The header and the version stay as they are.
void fill_msg(std::span<const TrackedObstacle> obstacles, goshawk_msgs::msg::PredictedObstacles& m);

/// Moving boxes from elsewhere, with bounds by their stated errors (two standard deviations) and
/// the configured agility.
std::vector<TrackedObstacle> bounded(const std::vector<MovingBox>& boxes, const Config& config);

}  // namespace goshawk::obstacle_tracker
