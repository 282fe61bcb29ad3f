#include "goshawk/path_search/planner.hpp"

#include <algorithm>
#include <cmath>
#include <string>

#include "goshawk/path_search/grid_search.hpp"
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

Result<CornerRule> parse_corner_rule(std::string_view word) {
  if (word == "no_squeeze") return CornerRule::no_squeeze;
  if (word == "squeeze") return CornerRule::squeeze;
  return fail(ErrorCode::invalid_parameter,
              "corner_rule is '" + std::string(word) + "': it must be no_squeeze or squeeze");
}

namespace {

Weights weights_of(const Config& config, double resolution_m) {
  Weights weights{.climb = config.z_weight};
  if (config.unknown == "costly") weights.unknown = config.unknown_weight;
  if (config.clearance_m > 0.0) {
    weights.clearance = config.clearance_weight;
    weights.reach_voxels =
        int(std::min(std::ceil(config.clearance_m / resolution_m), double(CostField::kMaxReach)));
  }
  return weights;
}

Result<std::unique_ptr<GridPlanner>> make_weighted(const Config& config, CornerRule rule,
                                                   const Weights& weights) {
  // JA*'s pruning presumes plain costs. Its answer to others is that of A*.
  if (config.planner == "jastar" || config.planner == "astar") {
    return make_weighted_search("astar_weighted", true, rule, weights);
  }
  if (config.planner == "dijkstra") {
    return make_weighted_search("dijkstra_weighted", false, rule, weights);
  }
  return fail(ErrorCode::invalid_parameter,
              "planner " + config.planner +
                  " knows lengths only: with z_weight, clearance_m or unknown: costly use jastar, "
                  "astar or dijkstra");
}

}  // namespace

Result<std::unique_ptr<GridPlanner>> make_planner(const Config& config, double resolution_m) {
  if (auto status = check(config); !status) return status.error();
  const auto rule = parse_corner_rule(config.corner_rule);
  if (!rule) return rule.error();
  const Weights weights = weights_of(config, resolution_m);
  if (!weights.plain()) return make_weighted(config, *rule, weights);
  const SamplingOptions sampling{
      .max_iterations = config.max_iterations,
      .step_voxels = config.step_m / resolution_m,
      .seed = std::uint64_t(config.seed),
      .validity = config.validity == "fcl" ? Validity::fcl : Validity::grid};
  const std::string_view name = config.planner;
  if (name == "rrt") return make_sampling_search(SamplingMethod::rrt, sampling);
  if (name == "rrtstar") return make_sampling_search(SamplingMethod::rrtstar, sampling);
  if (name == "prm") return make_sampling_search(SamplingMethod::prm, sampling);
  if (name == "astar") return make_grid_search(Variant::astar, *rule);
  if (name == "astar_euclidean") return make_grid_search(Variant::astar_euclidean, *rule);
  if (name == "astar_manhattan") return make_grid_search(Variant::astar_manhattan, *rule);
  if (name == "dijkstra") return make_grid_search(Variant::dijkstra, *rule);
  return make_grid_search(Variant::jastar, *rule);
}

}  // namespace goshawk::path_search
