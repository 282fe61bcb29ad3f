#include "goshawk/path_search/path_search.hpp"

#include <algorithm>
#include <cstdio>
#include <utility>

#include "goshawk/core/line_of_sight.hpp"
#include "goshawk/path_search/reachable.hpp"
#include "goshawk/path_search/relaxation.hpp"

namespace goshawk::path_search {
namespace {

double polyline_length(const std::vector<Vec3>& points) {
  double sum = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) sum += (points[i] - points[i - 1]).norm();
  return sum;
}

std::string metres(double value_m) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3f m", value_m);
  return text;
}

StopSignal earlier(const StopSignal& asked, double time_limit_s) {
  StopSignal stop = StopSignal::after(time_limit_s);
  if (asked.deadline && (!stop.deadline || *asked.deadline < *stop.deadline)) {
    stop.deadline = asked.deadline;
  }
  stop.token = asked.token;
  return stop;
}

}  // namespace

std::string PlannedPath::note() const {
  std::string text;
  const auto add = [&text](const std::string& what) { text += (text.empty() ? "" : "; ") + what; };
  if (start_moved_m > 0.0)
    add("start moved by " + metres(start_moved_m) + " to the nearest free voxel");
  if (cut_off) {
    add("no goal can be reached: the path ends " + metres(goal_moved_m) + " from the nearest one");
  } else if (goal_moved_m > 0.0) {
    add("goal moved by " + metres(goal_moved_m) + " to the nearest free voxel");
  }
  return text;
}

Result<PathSearch> PathSearch::create(const Config& config) {
  if (auto status = check(config); !status) return status.error();
  auto planner = make_planner(config);
  if (!planner) return planner.error();
  const auto box = parse_search_box(config.search_box);
  if (!box) return box.error();
  return PathSearch(config, std::move(planner).value(), *box);
}

Status PathSearch::reconfigure(const Config& config) {
  auto other = create(config);
  if (!other) return other.error();
  if (given_map_ != nullptr) other->set_map(given_map_);
  if (map_ != nullptr && other->map_ == nullptr) return other->map_error_;
  *this = *std::move(other);
  return success();
}

void PathSearch::set_map(std::shared_ptr<const VoxelGrid> map) {
  given_map_ = map;
  map_.reset();
  if (!map) {
    map_error_ = fail(ErrorCode::no_map, "no map: wait for one, or load one, before planning");
    return;
  }
  if (auto status = map->check(); !status) {
    map_error_ = status.error();
    return;
  }
  auto searched = search_map_.follow(std::move(map));
  if (!searched) {
    map_error_ = searched.error();
    return;
  }
  // Lengths in metres are voxels to a planner.
  const double resolution_m = (*searched)->geometry.resolution_m;
  if (resolution_m != planner_resolution_m_) {
    auto planner = make_planner(config_, resolution_m);
    if (!planner) {
      map_error_ = planner.error();
      return;
    }
    planner_ = *std::move(planner);
    planner_resolution_m_ = resolution_m;
  }
  map_ = *std::move(searched);
  const bool costly = config_.unknown == UnknownRule::costly && !map_->known.empty();
  planner_->set_map(map_->grown, costly ? &map_->known : nullptr);
}

Result<PlannedPath> PathSearch::plan(const PlanQuery& query) {
  PlannedPath path;
  if (auto status = plan(query, path); !status) return status.error();
  return path;
}

Result<PlannedPath> PathSearch::plan(const PlanRequest& request, const StopSignal& stop) {
  std::vector<Vec3> goals_map = {request.goal.position};
  goals_map.insert(goals_map.end(), request.other_goals_map.begin(), request.other_goals_map.end());
  return plan(PlanQuery{.start_map = request.start.position,
                        .goals_map = goals_map,
                        .stop = stop,
                        .unknown = request.unknown});
}

Result<PlannedPath> PathSearch::plan(const Vec3& start_map, const Vec3& goal_map) {
  return plan(PlanQuery{.start_map = start_map, .goals_map = {&goal_map, 1}});
}

Status PathSearch::plan(const Vec3& start_map, const Vec3& goal_map, PlannedPath& path) {
  return plan(PlanQuery{.start_map = start_map, .goals_map = {&goal_map, 1}}, path);
}

// The map as such a request sees it has a search of its own, which follows the map from then on.
// @return nothing if the configuration does as well
PathSearch* PathSearch::other_search(UnknownSpace unknown) {
  if (unknown == UnknownSpace::as_configured || !given_map_) return nullptr;
  const UnknownRule rule = unknown == UnknownSpace::blocked ? UnknownRule::blocked
                           : unknown == UnknownSpace::free  ? UnknownRule::free
                                                            : UnknownRule::costly;
  const bool blocked_anyway = rule == UnknownRule::blocked && given_map_->unknown_is_occupied &&
                              config_.unknown == UnknownRule::as_mapped;
  const bool free_anyway = rule == UnknownRule::free && !given_map_->unknown_is_occupied &&
                           config_.unknown == UnknownRule::as_mapped;
  if (rule == config_.unknown || blocked_anyway || free_anyway) return nullptr;
  auto& other = others_[rule];
  if (!other) {
    Config config = config_;
    config.unknown = rule;
    other = std::make_unique<PathSearch>(create(config).value());
  }
  if (other->given_map_ != given_map_) other->set_map(given_map_);
  return other.get();
}

