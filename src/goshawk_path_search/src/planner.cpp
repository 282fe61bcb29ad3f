#include "goshawk/path_search/planner.hpp"

#include <string>

#include "goshawk/path_search/grid_search.hpp"

namespace goshawk::path_search {

Result<VoxelPath> GridPlanner::search(Index3 start, Index3 goal) {
  VoxelPath path;
  if (auto status = search(start, goal, path); !status) return status.error();
  return path;
}

Result<CornerRule> parse_corner_rule(std::string_view word) {
  if (word == "no_squeeze") return CornerRule::no_squeeze;
  if (word == "squeeze") return CornerRule::squeeze;
  return fail(ErrorCode::invalid_parameter,
              "corner_rule is '" + std::string(word) + "': it must be no_squeeze or squeeze");
}

Result<std::unique_ptr<GridPlanner>> make_planner(const Config& config) {
  const auto rule = parse_corner_rule(config.corner_rule);
  if (!rule) return rule.error();
  struct Entry {
    std::string_view name;
    Variant variant;
  };
  constexpr Entry kEntries[] = {{"jastar", Variant::jastar},
                                {"astar", Variant::astar},
                                {"astar_euclidean", Variant::astar_euclidean},
                                {"astar_manhattan", Variant::astar_manhattan},
                                {"dijkstra", Variant::dijkstra}};
  for (const Entry& entry : kEntries) {
    if (config.planner == entry.name) return make_grid_search(entry.variant, *rule);
  }
  return fail(ErrorCode::invalid_parameter,
              "planner is '" + config.planner +
                  "': it must be jastar, astar, astar_euclidean, astar_manhattan or dijkstra");
}

}  // namespace goshawk::path_search
