// Worlds of our own: dead ends, and rooms.

#include <algorithm>

#include "goshawk/core/random.hpp"
#include "goshawk/worlds/world.hpp"
#include "scene_parts.hpp"

namespace goshawk::league {
namespace {

// Off the map's raster: walls on the faces of voxels would flicker between two of them.
const Vec3 kOffRaster(0.07, 0.06, 0.05);

}  // namespace

void enclose(Scene& scene, double height_m) {
  constexpr double kThick_m = 0.5;
  const Vec3 lo = scene.box.lower_map, hi = scene.box.upper_map;
  const double x0 = lo.x() + 0.1, x1 = hi.x() - 0.1, y0 = lo.y() + 0.1, y1 = hi.y() - 0.1;
  scene.solids.push_back(box_between({x0 - kThick_m, y0, 0.0}, {x0, y1, height_m}));
  scene.solids.push_back(box_between({x1, y0, 0.0}, {x1 + kThick_m, y1, height_m}));
  scene.solids.push_back(box_between({x0, y0 - kThick_m, 0.0}, {x1, y0, height_m}));
  scene.solids.push_back(box_between({x0, y1, 0.0}, {x1, y1 + kThick_m, height_m}));
  scene.solids.push_back(ground_below(scene.box));
}

std::vector<Solid> to_boxes(const worlds::World& world) {
  BitGrid left = world.occupied;
  const Index3 size = world.geometry.size;
  const auto all_set = [&](Index3 from, Index3 to) {
    for (int z = from.z; z < to.z; ++z) {
      for (int y = from.y; y < to.y; ++y) {
        for (int x = from.x; x < to.x; ++x) {
          if (!left.get({x, y, z})) return false;
        }
      }
    }
    return true;
  };
  std::vector<Solid> boxes;
  for (int z = 0; z < size.z; ++z) {
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x) {
        if (!left.get({x, y, z})) continue;
        Index3 end{x + 1, y + 1, z + 1};
        while (end.x < size.x && left.get({end.x, y, z})) ++end.x;
        while (end.y < size.y && all_set({x, end.y, z}, {end.x, end.y + 1, z + 1})) ++end.y;
        while (end.z < size.z && all_set({x, y, end.z}, {end.x, end.y, end.z + 1})) ++end.z;
        for (int k = z; k < end.z; ++k) {
          for (int j = y; j < end.y; ++j) {
            for (int i = x; i < end.x; ++i) left.set({i, j, k}, false);
          }
        }
        const Vec3 lower = world.geometry.lower_corner({x, y, z}) + kOffRaster;
        const Vec3 upper = world.geometry.lower_corner(end) + kOffRaster;
        boxes.push_back(box_between(lower, upper));
      }
    }
  }
  return boxes;
}

// A hall of 48 x 20 m with four walls across, each with one exit; before each, on the straight way
// to the goal, a pocket of 5 m that is open only to where the vehicle comes from.
Result<Scene> exits(std::uint64_t seed) {
  constexpr double kHeight_m = 4.0, kWall_m = 0.3, kExit_m = 1.6, kPocket_m = 5.0;
  Random random(seed + 1);
  Scene scene;
  scene.name = "exits";
  scene.box = {Vec3(0.0, -10.0, 0.0), Vec3(48.0, 10.0, 3.0)};
  scene.start = Vec3(1.5, 0.0, 1.5);
  scene.goal = Vec3(46.5, random.uniform(-6.0, 6.0), 1.5);
  scene.limits = per_axis(3.0, 6.0, 30.0);
  enclose(scene, kHeight_m);
  for (int k = 0; k < 4; ++k) {
    const double x = 10.53 + 10.0 * k;
    const double side = random.chance(0.5) ? 1.0 : -1.0;
    const double exit = side * random.uniform(4.0, 8.5);
    const auto wall = [&](double x0, double y0, double x1, double y1) {
      scene.solids.push_back(box_between({x0, y0, 0.0}, {x1, y1, kHeight_m}));
    };
    wall(x, -9.9, x + kWall_m, exit - kExit_m / 2.0);
    wall(x, exit + kExit_m / 2.0, x + kWall_m, 9.9);
    const double middle = random.uniform(-0.5, 0.5);
    for (const double arm : {middle - 2.0, middle + 2.0 - kWall_m}) {
      wall(x - kPocket_m, arm, x, arm + kWall_m);
    }
  }
  return scene;
}

Result<Scene> office(std::uint64_t seed) {
  worlds::WorldSpec spec;
  spec.kind = "office";
  spec.size_m = Vec3(24.0, 12.0, 2.8);
  spec.origin_m = Vec3(0.0, 0.0, 0.0);
  spec.density = 0.2;
  spec.seed = seed + 1;
  spec.inflation_m = 0.3;
  Scene scene;
  scene.name = "office";
  scene.start = Vec3(1.1, 1.1, 1.3);
  scene.goal = Vec3(22.9, 10.9, 1.3);
  spec.keep_free = {scene.start, scene.goal};
  const auto world = worlds::make_world(spec);
  if (!world) return world.error();
  scene.box = {Vec3(-0.2, -0.2, 0.0), Vec3(24.4, 12.4, 2.6)};
  scene.limits = per_axis(2.0, 4.0, 20.0);
  enclose(scene, 3.0);
  for (const Solid& box : to_boxes(*world)) scene.solids.push_back(box);
  return scene;
}

}  // namespace goshawk::league
