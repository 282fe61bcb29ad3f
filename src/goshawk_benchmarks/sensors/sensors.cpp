// goshawk bench sensors: what it costs to simulate each sensor in a few worlds.
#include <algorithm>
#include <memory>
#include <stdexcept>

#include "common/measure.hpp"
#include "common/report.hpp"
#include "goshawk/core/random.hpp"
#include "goshawk/sensors/sensor.hpp"
#include "goshawk/sensors/solid_world.hpp"
#include "goshawk/sensors/voxel_world.hpp"
#include "goshawk/worlds/world.hpp"

namespace goshawk::bench {
namespace {

using namespace goshawk::sensors;

constexpr std::int64_t kPose_ns = 4'000'000;  // between poses: odometry at 250 Hz

struct Scene {
  std::string name;
  std::unique_ptr<World> world;
  Vec3 place_map;  // free
};

Scene voxel_scene(const std::string& name, const worlds::WorldSpec& spec, Boundary boundary) {
  const auto made = worlds::make_world(spec);
  if (!made) throw std::runtime_error(made.error().message);
  return {name, std::make_unique<VoxelWorld>(made->geometry, made->occupied, boundary),
          spec.keep_free.front()};
}

Scene forest(bool quick) {
  worlds::WorldSpec spec;
  spec.kind = "forest";
  spec.size_m = quick ? Vec3(50.0, 40.0, 6.0) : Vec3(100.0, 40.0, 6.0);
  spec.density = 0.15;
  spec.keep_free = {Vec3(25.0, 20.0, 2.0)};
  return voxel_scene("forest, voxels of 0.2 m", spec, Boundary::floor);
}

Scene office() {
  worlds::WorldSpec spec;
  spec.kind = "office";
  spec.size_m = Vec3(30.0, 20.0, 3.0);
  spec.resolution_m = 0.1;
  spec.density = 0.2;
  spec.keep_free = {Vec3(15.0, 10.0, 1.5)};
  return voxel_scene("office, voxels of 0.1 m", spec, Boundary::box);
}

/// 600 trunks on 100 x 40 m.
Scene cylinders() {
  Random random(1);
  std::vector<Solid> solids{Solid::box(Vec3(-10.0, -30.0, -0.1), Vec3(110.0, 30.0, 0.0))};
  while (solids.size() < 601) {
    const double x = random.uniform(0.0, 100.0), y = random.uniform(-20.0, 20.0);
    const double radius_m = random.uniform(0.2, 1.0);
    if (std::hypot(x - 50.0, y) < radius_m + 1.0) continue;
    solids.push_back(Solid::cylinder(Vec3(x, y, 0.0), radius_m, 6.0));
  }
  auto world = SolidWorld::create(std::move(solids));
  if (!world) throw std::runtime_error(world.error().message);
  return {"600 cylinders", std::make_unique<SolidWorld>(*std::move(world)), Vec3(50.0, 0.0, 2.0)};
}

std::vector<Scene> scenes_of(bool quick) {
  std::vector<Scene> scenes;
  scenes.push_back(voxel_scene("boxes, voxels of 0.2 m", worlds::default_world(), Boundary::box));
  scenes.push_back(forest(quick));
  scenes.push_back(office());
  scenes.push_back(cylinders());
  return scenes;
}

/// A vehicle that turns on the spot and sways.
Pose pose_at(const Scene& scene, double t) {
  return {scene.place_map + 0.05 * Vec3(std::sin(2.0 * t), std::cos(3.0 * t), std::sin(t)),
          Quaternion(Eigen::AngleAxisd(0.5 * t, Vec3::UnitZ()))};
}

/// Simulates time_s seconds. @return [us] of processor time, one a scan
std::vector<double> simulate(const SensorParameters& parameters, const Scene& scene, double time_s,
                             std::int64_t& returns) {
  auto sensor = Sensor::create(parameters);
  if (!sensor) throw std::runtime_error(sensor.error().message);
  PoseTrack track;
  std::vector<double> us(1, 0.0);
  const auto steps = std::int64_t(1e9 * time_s) / kPose_ns;
  for (std::int64_t i = 0; i <= steps; ++i) {
    const std::int64_t stamp_ns = 1'000'000'000 + i * kPose_ns;
    if (!track.add(stamp_ns, pose_at(scene, 1e-9 * double(i * kPose_ns)))) continue;
    bool complete = false;
    us.back() += time_us(
        [&] {
          const auto status = sensor->advance(*scene.world, track, [&](const Scan& scan) {
            complete = true;
            for (const Return& r : scan.returns) returns += r.valid ? 1 : 0;
          });
          if (!status) throw std::runtime_error(status.error().message);
        },
        Clock::processor);
    if (complete) us.push_back(0.0);
  }
  us.pop_back();
  return us;
}

void measure(Report& report, Preset preset, const Scene& scene, double time_s) {
  SensorParameters parameters;
  apply_preset(preset, parameters);
  const std::string name(to_word(preset));
  report.progress(name + " in " + scene.name);
  std::int64_t returns = 0;
  std::vector<double> us = simulate(parameters, scene, time_s, returns);
  if (us.empty()) throw std::runtime_error("no scan was complete");
  double total_us = 0.0;
  for (const double each : us) total_us += each;
  std::ranges::sort(us);
  const double rays = double(FiringPattern(parameters.pattern).firings());
  const double rate = rays * parameters.pattern.rate_hz;
  const double per_ray_us = total_us / (rays * double(us.size()));
  report.add({{"table", "sensors"},
              {"preset", name},
              {"world", scene.name},
              {"rays_a_second", rate},
              {"returns_share", double(returns) / (rays * double(us.size()))},
              {"ns_a_ray", 1e3 * per_ray_us},
              {"scan_median_us", at_share(us, 0.5)},
              {"scan_p99_us", at_share(us, 0.99)},
              {"points_a_second_a_core", 1e6 / per_ray_us},
              {"core_share", 1e-6 * per_ray_us * rate},
              {"core_share_200000", 1e-6 * per_ray_us * 2e5}});
}

void run(Report& report) {
  const bool quick = report.options().quick;
  for (const Scene& scene : scenes_of(quick)) {
    for (const auto& named : words_of(Preset{})) {
      measure(report, named.value, scene, quick ? 0.5 : 2.0);
    }
  }
}

}  // namespace
}  // namespace goshawk::bench

int main(int argc, char** argv) {
  return goshawk::bench::bench_main(argc, argv, "sensors", goshawk::bench::run);
}
