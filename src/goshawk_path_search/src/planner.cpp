#include "goshawk/path_search/planner.hpp"

#include <string>

#include "goshawk/path_search/grid_search.hpp"

namespace goshawk::path_search {

Status GridPlanner::search(Index3 start, Index3 goal, VoxelPath& path) {
  const End end = End::center_of(goal);
  return search({.start = End::center_of(start), .goals = {&end, 1}, .stop = {}}, path);
}

Result<VoxelPath> GridPlanner::search(Index3 start, Index3 goal) {
  VoxelPath path;
  if (auto status = search(start, goal, path); !status) return status.error();
  return path;
}

Status check_ends(const GridQuery& query, Index3 size,
                  const std::function<bool(Index3)>& is_blocked) {
  const auto contains = [size](Index3 i) {
    return i.x >= 0 && i.y >= 0 && i.z >= 0 && i.x < size.x && i.y < size.y && i.z < size.z;
  };
  const auto check = [&](Index3 i, const char* name, ErrorCode outside, ErrorCode occupied) {
    const auto sentence = [&](const std::string& rest) {
      return std::string(name) + " voxel " + to_text(i) + rest;
    };
    if (!contains(i)) {
      return Status(fail(outside, sentence(" is outside the map of " + to_text(size) + " voxels")));
    }
    if (is_blocked(i)) {
      return Status(fail(occupied, sentence(" is blocked: choose a free one")));
    }
    return success();
  };
  if (query.goals.empty()) {
    return fail(ErrorCode::invalid_input, "a query without a goal: give one or more");
  }
  if (auto status =
          check(query.start.cell, "start", ErrorCode::start_outside, ErrorCode::start_occupied);
      !status) {
    return status;
  }
  for (const End& goal : query.goals) {
    auto status = check(goal.cell, "goal", ErrorCode::goal_outside, ErrorCode::goal_occupied);
    if (!status) return status;
  }
  return success();
}

Error no_way(const GridQuery& query) {
  std::string goals = to_text(query.goals.front().cell);
  if (query.goals.size() > 1) {
    goals += " or to any of " + std::to_string(query.goals.size() - 1) + " other goals";
  }
  return fail(ErrorCode::no_path, "there is no free way from voxel " + to_text(query.start.cell) +
                                      " to " + goals +
                                      ": choose another goal, or a smaller radius or margin");
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