Status PathSearch::plan(const PlanQuery& query, PlannedPath& path) {
  if (PathSearch* other = other_search(query.unknown)) {
    PlanQuery same = query;
    same.unknown = UnknownSpace::as_configured;
    return other->plan(same, path);
  }
  if (!map_) return map_error_;
  path.cut_off = false;
  if (auto status = place(query); !status) return status;
  if (auto status = search(query, path); !status) return status;
  fill(path);
  return success();
}

Status PathSearch::place(const PlanQuery& query) {
  const auto placed = [&](const Vec3& p, Endpoint endpoint) {
    auto end = place_end(*map_, config_.corner_rule, p, endpoint, config_.move_within_m);
    const bool outside =
        end.code() == ErrorCode::start_outside || end.code() == ErrorCode::goal_outside;
    if (!outside || !has_box_) return end;
    return Result<PlacedEnd>(fail(end.code(), end.error().message + " (cut by search_box)"));
  };
  const auto start = placed(query.start_map, Endpoint::start);
  if (!start) return start.error();
  start_ = *start;
  goals_.clear();
  goal_numbers_.clear();
  goal_ends_.clear();
  std::optional<Error> first;
  for (std::size_t k = 0; k < query.goals_map.size(); ++k) {
    const auto goal = placed(query.goals_map[k], Endpoint::goal);
    if (!goal) {
      if (!first) first = goal.error();
      continue;
    }
    goals_.push_back(*goal);
    goal_numbers_.push_back(k);
    goal_ends_.push_back(goal->end);
  }
  if (goals_.empty() && first) return *first;
  return success();
}

Status PathSearch::search(const PlanQuery& query, PlannedPath& path) {
  GridQuery voxels{
      .start = start_.end, .goals = goal_ends_, .stop = earlier(query.stop, config_.time_limit_s)};
  Status status = planner_->search(voxels, voxel_path_);
  if (status.code() != ErrorCode::no_path || !config_.nearest_reachable) return status;
  const auto nearest = nearest_reachable(map_->grown, config_.corner_rule, voxels);
  if (!nearest) return nearest.error();
  // One goal is left: the nearest one, moved to the voxel found.
  const Vec3 center_map = map_->geometry.center(*nearest);
  const auto distance = [&](const PlacedEnd& goal) { return (goal.at_map - center_map).norm(); };
  const auto best = std::ranges::min_element(goals_, {}, distance);
  const auto number = goal_numbers_[std::size_t(best - goals_.begin())];
  const bool at_start = *nearest == start_.end.cell;
  PlacedEnd moved{center_map, End::center_of(*nearest),
                  (center_map - query.goals_map[number]).norm()};
  if (at_start)
    moved = {start_.at_map, start_.end, (start_.at_map - query.goals_map[number]).norm()};
  goals_.assign(1, moved);
  goal_numbers_.assign(1, number);
  goal_ends_.assign(1, moved.end);
  voxels.goals = goal_ends_;
  path.cut_off = true;
  return planner_->search(voxels, voxel_path_);
}

void PathSearch::relax(std::vector<Vec3>& waypoints_map) {
  const GridGeometry& geometry = map_->geometry;
  relaxed_grid_.clear();
  for (const int k : kept_) relaxed_grid_.push_back(nodes_grid_[std::size_t(k)]);
  if (pull_tight(map_->grown, relaxed_grid_) == 0) return;
  relaxed_map_.clear();
  for (const Vec3& p : relaxed_grid_) {
    relaxed_map_.push_back(geometry.origin_map + geometry.resolution_m * p);
  }
  relaxed_map_.front() = waypoints_map.front();
  relaxed_map_.back() = waypoints_map.back();
  // A leg that was free by less than the rounding of metres: the nodes themselves will do.
  for (std::size_t i = 1; i < relaxed_map_.size(); ++i) {
    const Vec3 &a = relaxed_grid_[i - 1], &b = relaxed_grid_[i];
    const bool was_free = line_is_free(map_->grown, a, b);
    if (was_free && !line_is_free(*map_, relaxed_map_[i - 1], relaxed_map_[i])) return;
  }
  waypoints_map = relaxed_map_;
}

void PathSearch::fill(PlannedPath& path) {
  const GridGeometry& geometry = map_->geometry;
  const PlacedEnd& goal = goals_[voxel_path_.goal];
  path.raw_map.clear();
  path.raw_map.push_back(start_.at_map);
  for (std::size_t i = 1; i + 1 < voxel_path_.cells.size(); ++i) {
    path.raw_map.push_back(geometry.center(voxel_path_.cells[i]));
  }
  for (std::size_t i = 1; i + 1 < voxel_path_.points.size(); ++i) {
    path.raw_map.push_back(geometry.origin_map + geometry.resolution_m * voxel_path_.points[i]);
  }
  path.raw_map.push_back(goal.at_map);
  nodes_grid_.clear();
  for (const Vec3& p : path.raw_map) nodes_grid_.push_back(geometry.to_grid(p));
  pruner_.prune(config_.pruning, map_->grown, nodes_grid_, kept_);
  path.waypoints_map.clear();
  for (const int k : kept_) path.waypoints_map.push_back(path.raw_map[std::size_t(k)]);
  if (config_.pruning == Pruning::relaxed) relax(path.waypoints_map);
  path.raw_length_m = polyline_length(path.raw_map);
  path.pruned_length_m = polyline_length(path.waypoints_map);
  path.cost = voxel_path_.cost_voxels * geometry.resolution_m;
  path.counters = voxel_path_.counters;
  path.implementation = planner_->name();
  path.goal = goal_numbers_[voxel_path_.goal];
  path.start_moved_m = start_.moved_m;
  path.goal_moved_m = goal.moved_m;
}

}  // namespace goshawk::path_search
