#pragma once

#include <memory>
#include <optional>

#include "goshawk/core/plan_request.hpp"
#include "goshawk/corridor_builder/corridor_builder.hpp"
#include "goshawk/map_server/config.hpp"
#include "goshawk/path_search/path_search.hpp"
#include "goshawk/runtime/ros_args.hpp"
#include "goshawk/trajectory_optimizer/trajectory_optimizer.hpp"
#include "goshawk/worlds/world.hpp"

namespace goshawk::cli {

/// The parameters of the stages that plan, read from the same files as the components'.
struct PlanningConfig {
  map_server::Config map;
  path_search::Config search;
  corridor_builder::Config corridor;
  trajectory_optimizer::Config trajectory;

  static Result<PlanningConfig> read(const runtime::RosArgs& args);

  /// Whether the parameters name no map: then a made world stands for it.
  bool needs_world() const { return map.map_file.empty() && !map.use_box; }
};

struct StageTime {
  std::string name;
  std::string implementation;
  double compute_us = 0.0;
};

/// A map as it is, and as the vehicle's centre sees it.
struct LoadedMap {
  map_server::RawVoxels raw;
  std::shared_ptr<const VoxelGrid> grown;
  std::vector<std::string> notes = {};  // of the map file: what was assumed, or looks wrong
};
/// @param world that is made if the config names no map
Result<LoadedMap> load_map(const PlanningConfig& config,
                           const worlds::WorldSpec& world = worlds::default_world());

/// What came out of each stage, as far as it went.
struct Plan {
  PlanRequest request;  // start and goal as the search moved them
  std::vector<StageTime> stages;
  std::optional<path_search::PlannedPath> path;
  std::optional<Corridor> corridor;
  std::optional<trajectory_optimizer::Solution> solution;
  Status outcome = success();
};

/// All planning stages one after another in this process, without middleware.
class Planner {
 public:
  static Result<Planner> create(const PlanningConfig& config);
  void set_map(const LoadedMap& map);
  Plan plan(const PlanRequest& request);

 private:
  Planner(path_search::PathSearch search, corridor_builder::CorridorBuilder builder,
          trajectory_optimizer::TrajectoryOptimizer optimizer)
      : search_(std::move(search)),
        builder_(std::move(builder)),
        optimizer_(std::move(optimizer)) {}
  Status run(Plan& plan);

  path_search::PathSearch search_;
  corridor_builder::CorridorBuilder builder_;
  trajectory_optimizer::TrajectoryOptimizer optimizer_;
  std::shared_ptr<const VoxelGrid> grid_;
};

}  // namespace goshawk::cli
