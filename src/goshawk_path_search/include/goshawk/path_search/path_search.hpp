#pragma once

#include <memory>
#include <string>
#include <vector>

#include "goshawk/core/grid_geometry.hpp"
#include "goshawk/path_search/config.hpp"
#include "goshawk/path_search/planner.hpp"
#include "goshawk/path_search/pruning.hpp"

namespace goshawk::path_search {

/// The answer of the stage. Points in frame `map`.
struct PlannedPath {
  std::vector<Vec3> raw_map;        // [m] start, the centres of the voxels between, goal
  std::vector<Vec3> waypoints_map;  // [m] after pruning; first and last are start and goal
  double raw_length_m = 0.0;        // [m] of raw_map
  double pruned_length_m = 0.0;     // [m] of waypoints_map, never more than raw_length_m
  double cost = 0.0;                // [m] length over voxel centres, which the search minimises
  Counters counters;
  std::string implementation;  // the planner's name
};

/// The path search stage: a map and two points in, a pruned path out.
///
/// Under the no-squeeze rule every raw and every pruned segment passes goshawk::line_is_free.
/// Under squeeze, raw moves may touch obstacle edges; a pruned segment that does is such a move.
/// A start and a goal that are equal, or in one voxel, give two points.
class PathSearch {
 public:
  /// @return invalid_parameter for a word that is not one of Config's choices
  static Result<PathSearch> create(const Config& config);

  /// The map is kept, and must not change afterwards. A null or malformed map is reported by
  /// plan().
  void set_map(std::shared_ptr<const VoxelGrid> map);

  /// @param start_map, goal_map [m]
  /// @return the errors of goshawk::locate and GridPlanner::search; under no-squeeze also
  /// start_occupied or goal_occupied for a point on the very face of a blocked voxel
  Result<PlannedPath> plan(const Vec3& start_map, const Vec3& goal_map);

  /// The same into memory that is reused: a repeated query allocates nothing.
  Status plan(const Vec3& start_map, const Vec3& goal_map, PlannedPath& path);

  std::string_view planner_name() const { return planner_->name(); }

 private:
  PathSearch(std::unique_ptr<GridPlanner> planner, CornerRule rule, Pruning pruning)
      : planner_(std::move(planner)), rule_(rule), pruning_(pruning) {}
  Status check_clear_of_faces(const Vec3& p_map, Endpoint endpoint) const;
  void fill(const Vec3& start_map, const Vec3& goal_map, PlannedPath& path);

  std::unique_ptr<GridPlanner> planner_;
  CornerRule rule_;
  Pruning pruning_;
  PathPruner pruner_;
  std::shared_ptr<const VoxelGrid> map_;
  Error map_error_{ErrorCode::no_map, "no map yet: wait for one, or load one, before planning"};
  VoxelPath voxel_path_;
  std::vector<Vec3> nodes_grid_;
  std::vector<int> kept_;
};

}  // namespace goshawk::path_search
