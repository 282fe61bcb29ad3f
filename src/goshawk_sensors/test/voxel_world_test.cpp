#include "goshawk/sensors/voxel_world.hpp"

#include <gtest/gtest.h>

#include "goshawk/worlds/world.hpp"
#include "support.hpp"

namespace goshawk::sensors {
namespace {

// Slabs of every occupied cube, one after another.
Hit brute_force(const GridGeometry& g, const BitGrid& grid, const Ray& ray) {
  Hit best;
  for (int z = 0; z < g.size.z; ++z) {
    for (int y = 0; y < g.size.y; ++y) {
      for (int x = 0; x < g.size.x; ++x) {
        if (!grid.get({x, y, z})) continue;
        double in = -1e300, out = 1e300;
        int axis = 0;
        for (int a = 0; a < 3; ++a) {
          const double lower = g.lower_corner({x, y, z})[a] - ray.origin[a];
          const double s = lower / ray.direction[a];
          const double t = (lower + g.resolution_m) / ray.direction[a];
          if (std::min(s, t) > in) in = std::min(s, t), axis = a;
          out = std::min(out, std::max(s, t));
        }
        if (in > out || out < 0.0) continue;
        const double range_m = std::max(in, 0.0);
        if (range_m > ray.range_m || range_m >= best.range_m) continue;
        best = {range_m, in < 0.0 ? 1.0 : std::abs(ray.direction[axis])};
      }
    }
  }
  return best;
}

struct Case {
  Index3 size;
  double share;
};

class VoxelRays : public testing::TestWithParam<Case> {};

TEST_P(VoxelRays, MeetWhatSlabTestsOfEveryVoxelSay) {
  Random random(7);
  const GridGeometry g{Vec3(-3.1, 2.7, 0.4), 0.2, GetParam().size};
  const BitGrid grid = random_voxels(g.size, GetParam().share, random);
  const VoxelWorld world(g, grid, Boundary::open);
  const Vec3 margin = Vec3::Constant(1.0);  // some begin outside
  int met = 0;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 origin = random_point(random, g.origin_map - margin, g.upper_corner_map() + margin);
    const Ray ray{origin, random_direction(random), random.uniform(0.5, 12.0)};
    const Hit hit = cast_one(world, ray), truth = brute_force(g, grid, ray);
    ASSERT_EQ(hit.any(), truth.any()) << "ray " << i << " from " << to_text(origin);
    if (!hit.any()) continue;
    ++met;
    EXPECT_NEAR(hit.range_m, truth.range_m, 1e-9) << "ray " << i;
    EXPECT_NEAR(hit.cosine, truth.cosine, 1e-9) << "ray " << i;
    EXPECT_EQ(world.contains(origin), truth.range_m == 0.0);
  }
  EXPECT_GT(met, 10);
}

INSTANTIATE_TEST_SUITE_P(Worlds, VoxelRays,
                         testing::Values(Case{{30, 25, 18}, 0.001}, Case{{30, 25, 18}, 0.02},
                                         Case{{33, 5, 70}, 0.2}, Case{{67, 3, 9}, 0.01}));

TEST(VoxelWorld, RaysAlongTheAxesRunThroughTheRowsOfVoxels) {
  const GridGeometry g{Vec3::Zero(), 0.5, {40, 40, 40}};
  BitGrid grid(g.size, false);
  grid.set({30, 10, 20}, true);
  const VoxelWorld world(g, grid, Boundary::open);
  const Vec3 middle = g.center({30, 10, 20});
  for (int a = 0; a < 3; ++a) {
    for (const double sign : {-1.0, 1.0}) {
      const Vec3 along = sign * Vec3::Unit(a);
      const Hit hit = cast_one(world, {middle - 4.0 * along, along, 10.0});
      EXPECT_NEAR(hit.range_m, 3.75, 1e-12);
      EXPECT_EQ(hit.cosine, 1.0);
      EXPECT_FALSE(cast_one(world, {middle - 4.0 * along, -along, 100.0}).any());
      EXPECT_FALSE(cast_one(world, {middle - 4.0 * along, along, 3.7}).any()) << "out of range";
    }
  }
}

TEST(VoxelWorld, TheBoundaryIsOpenAFloorOrABox) {
  const GridGeometry g{Vec3(1.0, 2.0, 3.0), 0.1, {10, 20, 30}};
  const BitGrid none(g.size, true);
  const Vec3 p(1.5, 3.0, 4.5);
  const Ray down{p, -Vec3::UnitZ(), 10.0}, aside{p, Vec3::UnitX(), 10.0},
      up{p, Vec3::UnitZ(), 10.0};
  const VoxelWorld open(g, none, Boundary::open), floor(g, none, Boundary::floor),
      box(g, none, Boundary::box);
  for (const Ray& ray : {down, aside, up}) EXPECT_FALSE(cast_one(open, ray).any());
  EXPECT_NEAR(cast_one(floor, down).range_m, 1.5, 1e-12);
  EXPECT_FALSE(cast_one(floor, aside).any());
  EXPECT_FALSE(cast_one(floor, up).any());
  EXPECT_NEAR(cast_one(box, down).range_m, 1.5, 1e-12);
  EXPECT_NEAR(cast_one(box, aside).range_m, 0.5, 1e-12);
  EXPECT_NEAR(cast_one(box, up).range_m, 1.5, 1e-12);
  const Vec3 beside(9.0, 3.0, 4.5), below(9.0, 3.0, 2.9);
  EXPECT_NEAR(cast_one(floor, {beside, -Vec3::UnitZ(), 10.0}).range_m, 1.5, 1e-12) << "no end";
  EXPECT_FALSE(open.contains(below));
  EXPECT_FALSE(floor.contains(beside));
  EXPECT_TRUE(floor.contains(below));
  EXPECT_TRUE(box.contains(beside));
  EXPECT_FALSE(box.contains(p));
}

TEST(VoxelWorld, AnEmptyWorldLargerThanTheDistancesReachIsCrossed) {
  const GridGeometry g{Vec3::Zero(), 0.1, {4 * 700, 8, 8}};
  BitGrid grid(g.size, false);
  grid.set({4 * 700 - 1, 4, 4}, true);
  const VoxelWorld world(g, grid, Boundary::open);
  const Hit hit = cast_one(world, {Vec3(0.05, 0.45, 0.45), Vec3::UnitX(), 1000.0});
  EXPECT_NEAR(hit.range_m, 279.9 - 0.05, 1e-9);
}

TEST(VoxelWorld, AMadeWorldIsSeenAsItsVoxelsSay) {
  const auto made = worlds::make_world(worlds::default_world());
  ASSERT_TRUE(made) << made.error().message;
  const VoxelWorld world(made->geometry, made->occupied, Boundary::open);
  Random random(3);
  for (int i = 0; i < 300; ++i) {
    const Vec3 origin =
        random_point(random, made->geometry.origin_map, made->geometry.upper_corner_map());
    const Ray ray{origin, random_direction(random), 20.0};
    const Hit hit = cast_one(world, ray), truth = brute_force(made->geometry, made->occupied, ray);
    ASSERT_EQ(hit.any(), truth.any());
    if (hit.any()) {
      EXPECT_NEAR(hit.range_m, truth.range_m, 1e-9);
    }
  }
}

TEST(VoxelWorld, ASizeThatDisagreesIsABug) {
  const GridGeometry g{Vec3::Zero(), 0.1, {10, 10, 10}};
  EXPECT_THROW(VoxelWorld(g, BitGrid({9, 10, 10}, false), Boundary::open), std::invalid_argument);
}

}  // namespace
}  // namespace goshawk::sensors
