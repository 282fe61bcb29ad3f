#include "goshawk/path_search/planner.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "goshawk/path_search/grid_search.hpp"
#include "goshawk/path_search/path_reuse.hpp"
#include "goshawk/path_search/sampling_search.hpp"
#include "goshawk/path_search/weighted_search.hpp"

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

namespace {

Weights weights_of(const Config& config, double resolution_m) {
  Weights weights{.climb = config.z_weight};
  if (config.unknown == UnknownRule::costly) weights.unknown = config.unknown_weight;
  if (config.clearance_m > 0.0) {
    weights.clearance = config.clearance_weight;
    weights.reach_voxels =
        int(std::min(std::ceil(config.clearance_m / resolution_m), double(CostField::kMaxReach)));
  }
  return weights;
}

// JA*'s pruning presumes plain costs. Its answer to others is that of A*.
Result<std::unique_ptr<GridPlanner>> make_weighted(const Config& config, const Weights& weights) {
  switch (config.planner) {
    case Planner::jastar:
    case Planner::astar:
      return make_weighted_search("astar_weighted", true, config.corner_rule, weights);
    case Planner::dijkstra:
      return make_weighted_search("dijkstra_weighted", false, config.corner_rule, weights);
    default:
      return fail(ErrorCode::invalid_parameter,
                  fmt::format("planner {} knows lengths only: with z_weight, clearance_m or "
                              "unknown: costly use jastar, astar or dijkstra",
                              to_word(config.planner)));
  }
}

}  // namespace

Result<std::unique_ptr<GridPlanner>> make_planner(const Config& config, double resolution_m) {
  if (auto status = check(config); !status) return status.error();
  const Weights weights = weights_of(config, resolution_m);
  if (!weights.plain()) return make_weighted(config, weights);
  switch (config.planner) {
    case Planner::rrt:
    case Planner::rrtstar:
    case Planner::prm:
      return make_sampling_search(config.planner, {.max_iterations = config.max_iterations,
                                                   .step_voxels = config.step_m / resolution_m,
                                                   .seed = std::uint64_t(config.seed),
                                                   .validity = config.validity});
    case Planner::astar_manhattan:  // not exact: nothing says that its path is a shortest one
      return make_grid_search(config.planner, config.corner_rule);
    default: {
      auto planner = make_grid_search(config.planner, config.corner_rule);
      if (!config.reuse_path) return planner;
      return make_reusing(std::move(planner), config.corner_rule);
    }
  }
}

}  // namespace goshawk::path_search
