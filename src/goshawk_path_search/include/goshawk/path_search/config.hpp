#pragma once

#include <concepts>
#include <string>
#include <type_traits>

#include "goshawk/core/parameter.hpp"

namespace goshawk::path_search {

/// The parameters of the stage. The defaults suit a corridor builder behind it.
struct Config {
  std::string planner = "jastar";
  std::string corner_rule = "no_squeeze";
  std::string pruning = "shortest";
};

template <typename Self, typename Visitor>
requires std::same_as<std::remove_const_t<Self>, Config>
void describe(Self& c, Visitor&& visit) {
  visit("planner", c.planner, "",
        "grid search: jastar (fastest, exact), astar (octile heuristic), astar_euclidean, "
        "astar_manhattan (fast, not exact) or dijkstra",
        OneOf{{"jastar", "astar", "astar_euclidean", "astar_manhattan", "dijkstra"}});
  visit("corner_rule", c.corner_rule, "",
        "no_squeeze: every voxel of the box that a move spans is free, as a corridor needs; "
        "squeeze: only the target voxel is, so paths may touch obstacle edges",
        OneOf{{"no_squeeze", "squeeze"}});
  visit("pruning", c.pruning, "",
        "waypoints: shortest (shortest polyline over the path's own nodes), greedy (farthest "
        "visible node) or none",
        OneOf{{"shortest", "greedy", "none"}});
}

}  // namespace goshawk::path_search
