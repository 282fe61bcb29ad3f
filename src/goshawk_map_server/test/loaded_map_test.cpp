// A map that is given to a live map, and what is kept beside a window that follows.
#include <gtest/gtest.h>

#include <cmath>

#include "goshawk/core/random.hpp"
#include "goshawk/map_server/live_map.hpp"
#include "goshawk/map_server/map_tools.hpp"

namespace goshawk::map_server {
namespace {

constexpr double kVoxel_m = 0.2;
const Box kBox{Vec3(-6.4, -4, -1.6), Vec3(6.4, 4, 1.6)};

// A map of random voxels. Most are free, so that some stay free when it grows.
RawVoxels random_map(Random& random, const Box& box, double resolution_m = kVoxel_m) {
  const GridGeometry geometry = raster_of(box, resolution_m, 1'000'000).value();
  RawVoxels map{geometry, BitGrid(geometry.size, true), BitGrid(geometry.size, false)};
  for (int z = 0; z < geometry.size.z; ++z) {
    for (int y = 0; y < geometry.size.y; ++y) {
      for (int x = 0; x < geometry.size.x; ++x) {
        if (random.chance(0.02)) continue;
        map.known.set({x, y, z}, true);
        map.occupied.set({x, y, z}, random.chance(0.01));
      }
    }
  }
  return map;
}

ScanResult see(LiveMap& map, const std::vector<Vec3>& points, const Vec3& from) {
  ScanResult result;
  const Scan scan{.points_map = points,
                  .origins_map = {&from, 1},
                  .max_range_m = 5.0,
                  .body_path_map = {&from, 1}};
  EXPECT_TRUE(map.insert_scan(scan, result));
  return result;
}

std::vector<Vec3> random_points(Random& random, const Vec3& from) {
  std::vector<Vec3> points;
  for (int k = 0; k < 50; ++k) {
    points.push_back(from +
                     Vec3(random.uniform(-4, 4), random.uniform(-4, 4), random.uniform(-1, 1)));
  }
  return points;
}

RawVoxels raw_of(const LiveMap& map) {
  const VoxelGrid grid = map.grid();
  return {grid.geometry, grid.raw, grid.known};
}

LiveMap unknown_space(UnknownPolicy unknown, bool follows = false) {
  LiveOptions options;
  options.follows = follows;
  return LiveMap::unknown_space(kBox, kVoxel_m, {unknown, 0.3}, options).value();
}

TEST(LoadedMap, TakesThePlaceOfWhatWasKnownThereAndTheRestStays) {
  Random random(1);
  for (const auto unknown :
       {UnknownPolicy::occupied, UnknownPolicy::blocked, UnknownPolicy::free}) {
    LiveMap map = unknown_space(unknown);
    const Vec3 from(0.1, 0.1, 0.1);
    for (int k = 0; k < 3; ++k) see(map, random_points(random, from), from);
    VoxelGrid subscriber = map.grid();
    // Smaller than the window, not on whole bricks, and partly beyond it.
    const RawVoxels given = random_map(random, {Vec3(-2.2, -1.4, -1), Vec3(9, 3, 1.2)});
    const std::vector<RawVoxels> maps{raw_of(map), given};
    const RawVoxels expected = merge(maps, MergeRule::later, 1'000'000).value();
    GridUpdate update;
    ASSERT_TRUE(map.insert_map(given, update));
    EXPECT_EQ(update.to_version, subscriber.version + 1);
    ASSERT_TRUE(apply(subscriber, update));
    const VoxelGrid grid = map.grid();
    EXPECT_EQ(subscriber.grown, grid.grown);
    EXPECT_EQ(subscriber.known, grid.known);
    EXPECT_EQ(subscriber.raw, grid.raw);
    const Vec3 steps = (grid.geometry.origin_map - expected.geometry.origin_map) / kVoxel_m;
    const Index3 at{int(std::lround(steps.x())), int(std::lround(steps.y())),
                    int(std::lround(steps.z()))};
    EXPECT_EQ(grid.raw, expected.occupied.window(at, grid.geometry.size));
    EXPECT_EQ(grid.known, expected.known.window(at, grid.geometry.size));
    const VoxelGrid rebuilt = make_voxel_grid(raw_of(map), map.growth(), 1).value();
    EXPECT_EQ(grid.grown, rebuilt.grown);
  }
}

// One voxel at (1.1, 0.1, 0.1), free or an obstacle.
RawVoxels one_voxel(bool occupied) {
  const GridGeometry geometry =
      raster_of({Vec3(1.0, 0.0, 0.0), Vec3(1.2, 0.2, 0.2)}, kVoxel_m, 1000).value();
  RawVoxels map{geometry, BitGrid(geometry.size, true), BitGrid(geometry.size, false, true)};
  map.occupied.set({0, 0, 0}, occupied);
  return map;
}

TEST(LoadedMap, IsAsSureAsAFile) {
  const Vec3 from(-2.1, 0.1, 0.1), there(1.1, 0.1, 0.1), behind(3.1, 0.1, 0.1);
  LiveMap map = unknown_space(UnknownPolicy::free);
  const auto occupied = [&] {
    const VoxelGrid grid = map.grid();
    return grid.raw.get(*grid.geometry.index_of(there));
  };
  GridUpdate update;
  for (int k = 0; k < 10; ++k) see(map, {there}, from);
  ASSERT_TRUE(map.insert_map(one_voxel(false), update));
  EXPECT_FALSE(occupied());
  see(map, {there}, from);
  EXPECT_FALSE(occupied()) << "one hit, and two are needed";
  see(map, {there}, from);
  EXPECT_TRUE(occupied());

  for (int k = 0; k < 10; ++k) see(map, {behind}, from);
  ASSERT_TRUE(map.insert_map(one_voxel(true), update));
  for (int k = 0; k < 3; ++k) {
    EXPECT_TRUE(occupied()) << k << " misses, and four are needed";
    see(map, {behind}, from);
  }
  see(map, {behind}, from);
  EXPECT_FALSE(occupied());
}

TEST(LoadedMap, WhatLiesOutsideOfAWindowThatFollowsIsKeptAndComesIn) {
  Random random(2);
  LiveMap map = unknown_space(UnknownPolicy::free, true);
  const RawVoxels given = random_map(random, {Vec3(-3, -3, -1), Vec3(40, 3, 1)});
  GridUpdate update;
  ASSERT_TRUE(map.insert_map(given, update));
  EXPECT_GT(map.bricks_outside().size(), 0U);
  EXPECT_FALSE(difference(given, map.world(10'000'000).value(), 10'000'000).value().any());

  // Fly there, and see nothing: what comes in is the file's.
  VoxelGrid subscriber = map.grid();
  for (double x = 0.1; x < 30.0; x += 0.5) {
    const ScanResult seen = see(map, {}, Vec3(x, 0.1, 0.1));
    ASSERT_TRUE(apply(subscriber, seen.update));
  }
  EXPECT_EQ(subscriber.raw, map.grid().raw);
  const auto index = map.geometry().index_of(Vec3(30.1, 0.1, 0.1));
  ASSERT_TRUE(index);
  const Index3 there = *given.geometry.index_of(Vec3(30.1, 0.1, 0.1));
  EXPECT_EQ(map.grid().known.get(*index), given.known.get(there));
  EXPECT_FALSE(difference(given, map.world(10'000'000).value(), 10'000'000).value().any());

  // Given once more, some of it is in the window and some is kept: nothing changes.
  ASSERT_TRUE(map.insert_map(given, update));
  EXPECT_TRUE(update.bricks.empty());
  EXPECT_FALSE(difference(given, map.world(10'000'000).value(), 10'000'000).value().any());
}

TEST(LoadedMap, TheWorldHoldsTheWindowAndWhatLeftIt) {
  Random random(3);
  LiveMap map = unknown_space(UnknownPolicy::blocked, true);
  std::vector<RawVoxels> seen;
  for (double x = 0.1; x < 40.0; x += 1.0) {
    const Vec3 from(x, 0.1, 0.1);
    see(map, random_points(random, from), from);
    seen.push_back(raw_of(map));
  }
  const RawVoxels expected = merge(seen, MergeRule::later, 10'000'000).value();
  const RawVoxels world = map.world(10'000'000).value();
  EXPECT_GT(map.bricks_outside().size(), 0U);
  EXPECT_FALSE(difference(expected, world, 10'000'000).value().any());
  EXPECT_EQ(map.world(1000).code(), ErrorCode::map_too_large);
}

TEST(LoadedMap, ThatDoesNotFitIsRefusedAndNothingChanges) {
  Random random(4);
  LiveMap map = unknown_space(UnknownPolicy::free);
  const VoxelGrid before = map.grid();
  GridUpdate update;
  const auto expect_refused = [&](const Box& box, double resolution_m, const char* words) {
    const Status status = map.insert_map(random_map(random, box, resolution_m), update);
    EXPECT_EQ(status.code(), ErrorCode::invalid_input);
    EXPECT_NE(status.error().message.find(words), std::string::npos) << status.error().message;
    EXPECT_EQ(map.version(), before.version);
    EXPECT_EQ(map.grid().known, before.known);
  };
  expect_refused({Vec3(0, 0, 0), Vec3(1, 1, 1)}, 0.1, "voxels of 0.1 m");
  expect_refused({Vec3(100, 0, 0), Vec3(101, 1, 1)}, kVoxel_m, "outside of the map server's box");
}

}  // namespace
}  // namespace goshawk::map_server
