// Time a segment, and what it buys: median volume, faces, largest inscribed ball, and how many
// polytopes cut into an obstacle (by the tests' independent checker, outside the timing).
//
// The path is a pruned voxel path; each of its segments is wrapped on its own.

#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <map>
#include <string>

#include "ellipsoid_decomposition.hpp"
#include "goshawk/corridor_builder/corridor_builder.hpp"
#include "support/corridor_checker.hpp"
#include "support/paths.hpp"
#include "support/worlds.hpp"

namespace goshawk::corridor_builder {
namespace {

struct Scene {
  VoxelGrid grid;
  std::vector<std::vector<Vec3>> segments;
};

enum World { kBoxes, kForest };

VoxelGrid make_world(World world, std::uint64_t seed) {
  return world == kBoxes ? test_support::boxes_and_pillars({30, 40, 20}, 0.2, 0.4, 0.2, seed)
                         : test_support::forest({150, 150, 25}, 0.2, 60, 0.2, seed);
}

const std::vector<Scene>& scenes(World world) {
  static std::map<World, std::vector<Scene>> all;
  std::vector<Scene>& list = all[world];
  for (std::uint64_t seed = 1; list.size() < 6; ++seed) {
    Scene scene{make_world(world, seed), {}};
    for (std::uint64_t k = 0; k < 12; ++k) {
      const auto path = test_support::random_pruned_path(scene.grid, 100 * seed + k);
      for (std::size_t i = 0; i + 1 < path.size(); ++i) {
        scene.segments.push_back({path[i], path[i + 1]});
      }
    }
    list.push_back(std::move(scene));
  }
  return list;
}

double quantile(std::vector<double> values, double q) {
  if (values.empty()) return 0.0;
  const auto at = values.begin() + std::ptrdiff_t(q * double(values.size() - 1));
  std::nth_element(values.begin(), at, values.end());
  return *at;
}

struct Quality {
  std::vector<double> volume_m3, faces, radius_m;
  int segments = 0;
  int cutting = 0;  // corridors with a polytope that cuts into an obstacle
  int lost = 0;     // corridors that do not hold their segment

  void add(const Corridor& corridor, const Scene& scene, const std::vector<Vec3>& segment) {
    for (const Polytope& polytope : corridor.polytopes) {
      volume_m3.push_back(test_support::volume_of(polytope));
      faces.push_back(polytope.faces());
      radius_m.push_back(chebyshev_ball(polytope).radius_m);
    }
    const std::string faults = test_support::faults_of(corridor, scene.grid, segment);
    cutting += faults.find("cuts into") != std::string::npos;
    lost += corridor.polytopes.front().violation(segment[0]) > 1e-9 ||
            corridor.polytopes.back().violation(segment[1]) > 1e-9;
    ++segments;
  }

  void report(benchmark::State& state, const std::vector<double>& us) const {
    state.counters["segments"] = segments;
    state.counters["median_us"] = quantile(us, 0.5);
    state.counters["p90_us"] = quantile(us, 0.9);
    state.counters["volume_m3"] = quantile(volume_m3, 0.5);
    state.counters["faces"] = quantile(faces, 0.5);
    state.counters["radius_m"] = quantile(radius_m, 0.5);
    state.counters["cutting"] = cutting;
    state.counters["lost"] = lost;
  }
};

template <typename Build>  // Corridor Build(const VoxelGrid&, segment)
void run(benchmark::State& state, World world, const Build& build) {
  scenes(world);  // made once, outside the timing
  std::vector<double> us;
  for (auto _ : state) {
    for (const Scene& scene : scenes(world)) {
      for (const auto& segment : scene.segments) {
        const auto before = std::chrono::steady_clock::now();
        benchmark::DoNotOptimize(build(scene.grid, segment));
        const auto after = std::chrono::steady_clock::now();
        us.push_back(std::chrono::duration<double, std::micro>(after - before).count());
      }
    }
  }
  Quality quality;
  for (const Scene& scene : scenes(world)) {
    for (const auto& segment : scene.segments) {
      quality.add(build(scene.grid, segment), scene, segment);
    }
  }
  quality.report(state, us);
}

void ours(benchmark::State& state, World world, const Config& config) {
  auto builder = std::move(CorridorBuilder::create(config)).value();
  run(state, world, [&](const VoxelGrid& grid, const std::vector<Vec3>& segment) {
    return std::move(builder.build(grid, segment)).value();
  });
}

void voxel_centres(benchmark::State& state, World world, baseline::Planes planes) {
  run(state, world, [&](const VoxelGrid& grid, const std::vector<Vec3>& segment) {
    return Corridor{
        segment,
        {baseline::decompose(grid, segment[0], segment[1], Config{}.local_box_m, planes)},
        {}};
  });
}

// The same room in maps of 10 m to 1 km: the cost must not grow.
void map_size(benchmark::State& state) {
  const int n = int(state.range(0)) * 5;
  VoxelGrid grid = test_support::empty_world({n, n, 20}, 0.2);
  const VoxelGrid room = test_support::boxes_and_pillars({40, 40, 20}, 0.2, 0.3, 0.2, 1);
  for (int z = 0; z < 20; ++z) {
    for (int y = 0; y < 40; ++y) {
      for (int x = 0; x < 40; ++x) grid.occupied.set({x, y, z}, room.occupied.get({x, y, z}));
    }
  }
  std::vector<Vec3> path;
  for (std::uint64_t seed = 1; path.size() < 4; ++seed) {
    path = test_support::random_pruned_path(room, seed);
  }
  auto builder = std::move(CorridorBuilder::create(Config{})).value();
  for (auto _ : state) benchmark::DoNotOptimize(builder.build(grid, path));
}

const Config kWhole{.max_segment_m = 1000.0};

BENCHMARK_CAPTURE(ours, boxes_ellipsoid, kBoxes, kWhole)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ours, boxes_ellipsoid_no_growth, kBoxes,
                  Config{.max_segment_m = 1000.0, .growth_passes = 0})
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ours, boxes_box, kBoxes, Config{.generator = "box"})
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(voxel_centres, boxes, kBoxes, baseline::Planes::through_centres)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ours, forest_ellipsoid, kForest, kWhole)->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(ours, forest_ellipsoid_no_growth, kForest,
                  Config{.max_segment_m = 1000.0, .growth_passes = 0})
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(voxel_centres, boxes_cleared, kBoxes, baseline::Planes::before_cubes)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(voxel_centres, forest, kForest, baseline::Planes::through_centres)
    ->Unit(benchmark::kMillisecond);
BENCHMARK_CAPTURE(voxel_centres, forest_cleared, kForest, baseline::Planes::before_cubes)
    ->Unit(benchmark::kMillisecond);
BENCHMARK(map_size)->Arg(10)->Arg(100)->Arg(1000)->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace goshawk::corridor_builder

BENCHMARK_MAIN();
