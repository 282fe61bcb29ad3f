#include "corridor/scenes.hpp"

#include <utility>

#include "goshawk/core/inflation.hpp"
#include "goshawk/core/random.hpp"
#include "goshawk/path_search/path_search.hpp"
#include "goshawk/worlds/world.hpp"

namespace goshawk::bench {
namespace {

constexpr double kRadius_m = 0.2;
constexpr double kResolution_m = 0.2;

Vec3 random_centre(const GridGeometry& g, Random& random) {
  const int x = random.below(g.size.x), y = random.below(g.size.y);
  return g.center({x, y, random.below(g.size.z)});
}

void find_paths(int count, std::uint64_t seed, Scene& scene) {
  auto search = std::move(path_search::PathSearch::create({})).value();
  search.set_map(scene.grid);
  const GridGeometry& g = scene.grid->geometry;
  const double far_m = 0.3 * (g.upper_corner_map() - g.origin_map).norm();
  Random random(seed);
  for (int tries = 0; tries < 40 * count && int(scene.paths_map.size()) < count; ++tries) {
    const Vec3 start = random_centre(g, random), goal = random_centre(g, random);
    if ((goal - start).norm() < far_m) continue;
    auto path = search.plan(start, goal);
    if (path.ok() && path->waypoints_map.size() >= 3) {
      scene.paths_map.push_back(std::move(path->waypoints_map));
    }
  }
}

std::shared_ptr<VoxelGrid> grown_from(const GridGeometry& geometry, const BitGrid& raw) {
  auto grid = std::make_shared<VoxelGrid>();
  grid->geometry = geometry;
  grid->grown = inflate(raw, kRadius_m, kResolution_m).value();
  grid->raw = raw;
  grid->inflation_m = kRadius_m;
  return grid;
}

}  // namespace

std::vector<Scene> make_scenes(const std::string& kind, const Vec3& size_m, double density,
                               int worlds, int paths) {
  std::vector<Scene> scenes;
  for (std::uint64_t seed = 1; int(scenes.size()) < worlds && seed < 4U * unsigned(worlds);
       ++seed) {
    worlds::WorldSpec spec;
    spec.kind = kind;
    spec.size_m = size_m;
    spec.density = density;
    spec.seed = seed;
    const auto world = worlds::make_world(spec);
    if (!world.ok()) continue;
    Scene scene{grown_from(world->geometry, world->occupied), {}};
    find_paths(paths, seed, scene);
    if (!scene.paths_map.empty()) scenes.push_back(std::move(scene));
  }
  return scenes;
}

Scene room_in_a_map(double side_m) {
  const auto small = make_scenes("boxes", Vec3(8, 8, 4), 0.3, 1, 1);
  const Index3 room = small[0].grid->raw.size();
  const int n = int(side_m / kResolution_m);
  GridGeometry geometry = small[0].grid->geometry;
  geometry.size = {n, n, room.z};
  Scene scene{{}, small[0].paths_map};
  auto grid = std::make_shared<VoxelGrid>();
  grid->geometry = geometry;
  grid->grown = BitGrid(geometry.size, true);
  grid->raw = BitGrid(geometry.size, true);
  for (int z = 0; z < room.z; ++z) {
    for (int y = 0; y < room.y; ++y) {
      for (int x = 0; x < room.x; ++x) {
        grid->raw.set({x, y, z}, small[0].grid->raw.get({x, y, z}));
        grid->grown.set({x, y, z}, small[0].grid->grown.get({x, y, z}));
      }
    }
  }
  scene.grid = std::move(grid);
  return scene;
}

}  // namespace goshawk::bench
