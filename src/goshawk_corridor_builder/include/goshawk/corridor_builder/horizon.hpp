#pragma once

#include <span>
#include <vector>

#include "goshawk/core/vector.hpp"

namespace goshawk::corridor_builder {

/// The first part of a path, and what it leaves.
struct FirstPart {
  std::vector<Vec3> waypoints_map;  // [m]
  double beyond_m = 0.0;            // length of the rest of the path; 0: there is none
};

/// A plan that leads through the unknown is made anew before the vehicle is far: a corridor for the
/// whole path would be work for nothing, the more so the farther the goal is. A path that is hardly
/// longer than the horizon stays whole: no plan is left that leads a step to the goal.
/// @param path_map [m] n >= 0 points, finite @param horizon_m [m] along the path; 0: the whole path
FirstPart within_horizon(std::span<const Vec3> path_map, double horizon_m);

}  // namespace goshawk::corridor_builder
