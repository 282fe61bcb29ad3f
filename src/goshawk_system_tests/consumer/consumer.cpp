// Uses every core library once, as a user's own program does, and prints what came out: path,
// corridor, trajectory, a committed flight in the simulator. consumer_test.py compiles it for
// processors that the libraries were not compiled for.
#include <cstdio>
#include <cstdlib>
#include <memory>

#include "goshawk/core/committed_trajectory.hpp"
#include "goshawk/corridor_builder/corridor_builder.hpp"
#include "goshawk/navigator/navigator.hpp"
#include "goshawk/path_search/path_search.hpp"
#include "goshawk/simulator/quadrotor.hpp"
#include "goshawk/tracker/tracker.hpp"
#include "goshawk/trajectory_optimizer/trajectory_optimizer.hpp"

using namespace goshawk;

namespace {

template <typename T>
T need(Result<T> result, const char* what) {
  if (result) return *std::move(result);
  std::printf("%s: %s\n", what, result.error().message.c_str());
  std::exit(1);
}

// A wall with a gap.
std::shared_ptr<const VoxelGrid> make_map() {
  auto grid = std::make_shared<VoxelGrid>();
  grid->geometry = {Vec3::Zero(), 0.2, {30, 40, 20}};
  grid->grown = BitGrid(grid->geometry.size, true);
  for (int z = 0; z < 20; ++z) {
    for (int x = 0; x < 22; ++x) grid->grown.set({x, 20, z}, true);
  }
  return grid;
}

CertifiedTrajectory plan(const std::shared_ptr<const VoxelGrid>& map, const FlatState& start,
                         const FlatState& goal, const Limits& limits) {
  auto search = need(path_search::PathSearch::create({}), "search");
  search.set_map(map);
  const auto path = need(search.plan(start.position, goal.position), "path");
  auto builder = need(corridor_builder::CorridorBuilder::create({}), "builder");
  const Corridor corridor = need(builder.build(*map, path.waypoints_map), "corridor");
  auto optimizer = need(trajectory_optimizer::TrajectoryOptimizer::create({}), "optimizer");
  const PlanRequest request{.start = start, .goal = goal, .limits = limits};
  const auto solution = need(optimizer.optimise(request, corridor), "trajectory");
  std::printf("path %.9f m, %zu polytopes, %zu pieces, %.9f s\n", path.pruned_length_m,
              corridor.polytopes.size(), solution.trajectory().pieces.size(),
              solution.trajectory().duration_s());
  return solution.certified;
}

// @return [m] the largest tracking error
double fly(const std::shared_ptr<const VoxelGrid>& map, const CommittedTrajectory& committed,
           const FlatState& start) {
  auto vehicle = need(simulator::Quadrotor::create({}), "simulator");
  auto tracker = need(tracker::Tracker::create({}), "tracker");
  need(vehicle.reset(start.position, 0.0), "reset");
  tracker.set_map(map, vehicle.time_ns());
  bool accepted = false;
  while (vehicle.time_ns() < std::int64_t(1e9 * (committed.flown().duration_s() + 1.0))) {
    const auto now_ns = vehicle.time_ns();
    need(vehicle.command(need(tracker.step(vehicle.state(), now_ns), "step")), "command");
    if (!accepted) need(tracker.accept(committed, now_ns), "accept");
    accepted = true;
    need(vehicle.advance(0.004), "advance");
  }
  return tracker.status().max_error_m;
}

}  // namespace

int main() {
  const auto map = make_map();
  FlatState start, goal;
  start.position = Vec3(1, 1, 1);
  goal.position = Vec3(1, 7, 2);
  navigator::Navigator navigator({}, 1);
  navigator.on_map(map, 1);
  navigator.on_odometry({.position_map = start.position}, 1);
  need(navigator.on_goal(goal.position, 0.0, 1), "goal");
  for (const auto& order : navigator.take_orders()) {
    if (const auto* request = std::get_if<PlanRequest>(&order)) {
      const auto certified = plan(map, request->start, request->goal, request->limits);
      navigator.on_trajectory(
          {.id = request->id, .nominal = certified, .map_version = map->version}, 1, 1);
    }
  }
  for (const auto& order : navigator.take_orders()) {
    if (const auto* commit = std::get_if<navigator::Commit>(&order)) {
      const CommittedTrajectory& committed = commit->trajectory;
      std::printf("certified to %.1e m, flown to %.4f m\n",
                  committed.nominal().certificate().goal_m, fly(map, committed, start));
      return 0;
    }
  }
  std::printf("nothing was committed\n");
  return 1;
}
