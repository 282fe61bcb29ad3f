#pragma once

#include <memory>
#include <string_view>

#include "goshawk/path_search/planner.hpp"
#include "goshawk/path_search/weights.hpp"

namespace goshawk::path_search {

/// A* (or Dijkstra, without the heuristic) that is exact about a weighted cost. The canonical
/// pruning and the jumps of JA* presume that equal moves cost the same everywhere, so they are not
/// used here. Memory: 16 bytes a voxel for labels, 1 for the weights, 3 bits for obstacles.
std::unique_ptr<GridPlanner> make_weighted_search(std::string_view name, bool use_heuristic,
                                                  CornerRule rule, const Weights& weights);

}  // namespace goshawk::path_search
