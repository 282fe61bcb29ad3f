#include "harness.hpp"

#include <algorithm>
#include <cmath>

#include "goshawk/core/inflation.hpp"

namespace goshawk::guard {

std::shared_ptr<const VoxelGrid> map_of(const MapSpec& spec) {
  constexpr Index3 kSize{100, 50, 20};
  auto grid = std::make_shared<VoxelGrid>();
  grid->geometry = {.origin_map = {0, -5, 0}, .resolution_m = 0.2, .size = kSize};
  grid->known = BitGrid(kSize, false);
  grid->raw = BitGrid(kSize, true, false);
  grid->inflation_m = 0.2;
  grid->unknown_is_occupied = false;
  grid->version = spec.version;
  for (int z = 0; z < kSize.z; ++z) {
    for (int y = 0; y < kSize.y; ++y) {
      for (int x = 0; x < kSize.x; ++x) {
        const Vec3 p = grid->geometry.center({x, y, z});
        const bool in_wall = p.x() > spec.wall_x_m && p.x() < spec.wall_x_m + 0.4;
        grid->known.set({x, y, z}, p.x() < spec.seen_until_x_m);
        grid->raw.set({x, y, z}, in_wall && std::abs(p.y() - spec.gap_y_m) > 1.0);
      }
    }
  }
  grid->grown = inflate(grid->raw, grid->inflation_m, 0.2).value();
  return grid;
}

Harness::Harness(const MapSpec& spec, const Config& config)
    : guard(config, make_repair(), 1), grid(map_of(spec)) {
  guard.set_map(grid, now);
  guard.on_heading(kYaw_rad);
  guard.on_tracking({Tracking::Mode::holds, kHome}, now);
}

void Harness::pass(double seconds) {
  const std::int64_t end = now + std::int64_t(seconds * 1e9);
  while (now < end) {
    now = std::min(end, now + kSecond / 50);
    const auto here = guard.flown().at(now);
    if (!here) continue;
    const bool rests = guard.flown().rests_from(now);
    guard.on_tracking({rests ? Tracking::Mode::holds : Tracking::Mode::follows, here->position},
                      now);
  }
}

void Harness::take() {
  for (auto& commit : guard.take_commits()) {
    commits.push_back(std::move(commit.trajectory));
    guard.on_tracker_answer(commits.back().id(), {ErrorCode::ok, ""}, now);
  }
}

Decision Harness::send(const Plan& plan) {
  auto decision = guard.on_plan(plan, now);
  take();
  return decision;
}

void Harness::map(const MapSpec& spec) {
  grid = map_of(spec);
  guard.set_map(grid, now);
  take();
}

void expect_safe(const Harness& h, const CommittedTrajectory& committed, const Config& config) {
  const Trajectory& flown = committed.flown();
  const FlatState end = flown.sample(flown.duration_s());
  EXPECT_LT(end.velocity.norm(), 1e-3);
  EXPECT_LT(end.acceleration.norm(), 1e-3);
  const FreeSpace space(h.grid, config.fly_unknown);
  int blocked = 0;
  double fastest = 0.0, hardest = 0.0;
  constexpr int kSteps = 3000;
  for (int i = 0; i <= kSteps; ++i) {
    const FlatState s = flown.sample(flown.duration_s() * i / kSteps);
    const auto voxel = h.grid->geometry.index_of(s.position);
    blocked += voxel && space.is_free(*voxel) ? 0 : 1;
    fastest = std::max(fastest, s.velocity.norm());
    hardest = std::max(hardest, s.acceleration.norm());
  }
  EXPECT_EQ(blocked, 0);
  EXPECT_LE(fastest, config.v_max_m_s + 1e-6);
  EXPECT_LE(hardest, config.a_max_m_s2 + 1e-6);
}

Plan spline_plan(const std::vector<Vec3>& points, double knot_s,
                 std::optional<std::int64_t> start_ns) {
  Bspline s{.degree = 3};
  // Three equal points at an end are rest there.
  for (int i = 0; i < 2; ++i) s.control_points_map.push_back(points.front());
  s.control_points_map.insert(s.control_points_map.end(), points.begin(), points.end());
  for (int i = 0; i < 2; ++i) s.control_points_map.push_back(points.back());
  for (std::size_t i = 0; i < s.control_points_map.size() + 4; ++i) {
    s.knots_s.push_back(knot_s * (double(i) - 3.0));
  }
  return {.kind = PlanKind::bspline, .start_time_ns = start_ns, .shape = std::move(s)};
}

Plan straight_plan(const Vec3& from, const Vec3& to, double duration_s,
                   std::optional<std::int64_t> start_ns) {
  std::vector<Vec3> points;
  for (int i = 0; i <= 10; ++i) points.push_back(from + i / 10.0 * (to - from));
  return spline_plan(points, duration_s / 12.0, start_ns);
}

Plan path_plan(std::vector<Vec3> points) {
  return {.kind = PlanKind::path, .shape = Waypoints{std::move(points)}};
}

}  // namespace goshawk::guard
