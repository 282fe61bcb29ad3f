#pragma once

#include <memory>
#include <string_view>

#include "goshawk/path_search/planner.hpp"

namespace goshawk::path_search {

/// The best-first searches, all on the same machinery: bit rows, labels stamped by query, a bucket
/// queue.
/// Memory: 8 bytes a voxel for labels (only pages that a search touches; JA* in maps of a million
/// voxels and more: only tiles), 3 bits for obstacles and up to 6 for jumps.
/// @param planner jastar to dijkstra; others throw std::invalid_argument
std::unique_ptr<GridPlanner> make_grid_search(Planner planner, CornerRule rule);

/// JA* with labels in tiles or in rows, whatever the size of the map.
std::unique_ptr<GridPlanner> make_jastar(CornerRule rule, bool tiled);

}  // namespace goshawk::path_search
