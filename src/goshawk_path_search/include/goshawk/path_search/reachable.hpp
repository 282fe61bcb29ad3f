#pragma once

#include <span>

#include "goshawk/path_search/planner.hpp"

namespace goshawk::path_search {

/// The voxel that can be reached from the start and lies nearest to any of the goals: straight
/// distance between a voxel's centre and the goal's point; of equal ones the lowest z, y, x. Visits
/// every voxel that can be reached.
/// @pre the ends lie inside the grid, the start is free
/// @return deadline_exceeded or cancelled; else the voxel
Result<Index3> nearest_reachable(const BitGrid& blocked, CornerRule rule, const GridQuery& query);

}  // namespace goshawk::path_search
