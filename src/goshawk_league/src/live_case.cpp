#include "goshawk/league/live_case.hpp"

#include <array>
#include <numbers>

#include "goshawk/core/random.hpp"
#include "goshawk/path_search/path_search.hpp"
#include "scene_parts.hpp"

namespace goshawk::league {
namespace {

constexpr double kVoxel_m = 0.2;
constexpr double kHeight_m = 3.0;

template <typename T, std::size_t n>
const T& one_of(Random& random, const std::array<T, n>& all) {
  return all[std::size_t(random.below(int(n)))];
}

Limits draw_limits(Random& random) {
  struct Pace {
    double v_m_s, a_m_s2;
  };
  const auto pace = one_of(random, std::array<Pace, 4>{{{1, 2}, {2, 4}, {3, 6}, {5, 10}}});
  return {.v_max_m_s = pace.v_m_s, .a_max_m_s2 = pace.a_m_s2, .j_max_m_s3 = 30.0};
}

void draw_sensor(Random& random, LiveCase& live) {
  live.options.range_m = one_of(random, std::array{8.0, 15.0, 30.0});
  live.options.range_noise_m = one_of(random, std::array{0.0, 0.01, 0.02});
  if (random.chance(0.7)) return;
  live.options.view_rad = std::numbers::pi / 2.0;
  live.options.vehicle.planning.optimizer.yaw = trajectory_optimizer::YawMode::along_motion;
}

}  // namespace

Result<LiveCase> make_live_case(std::uint64_t number, const closed_loop::Setup& vehicle) {
  Random random(number + 1);
  LiveCase live{.number = number, .options = {.vehicle = vehicle, .seed = number}};
  worlds::WorldSpec spec;
  spec.kind = live.kind = one_of(random, std::array<std::string, 3>{"boxes", "forest", "office"});
  spec.density = live.density =
      live.kind == "office" ? 0.2 : one_of(random, std::array{0.05, 0.1, 0.2, 0.3});
  spec.size_m = Vec3(16.0 + 2.0 * random.below(8), 10.0 + 2.0 * random.below(4), kHeight_m);
  spec.seed = number + 1;
  spec.inflation_m = plan_clearance_m();
  Scene& scene = live.scene;
  scene.name = live.kind;
  scene.start = Vec3(1.1, 1.5, 1.3);
  scene.goal = Vec3(spec.size_m.x() - 1.1, spec.size_m.y() - 1.5, random.uniform(1.1, 1.9));
  spec.keep_free = {scene.start, scene.goal};
  const auto world = worlds::make_world(spec);
  if (!world) return world.error();
  const Vec3 edge = Vec3::Constant(kVoxel_m);
  scene.box = {-edge, spec.size_m + 2.0 * edge};
  scene.box.lower_map.z() = 0.0;
  scene.box.upper_map.z() = kHeight_m - kVoxel_m;
  scene.limits = draw_limits(random);
  scene.longest_s = 120.0;
  enclose(scene, kHeight_m);
  for (const Solid& box : to_boxes(*world)) scene.solids.push_back(box);
  draw_sensor(random, live);
  return live;
}

Result<bool> can_be_reached(const Scene& scene) {
  const auto map = known_map(scene, kVoxel_m, plan_clearance_m());
  if (!map) return map.error();
  auto search = path_search::PathSearch::create({});
  if (!search) return search.error();
  search->set_map(*map);
  return bool(search->plan(scene.start, scene.goal));
}

}  // namespace goshawk::league
