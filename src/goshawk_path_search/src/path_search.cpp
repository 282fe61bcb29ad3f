#include "goshawk/path_search/path_search.hpp"

#include <utility>

#include "goshawk/core/line_of_sight.hpp"

namespace goshawk::path_search {
namespace {

double polyline_length(const std::vector<Vec3>& points) {
  double sum = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) sum += (points[i] - points[i - 1]).norm();
  return sum;
}

// goshawk::locate builds its sentence before it knows whether one is needed, and so allocates:
// asked only where there is something to say.
Result<Index3> find_voxel(const VoxelGrid& map, const Vec3& p_map, Endpoint endpoint) {
  if (is_finite(p_map)) {
    const auto index = map.geometry.index_of(p_map);
    if (index && !map.occupied.get(*index)) return *index;
  }
  return locate(map, p_map, endpoint);
}

}  // namespace

Result<PathSearch> PathSearch::create(const Config& config) {
  auto planner = make_planner(config);
  if (!planner) return planner.error();
  const auto rule = parse_corner_rule(config.corner_rule);
  if (!rule) return rule.error();
  const auto pruning = parse_pruning(config.pruning);
  if (!pruning) return pruning.error();
  return PathSearch(std::move(planner).value(), *rule, *pruning);
}

void PathSearch::set_map(std::shared_ptr<const VoxelGrid> map) {
  map_.reset();
  if (!map) {
    map_error_ = fail(ErrorCode::no_map, "no map: wait for one, or load one, before planning");
    return;
  }
  if (auto status = map->check(); !status) {
    map_error_ = status.error();
    return;
  }
  planner_->set_map(map->occupied);
  map_ = std::move(map);
}

Result<PlannedPath> PathSearch::plan(const Vec3& start_map, const Vec3& goal_map) {
  PlannedPath path;
  if (auto status = plan(start_map, goal_map, path); !status) return status.error();
  return path;
}

Status PathSearch::plan(const Vec3& start_map, const Vec3& goal_map, PlannedPath& path) {
  if (!map_) return map_error_;
  const auto start = find_voxel(*map_, start_map, Endpoint::start);
  if (!start) return start.error();
  const auto goal = find_voxel(*map_, goal_map, Endpoint::goal);
  if (!goal) return goal.error();
  if (rule_ == CornerRule::no_squeeze) {
    if (auto s = check_clear_of_faces(start_map, Endpoint::start); !s) return s;
    if (auto s = check_clear_of_faces(goal_map, Endpoint::goal); !s) return s;
  }
  if (auto status = planner_->search(*start, *goal, voxel_path_); !status) return status;
  fill(start_map, goal_map, path);
  return success();
}

// A free voxel's face may be an obstacle's: no segment from a point on it clears that obstacle.
Status PathSearch::check_clear_of_faces(const Vec3& p_map, Endpoint endpoint) const {
  if (line_is_free(*map_, p_map, p_map)) return success();
  const bool start = endpoint == Endpoint::start;
  return fail(start ? ErrorCode::start_occupied : ErrorCode::goal_occupied,
              std::string(start ? "start " : "goal ") + to_text(p_map) +
                  " lies on the face of a blocked voxel or of the map: move it a little into the "
                  "free voxel, or use corner_rule squeeze");
}

void PathSearch::fill(const Vec3& start_map, const Vec3& goal_map, PlannedPath& path) {
  const GridGeometry& geometry = map_->geometry;
  path.raw_map.clear();
  path.raw_map.push_back(start_map);
  for (std::size_t i = 1; i + 1 < voxel_path_.cells.size(); ++i) {
    path.raw_map.push_back(geometry.center(voxel_path_.cells[i]));
  }
  path.raw_map.push_back(goal_map);
  nodes_grid_.clear();
  for (const Vec3& p : path.raw_map) nodes_grid_.push_back(geometry.to_grid(p));
  pruner_.prune(pruning_, map_->occupied, nodes_grid_, kept_);
  path.waypoints_map.clear();
  for (const int k : kept_) path.waypoints_map.push_back(path.raw_map[std::size_t(k)]);
  path.raw_length_m = polyline_length(path.raw_map);
  path.pruned_length_m = polyline_length(path.waypoints_map);
  path.cost = voxel_path_.cost_voxels * geometry.resolution_m;
  path.counters = voxel_path_.counters;
  path.implementation = planner_->name();
}

}  // namespace goshawk::path_search
