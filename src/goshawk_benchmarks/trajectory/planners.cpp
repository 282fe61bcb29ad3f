#include "planners.hpp"

#include <chrono>
#include <cmath>

#include "goshawk/baselines/polynomial_baselines.hpp"

namespace goshawk::bench {
namespace {

template <typename Work>
auto timed(double& ms, Work&& work) {
  const auto begin = std::chrono::steady_clock::now();
  auto result = work();
  ms = std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin).count();
  return result;
}

FlatState at_rest(const Vec3& position) {
  FlatState state;
  state.position = position;
  return state;
}

}  // namespace

const std::vector<std::string>& Planner::names() {
  static const std::vector<std::string> kNames{"goshawk", "thesis", "minimum_snap", "minimum_jerk"};
  return kNames;
}

std::optional<Planner> Planner::make(const std::string& name) {
  Planner planner;
  planner.name_ = name;
  path_search::Config search;
  search.planner = planner.samples()        ? path_search::Planner::rrtstar
                   : name == "minimum_jerk" ? path_search::Planner::astar
                                            : path_search::Planner::jastar;
  auto made = path_search::PathSearch::create(search);
  if (!made) return std::nullopt;
  planner.search_ = *std::move(made);
  if (planner.samples()) return planner;
  planner.builder_ = corridor_builder::CorridorBuilder::create({}).value();
  if (name == "goshawk") {
    planner.optimizer_ = trajectory_optimizer::TrajectoryOptimizer::create({}).value();
  } else {
    planner.baseline_ =
        baselines::BaselineOptimizer::create({from_word<baselines::Method>(name).value()}).value();
  }
  return planner;
}

Flight Planner::fly(const Task& task) {
  search_->set_map(task.grid);
  if (samples()) return plan(task);  // memory is nothing beside a second of sampling
  plan(task);
  return plan(task);
}

Flight Planner::plan(const Task& task) {
  Flight flight;
  const auto path = timed(flight.search_ms, [&] { return search_->plan(task.start, task.goal); });
  if (!path) return flight;
  flight.path_length_m = path->pruned_length_m;
  Result<Corridor> corridor = Corridor{};
  if (builder_) {
    corridor =
        timed(flight.corridor_ms, [&] { return builder_->build(*task.grid, path->waypoints_map); });
    if (!corridor) return flight;
  }
  auto trajectory = timed(flight.optimise_ms, [&] {
    return builder_ ? optimise(task, *corridor)
                    : baselines::minimum_snap(path->waypoints_map, at_rest(task.start),
                                              at_rest(task.goal), task.limits);
  });
  flight.solved = trajectory.ok();
  flight.certified = trajectory.ok() && builder_;
  if (trajectory) flight.trajectory = *std::move(trajectory);
  return flight;
}

Result<Trajectory> Planner::optimise(const Task& task, const Corridor& corridor) {
  const PlanRequest request{
      .start = at_rest(task.start), .goal = at_rest(task.goal), .limits = task.limits};
  auto solution =
      baseline_ ? baseline_->optimise(request, corridor) : optimizer_->optimise(request, corridor);
  if (!solution) return solution.error();
  return solution->trajectory();
}

bool is_safe(const Trajectory& trajectory, const VoxelGrid& grid) {
  constexpr double kStep_s = 0.005;
  constexpr double kTouch_m = 1e-6;
  const auto blocked = [&](const Vec3& p) {
    const auto voxel = grid.geometry.index_of(p);
    return !voxel || grid.grown.test(*voxel);
  };
  // Inside an obstacle, and not only on its face, where every neighbour of the point is inside.
  const auto inside = [&](const Vec3& p) {
    for (int corner = 0; corner < 8; ++corner) {
      const Vec3 step((corner & 1) != 0 ? kTouch_m : -kTouch_m,
                      (corner & 2) != 0 ? kTouch_m : -kTouch_m,
                      (corner & 4) != 0 ? kTouch_m : -kTouch_m);
      if (!blocked(p + step)) return false;
    }
    return true;
  };
  for (const BezierPiece& piece : trajectory.pieces) {
    const int steps = int(std::ceil(piece.duration_s / kStep_s));
    for (int i = 0; i <= steps; ++i) {
      if (inside(piece.sample(piece.duration_s * i / steps).position)) return false;
    }
  }
  return true;
}

}  // namespace goshawk::bench
