#pragma once

#include <memory>

#include "goshawk/path_search/planner.hpp"

namespace goshawk::path_search {

/// A planner that answers from its last path while that is still a shortest one: the goal is the
/// same, the start lies on the path, every move of the rest is still allowed, and no voxel that
/// became free since could shorten it (the octile distances from the start over that voxel to the
/// goal add up to no less). Blocked voxels elsewhere cannot make another path better. The answer
/// costs as little as a fresh one to the last bit; of equally long paths it may be another one.
/// @param planner exact about lengths, without weights @param rule the planner's
std::unique_ptr<GridPlanner> make_reusing(std::unique_ptr<GridPlanner> planner, CornerRule rule);

}  // namespace goshawk::path_search
