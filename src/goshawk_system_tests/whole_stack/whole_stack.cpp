#include "whole_stack.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "goshawk/core/inflation.hpp"

namespace goshawk::whole_stack {
namespace {

constexpr std::int64_t kPlanning_ns = 8'000'000;
constexpr double kStep_s = 0.004;
constexpr int kNavigatorEvery = 5;  // steps

void need(const Status& status) {
  if (!status) throw std::runtime_error(status.error().message);
}

simulator::Config vehicle_config(std::uint64_t seed) {
  simulator::Config config;
  config.gust_seed = int(seed % 1'000'000);
  config.landing = LandingRule::never;
  return config;
}

}  // namespace

World::World(const GridGeometry& geometry, BitGrid raw)
    : geometry_(geometry), raw_(std::move(raw)) {
  grow();
}

void World::grow() {
  const double radius_m = kBodyRadius_m + kMargin_m;
  auto grown = inflate(raw_, radius_m, geometry_.resolution_m);
  need(grown ? success() : grown.error());
  grid_ = std::make_shared<const VoxelGrid>(VoxelGrid{.geometry = geometry_,
                                                      .grown = *std::move(grown),
                                                      .known = {},
                                                      .raw = raw_,
                                                      .version = ++version_,
                                                      .inflation_m = radius_m});
}

void World::add(Index3 voxel) {
  raw_.set(voxel, true);
  grow();
}

double World::distance_m(const Vec3& p_map, double within_m) const {
  const Vec3 p = geometry_.to_grid(p_map);
  const int reach = int(std::ceil(within_m / geometry_.resolution_m));
  const Index3 at{int(std::floor(p.x())), int(std::floor(p.y())), int(std::floor(p.z()))};
  double nearest = within_m;
  for (int z = at.z - reach; z <= at.z + reach; ++z) {
    for (int y = at.y - reach; y <= at.y + reach; ++y) {
      for (int x = at.x - reach; x <= at.x + reach; ++x) {
        if (!raw_.contains({x, y, z}) || !raw_.get({x, y, z})) continue;
        const Vec3 corner(x, y, z);
        const Vec3 off = (corner - p).cwiseMax(p - corner - Vec3::Ones()).cwiseMax(0.0);
        nearest = std::min(nearest, geometry_.resolution_m * off.norm());
      }
    }
  }
  return nearest;
}

Vec3 World::free_place(Random& random) const {
  for (;;) {
    const Index3 voxel{random.below(geometry_.size.x), random.below(geometry_.size.y),
                       random.below(geometry_.size.z)};
    if (!grid_->grown.get(voxel)) return geometry_.center(voxel);
  }
}

Stack::Stack(World& world, const Vec3& start_map, std::uint64_t seed)
    : vehicle(simulator::Quadrotor::create(vehicle_config(seed)).value()),
      tracker(tracker::Tracker::create({}).value()),
      navigator({}, 1),
      world_(world),
      search_(path_search::PathSearch::create({}).value()),
      builder_(corridor_builder::CorridorBuilder::create({}).value()),
      optimizer_(trajectory_optimizer::TrajectoryOptimizer::create({}).value()) {
  need(vehicle.reset(start_map, 0.0));
  tell_map();
  run(0.2);
}

void Stack::tell_map() {
  search_.set_map(world_.grid());
  tracker.set_map(world_.grid(), now_ns());
  watch_tracker();
}

void Stack::go_to(const Vec3& goal_map) {
  need(navigator.on_goal(goal_map, 0.0, now_ns()));
}

void Stack::run(double duration_s, const std::function<void()>& each) {
  const std::int64_t end_ns = now_ns() + std::llround(duration_s * 1e9);
  while (now_ns() < end_ns) {
    step();
    if (each) each();
  }
}

void Stack::run_until_done(double most_s, const std::function<void()>& each) {
  const std::int64_t end_ns = now_ns() + std::llround(most_s * 1e9);
  const auto is_done = [&] {
    return state() == navigator::State::arrived || state() == navigator::State::failed;
  };
  while (now_ns() < end_ns && !is_done()) {
    step();
    if (each) each();
  }
}

void Stack::step() {
  if (command_) need(vehicle.command(*command_));
  const auto measured = vehicle.measure();
  const auto command = tracker.step(measured.state, measured.time_ns, now_ns());
  command_ = command ? std::optional(*command) : std::nullopt;
  tracker.heard_navigator(now_ns());
  max_error_m = std::max(max_error_m, tracker.status().error_m);
  watch_tracker();
  navigator.on_odometry(measured.state, now_ns());
  for (; !planned_.empty() && planned_.front().at_ns <= now_ns(); planned_.pop_front()) {
    auto& [at_ns, id, outcome, stage] = planned_.front();
    if (outcome) {
      navigator.on_trajectory(*std::move(outcome), now_ns());
    } else {
      navigator.on_report(id, stage, outcome.error(), now_ns());
    }
  }
  if (++steps_ % kNavigatorEvery == 0) navigator.tick(now_ns());
  serve_navigator();
  need(vehicle.advance(kStep_s));
}

void Stack::serve_navigator() {
  for (const auto& what : navigator.take_orders()) {
    std::visit([this](const auto& o) { order(o); }, what);
  }
}

void Stack::order(const PlanRequest& request) {
  StageRole stage = StageRole::path_search;
  auto outcome = plan(request, stage);
  planned_.push_back({now_ns() + kPlanning_ns, request.id, std::move(outcome), stage});
}

Result<Commitment> Stack::plan(const PlanRequest& request, StageRole& stage) {
  const auto path = search_.plan(request);
  if (!path) return path.error();
  stage = StageRole::corridor_builder;
  const auto corridor = builder_.build(*world_.grid(), path->waypoints_map);
  if (!corridor) return corridor.error();
  stage = StageRole::trajectory_optimizer;
  auto solution = optimizer_.optimise(request, *corridor);
  if (!solution) return solution.error();
  return Commitment{.id = request.id,
                    .nominal = std::move(solution->certified),
                    .map_version = world_.grid()->version,
                    .yaw_curve = std::move(solution->yaw)};
}

void Stack::order(const CommittedTrajectory& committed) {
  ++commits;
  const Status answer = tracker.accept(committed, now_ns());
  if (answer) {
    flown = committed;
  } else {
    refusals.push_back(answer.error());
  }
  const Error outcome = answer ? Error{ErrorCode::ok, ""} : answer.error();
  navigator.on_report(committed.id(), StageRole::tracker, outcome, now_ns());
}

void Stack::watch_tracker() {
  const auto status = tracker.status();
  if (status.fault.code != ErrorCode::ok && status.fault.message != said_) {
    faults.push_back(status.fault);
    if (status.lost_trajectory_id != 0) {
      navigator.on_report(status.lost_trajectory_id, StageRole::tracker, status.fault, now_ns());
    }
  }
  said_ = status.fault.message;
}

}  // namespace goshawk::whole_stack
