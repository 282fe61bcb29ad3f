#pragma once

#include <map>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "goshawk/core/grid_geometry.hpp"
#include "goshawk/core/plan_request.hpp"
#include "goshawk/path_search/config.hpp"
#include "goshawk/path_search/ends.hpp"
#include "goshawk/path_search/planner.hpp"
#include "goshawk/path_search/pruning.hpp"
#include "goshawk/path_search/search_map.hpp"

namespace goshawk::path_search {

/// What a search needs of a request: a view. Points in frame `map`.
struct PlanQuery {
  Vec3 start_map = Vec3::Zero();    // [m]
  std::span<const Vec3> goals_map;  // [m] any one of them will do
  StopSignal stop = {};             // beside Config::time_limit_s: whichever comes first
  UnknownSpace unknown = UnknownSpace::as_configured;
};

/// The answer of the stage. Points in frame `map`.
struct PlannedPath {
  std::vector<Vec3> raw_map;        // [m] start, the centres of the voxels between, goal
  std::vector<Vec3> waypoints_map;  // [m] after pruning; first and last are start and goal
  double raw_length_m = 0.0;        // [m] of raw_map
  double pruned_length_m = 0.0;     // [m] of waypoints_map, never more than raw_length_m
  double cost = 0.0;                // [m] what the search minimises: over voxel centres, weighted
  Counters counters;
  std::string implementation;  // the planner's name
  std::size_t goal = 0;        // which goal was reached, or is nearest
  double start_moved_m = 0.0;  // [m] raw_map.front() is so far from the start asked for
  double goal_moved_m = 0.0;   // [m] raw_map.back() is so far from that goal
  bool cut_off = false;        // no goal can be reached; this leads as near to one as possible

  /// What the user should know of the points above, or nothing.
  std::string note() const;
};

/// The path search stage: a map and two points in, a pruned path out.
///
/// Under the no-squeeze rule every raw and every pruned segment passes goshawk::line_is_free.
/// Under squeeze, raw moves may touch obstacle edges; a pruned segment that does is such a move.
/// A start and a goal that are equal, or in one voxel, give two points.
class PathSearch {
 public:
  /// @return invalid_parameter for what Config does not allow
  static Result<PathSearch> create(const Config& config);

  /// From the next query on by this config, on the map that is there; or as before.
  /// @return invalid_parameter, or why the map that is there cannot be searched like that
  Status reconfigure(const Config& config);

  /// The map is kept, and must not change afterwards. Of a further version of the same map only
  /// chunks that differ are looked at. A null or malformed map is reported by plan().
  void set_map(std::shared_ptr<const VoxelGrid> map);

  /// @return the errors of place_end(), SearchMap and GridPlanner::search(). Of several
  /// goals those that are not free are left out; if none is left the error is the first one's
  Result<PlannedPath> plan(const PlanQuery& query);
  Result<PlannedPath> plan(const PlanRequest& request, const StopSignal& stop = {});
  Result<PlannedPath> plan(const Vec3& start_map, const Vec3& goal_map);

  /// The same into memory that is reused: a repeated query allocates nothing (grid searches).
  Status plan(const PlanQuery& query, PlannedPath& path);
  Status plan(const Vec3& start_map, const Vec3& goal_map, PlannedPath& path);

  std::string_view planner_name() const { return planner_->name(); }

 private:
  PathSearch(const Config& config, std::unique_ptr<GridPlanner> planner,
             const std::optional<SearchBox>& box)
      : config_(config),
        planner_(std::move(planner)),
        has_box_(box.has_value()),
        search_map_(config.unknown, box) {}
  Status place(const PlanQuery& query);
  Status search(const PlanQuery& query, PlannedPath& path);
  void fill(PlannedPath& path);
  void relax(std::vector<Vec3>& waypoints_map);
  PathSearch* other_search(UnknownSpace unknown);

  Config config_;
  std::unique_ptr<GridPlanner> planner_;
  bool has_box_;
  SearchMap search_map_;
  PathPruner pruner_;
  double planner_resolution_m_ = 0.0;
  std::shared_ptr<const VoxelGrid> given_map_;
  std::shared_ptr<const VoxelGrid> map_;  // as search_map_ has it
  // For requests that take unknown space in another way than the configuration; made when needed.
  std::map<UnknownRule, std::unique_ptr<PathSearch>> others_;
  Error map_error_{ErrorCode::no_map, "no map yet: wait for one, or load one, before planning"};

  // Of the query at work.
  PlacedEnd start_;
  std::vector<PlacedEnd> goals_;
  std::vector<std::size_t> goal_numbers_;  // of goals_ in the query
  std::vector<End> goal_ends_;
  VoxelPath voxel_path_;
  std::vector<Vec3> nodes_grid_;
  std::vector<int> kept_;
  std::vector<Vec3> relaxed_grid_, relaxed_map_;
};

}  // namespace goshawk::path_search
