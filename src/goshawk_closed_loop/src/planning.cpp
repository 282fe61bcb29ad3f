#include "goshawk/closed_loop/planning.hpp"

#include <ctime>
#include <optional>

#include "goshawk/corridor_builder/horizon.hpp"

namespace goshawk::closed_loop {

double processor_time_s(const std::function<void()>& work) {
  const auto now_s = [] {
    timespec t{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
  };
  const double begin_s = now_s();
  work();
  return now_s() - begin_s;
}

Result<Planning> Planning::create(const Config& config) {
  auto search = path_search::PathSearch::create(config.search);
  if (!search) return search.error();
  auto builder = corridor_builder::CorridorBuilder::create(config.corridor);
  if (!builder) return builder.error();
  auto optimizer = trajectory_optimizer::TrajectoryOptimizer::create(config.optimizer);
  if (!optimizer) return optimizer.error();
  return Planning(*std::move(search), *std::move(builder), *std::move(optimizer),
                  config.corridor.horizon_m);
}

void Planning::set_map(std::shared_ptr<const VoxelGrid> map) {
  map_ = std::move(map);
  search_.set_map(map_);
}

Planning::Answer Planning::plan(const PlanRequest& request, const Stopwatch& stopwatch) {
  Times times;
  std::optional<Result<path_search::PlannedPath>> path;
  times.search_s = stopwatch([&] { path.emplace(search_.plan(request)); });
  if (!*path) return {path->error(), StageRole::path_search, {}, times};
  const auto part = corridor_builder::within_horizon((*path)->waypoints_map, horizon_m_);
  const std::vector<Vec3>& waypoints = part.waypoints_map;
  const navigator::Shortfall shortfall{(*path)->goal_moved_m, part.beyond_m};
  std::optional<Result<Corridor>> corridor;
  times.corridor_s = stopwatch([&] { corridor.emplace(builder_.build(*map_, waypoints)); });
  if (!*corridor) return {corridor->error(), StageRole::corridor_builder, shortfall, times};
  // As the search moved the ends, if it did, and within the horizon.
  PlanRequest moved = request;
  if ((*path)->start_moved_m > 0.0) moved.start.position = waypoints.front();
  moved.goal.position = waypoints.back();
  std::optional<Result<trajectory_optimizer::Solution>> solution;
  times.optimizer_s = stopwatch([&] { solution.emplace(optimizer_.optimise(moved, **corridor)); });
  if (!*solution) return {solution->error(), StageRole::trajectory_optimizer, shortfall, times};
  return {Commitment{.id = request.id,
                     .nominal = std::move((*solution)->certified),
                     .map_version = map_->version,
                     .yaw_curve = std::move((*solution)->yaw)},
          StageRole::trajectory_optimizer, shortfall, times};
}

}  // namespace goshawk::closed_loop
