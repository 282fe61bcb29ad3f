#pragma once

#include "goshawk/path_search/planner.hpp"

/// A* as a first implementation looks: std::priority_queue, std::unordered_map, the octile
/// heuristic in doubles. The baseline that the benchmark compares with; in no library.
/// @return length in voxels, or a negative number if there is no path
double plain_astar(const goshawk::BitGrid& blocked, goshawk::Index3 start, goshawk::Index3 goal,
                   goshawk::path_search::CornerRule rule);
