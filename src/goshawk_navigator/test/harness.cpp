#include "harness.hpp"

#include <algorithm>

namespace goshawk::navigator {

RigidBodyState at(const Vec3& position, const Vec3& velocity, double yaw_rad) {
  return {.position_map = position,
          .velocity_map = velocity,
          .q_map_base = Quaternion(Eigen::AngleAxisd(yaw_rad, Vec3::UnitZ()))};
}

Config wide(Config config) {
  config.v_max_m_s = 99.0;
  config.a_max_m_s2 = 100.0;
  return config;
}

VoxelGrid free_map(std::uint64_t version) {
  const Index3 size{200, 200, 200};
  return {.geometry = {.origin_map = Vec3::Constant(-100.0), .resolution_m = 1.0, .size = size},
          .grown = BitGrid(size, true),
          .known = {},
          .version = version};
}

VoxelGrid map_with_wall(double x_m, std::uint64_t version) {
  VoxelGrid grid = free_map(version);
  for (int y = 0; y < 200; ++y) {
    for (int z = 0; z < 200; ++z) grid.grown.set({int(x_m) + 100, y, z}, true);
  }
  return grid;
}

Harness::Harness(const Config& config) : navigator(wide(config), 100) {
  navigator.on_map(std::make_shared<const VoxelGrid>(free_map()), now);
  navigator.on_odometry(at(kHome), now);
}

void Harness::goal(const Vec3& g) {
  ASSERT_TRUE(navigator.on_goal(g, 0.0, now).ok());
  take();
}

void Harness::take() {
  for (auto& order : navigator.take_orders()) {
    if (auto* plan = std::get_if<PlanRequest>(&order)) plans.push_back(*plan);
    if (auto* state = std::get_if<StateOrder>(&order)) states.push_back(*state);
    if (auto* complaint = std::get_if<Complaint>(&order)) complaints.push_back(*complaint);
    if (auto* commit = std::get_if<Commit>(&order)) {
      commits.push_back(commit->trajectory);
      const std::int64_t start_ns = commits.back().start_time_ns();
      std::erase_if(flown, [&](const auto& other) { return other.second >= start_ns; });
      flown.emplace_back(commits.back().flown(), start_ns);
    }
  }
}

void Harness::pass(double seconds) {
  const std::int64_t end = now + std::int64_t(seconds * 1e9);
  while (now < end) {
    now += kStep;
    if (odometry_comes) {
      const FlatState s = vehicle();
      navigator.on_odometry(at(s.position + offset, s.velocity + drift, yaw_rad), now);
    }
    navigator.tick(now);
    take();
  }
}

Commitment Harness::solve(const PlanRequest& request, double duration_s) {
  Trajectory line{{BezierPiece::between(request.start, request.goal, duration_s)}};
  const std::vector room{Polytope::box(Vec3::Constant(-99), Vec3::Constant(99))};
  return {.id = request.id,
          .nominal =
              certify(std::move(line), room, request.limits, request.start, request.goal).value(),
          .map_version = map_version,
          .yaw_curve = yaw_curve};
}

void Harness::answer(double duration_s) {
  const PlanRequest request = plans.back();
  for (const StageRole stage :
       {StageRole::path_search, StageRole::corridor_builder, StageRole::trajectory_optimizer}) {
    navigator.on_report(request.id, stage, ok(), now);
  }
  navigator.on_trajectory(solve(request, duration_s), ++answers, now);
  take();
}

void Harness::answer_up_to(const Vec3& end, double beyond_m, double duration_s) {
  PlanRequest request = plans.back();
  request.goal.position = end;
  navigator.on_report(request.id, StageRole::path_search, ok(), now);
  navigator.on_report(request.id, StageRole::corridor_builder, ok(), now, {.beyond_m = beyond_m});
  navigator.on_trajectory(solve(request, duration_s), ++answers, now);
  take();
}

void Harness::fails(ErrorCode code, StageRole stage, const std::string& message) {
  navigator.on_report(plans.back().id, stage, {code, message}, now);
  take();
}

void Harness::tracker_says(std::uint64_t id, const Error& outcome) {
  navigator.on_report(id, StageRole::tracker, outcome, now);
  take();
}

void Harness::map(VoxelGrid grid) {
  navigator.on_map(std::make_shared<const VoxelGrid>(std::move(grid)), now);
  take();
}

FlatState Harness::vehicle() const {
  FlatState s;
  s.position = kHome;
  for (const auto& [trajectory, start_ns] : flown) {
    if (now < start_ns) break;
    s = trajectory.sample(std::min(double(now - start_ns) * 1e-9, trajectory.duration_s()));
  }
  return s;
}

}  // namespace goshawk::navigator
