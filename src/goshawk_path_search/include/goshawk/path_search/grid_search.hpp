#pragma once

#include <memory>
#include <string_view>

#include "goshawk/path_search/planner.hpp"

namespace goshawk::path_search {

/// What a best-first search on the grid expands, and in which order.
enum class Variant {
  jastar,           // octile heuristic, canonical successors, straight jumps
  astar,            // octile heuristic, all successors
  astar_euclidean,  // Euclidean heuristic, all successors
  astar_manhattan,  // Manhattan heuristic, all successors; paths may be longer than the shortest
  dijkstra,         // no heuristic, all successors
};

/// All variants on the same machinery: bit rows, labels stamped by query, a bucket queue.
/// Memory: 8 bytes a voxel for labels (only pages that a search touches), 3 bits for obstacles.
std::unique_ptr<GridPlanner> make_grid_search(Variant variant, CornerRule rule);

}  // namespace goshawk::path_search
