// What sensors get wrong, and what becomes of it in the live map.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "goshawk/core/random.hpp"
#include "goshawk/map_server/live_map.hpp"

namespace goshawk::map_server {
namespace {

const Box kRoom{Vec3(-8, -8, -2), Vec3(8, 8, 4)};

class Senses : public ::testing::Test {
 protected:
  static LiveMap make(int hits_needed, int misses_needed, bool follows = false) {
    LiveOptions options;
    options.odds = OddsModel::make(hits_needed, misses_needed).value();
    options.follows = follows;
    return LiveMap::unknown_space(kRoom, 0.2, {UnknownPolicy::blocked, 0.0}, options).value();
  }

  void see(LiveMap& map, const std::vector<Vec3>& points, const Vec3& from,
           double body_radius_m = 0.0) {
    const Scan scan{.points_map = points,
                    .origins_map = {&from, 1},
                    .body_path_map = {&from, 1},
                    .body_radius_m = body_radius_m};
    ASSERT_TRUE(map.insert_scan(scan, result_));
  }

  static bool occupied(const LiveMap& map, const Vec3& p) {
    const VoxelGrid grid = map.grid();
    return grid.raw.get(*grid.geometry.index_of(p));
  }
  static bool known(const LiveMap& map, const Vec3& p) {
    const VoxelGrid grid = map.grid();
    return grid.known.get(*grid.geometry.index_of(p));
  }

  ScanResult result_;
};

const Vec3 kFrom(0.1, 0.1, 0.1), kNear(3.1, 0.1, 0.1), kFar(6.1, 0.1, 0.1);

TEST_F(Senses, ThingsThatLeaveAreGoneAfterAsManyScansAsAreNeeded) {
  for (int misses = 1; misses <= 9; ++misses) {
    LiveMap map = make(2, misses);
    for (int i = 0; i < 50; ++i) see(map, {kNear}, kFrom);
    ASSERT_TRUE(occupied(map, kNear));
    for (int i = 1; i < misses; ++i) {
      see(map, {kFar}, kFrom);
      EXPECT_TRUE(occupied(map, kNear)) << i << " of " << misses;
    }
    see(map, {kFar}, kFrom);
    EXPECT_FALSE(occupied(map, kNear)) << misses;
  }
}

TEST_F(Senses, OutliersBlockOnlyAfterAsManyHitsAsAreNeeded) {
  for (int hits = 1; hits <= 4; ++hits) {
    LiveMap map = make(hits, 4);
    for (int i = 0; i < 50; ++i) see(map, {kFar}, kFrom);
    for (int i = 1; i < hits; ++i) {
      see(map, {kNear}, kFrom);
      EXPECT_FALSE(occupied(map, kNear)) << i << " of " << hits;
    }
    see(map, {kNear}, kFrom);
    EXPECT_TRUE(occupied(map, kNear)) << hits;
  }
}

TEST_F(Senses, WhatWasUnknownBlocksAtTheFirstHit) {
  for (int hits = 1; hits <= 4; ++hits) {
    LiveMap map = make(hits, 4);
    see(map, {kNear}, kFrom);
    EXPECT_TRUE(occupied(map, kNear));
  }
}

TEST_F(Senses, MissingReturnsAreNeitherWallsNorFreeSpace) {
  LiveMap map = make(1, 4);
  const double nan = std::nan("");
  see(map, {kFrom, Vec3(nan, nan, nan), kNear}, kFrom);
  EXPECT_EQ(result_.points_left_out, 2);
  const VoxelGrid grid = map.grid();
  EXPECT_EQ(grid.raw.count(), 1);
  // Along the one ray that came back: nothing else.
  EXPECT_EQ(grid.known.count(), 16);
}

TEST_F(Senses, BeyondTheRangeNothingIsKnown) {
  LiveMap map = make(1, 4);
  const std::vector<Vec3> points{kFar};
  const Scan scan{.points_map = points, .origins_map = {&kFrom, 1}, .max_range_m = 3.0};
  ASSERT_TRUE(map.insert_scan(scan, result_));
  EXPECT_TRUE(known(map, Vec3(2.5, 0.1, 0.1)));
  EXPECT_FALSE(known(map, Vec3(3.5, 0.1, 0.1)));
  EXPECT_EQ(map.grid().raw.count(), 0);
}

TEST_F(Senses, TheBodyIsNoObstacleAndWhereItFlewIsKnown) {
  Random random(4);
  LiveMap map = make(1, 4);
  for (int step = 0; step < 40; ++step) {
    const Vec3 at(-4.0 + 0.2 * step, 0.1, 0.1);
    std::vector<Vec3> points{at + Vec3(3.0, 0.0, 0.0)};
    for (int k = 0; k < 30; ++k) {  // propellers
      const double angle = random.uniform(0.0, 2.0 * std::numbers::pi);
      points.push_back(at + 0.29 * Vec3(std::cos(angle), std::sin(angle), 0.05));
    }
    see(map, points, at, 0.3);
    EXPECT_EQ(result_.points_on_body, 30);
    EXPECT_TRUE(known(map, at + Vec3(0.0, 0.2, 0.0)));
    EXPECT_FALSE(occupied(map, at + Vec3(0.0, 0.2, 0.0)));
  }
  EXPECT_LE(map.grid().raw.count(), 40);
}

// A spinning lidar 1 m above a floor, flown along; rays end at the floor or at a wall far away.
std::vector<Vec3> floor_scan(const Vec3& from, double floor_z, Random& random) {
  std::vector<Vec3> points;
  for (int ring = 0; ring < 24; ++ring) {
    const double down = -0.02 - 0.02 * ring;
    for (int k = 0; k < 720; ++k) {
      const double angle = k * std::numbers::pi / 360.0;
      const Vec3 way(std::cos(angle) * std::cos(down), std::sin(angle) * std::cos(down),
                     std::sin(down));
      double length = (floor_z - from.z()) / way.z();
      const double wall = 7.5 / std::max(std::abs(way.x()), std::abs(way.y()));
      length = std::min(length, wall - random.uniform(0.0, 0.01));
      points.push_back(from + length * way);
    }
  }
  return points;
}

// Which part of a floor that was seen once is gone again after a flight over it?
double eaten_share(LiveMap map, const std::function<void(LiveMap&, int)>& see_step) {
  BitGrid ever = map.grid().raw;
  std::int64_t eaten = 0;
  for (int step = 0; step < 60; ++step) {
    see_step(map, step);
    const VoxelGrid grid = map.grid();
    eaten = 0;
    for (int y = 0; y < grid.geometry.size.y; ++y) {
      for (int x = 0; x < grid.geometry.size.x; ++x) {
        const Index3 voxel{x, y, 5};
        if (grid.raw.get(voxel)) ever.set(voxel, true);
        if (ever.get(voxel) && !grid.raw.get(voxel)) ++eaten;
      }
    }
  }
  return double(eaten) / double(ever.count());
}

// The floor lies in the lower half of its voxels, so that rays pass through them above it.
TEST_F(Senses, KeepingGrazedSurfacesSavesMuchOfAFloor) {
  const auto fly = [&](bool keep) {
    Random random(5);
    LiveOptions options;
    options.odds = OddsModel::make(2, 4).value();
    options.keep_grazed = keep;
    auto map = LiveMap::unknown_space(kRoom, 0.2, {UnknownPolicy::blocked, 0.0}, options).value();
    return eaten_share(std::move(map), [&](LiveMap& m, int step) {
      const Vec3 from(-3.0 + 0.1 * step, 0.3 * std::sin(0.2 * step), 0.1);
      see(m, floor_scan(from, -0.92, random), from);
    });
  };
  const double without = fly(false), with = fly(true);
  RecordProperty("eaten_share", std::to_string(without));
  RecordProperty("eaten_share_kept", std::to_string(with));
  EXPECT_GT(without, 0.2);
  EXPECT_LT(with, 0.6 * without);
}

TEST_F(Senses, AWindowThatFollowsForgetsNothingAndStaysSmall) {
  LiveMap map = make(1, 4, true);
  const auto size = map.geometry().size;
  std::int64_t most_bytes = 0;
  const auto fly = [&](double x) {
    const Vec3 at(x, 0.1, 0.1);
    see(map, {at + Vec3(1.0, 1.4, 0.0), at + Vec3(0.0, -1.4, 0.0)}, at);
    EXPECT_EQ(map.geometry().size, size);
    most_bytes = std::max(most_bytes, map.memory_bytes());
  };
  for (int step = 0; step < 2000; ++step) fly(0.1 + 0.2 * step);  // 400 m
  EXPECT_GT(map.bricks_kept(), 50);
  EXPECT_LT(most_bytes, 10'000'000);
  EXPECT_FALSE(map.geometry().index_of(Vec3(1.1, 1.5, 0.1)));
  for (int step = 2000; step > 0; --step) fly(0.1 + 0.2 * step);
  EXPECT_TRUE(occupied(map, Vec3(2.1, 1.5, 0.1)));
  EXPECT_TRUE(occupied(map, Vec3(1.1, -1.3, 0.1)));
  EXPECT_TRUE(known(map, Vec3(1.1, -0.5, 0.1)));
  EXPECT_EQ(map.bricks_forgotten(), 0);
}

TEST_F(Senses, AWindowWithLittleMemoryForgetsWhatLeftFirstAndTellsHowMuch) {
  LiveOptions options;
  options.follows = true;
  options.max_kept_bytes = 1'000;
  LiveMap map = LiveMap::unknown_space(kRoom, 0.2, {UnknownPolicy::free, 0.0}, options).value();
  const auto fly = [&](int step) {
    const Vec3 at(0.1 + 0.2 * step, 0.1, 0.1);
    see(map, {at + Vec3(1.0, 1.4, 0.0)}, at);
  };
  fly(0);
  EXPECT_TRUE(occupied(map, Vec3(1.1, 1.5, 0.1)));
  for (int step = 1; step < 1000; ++step) fly(step);
  EXPECT_GT(map.bricks_forgotten(), 0);
  EXPECT_GT(map.bricks_kept(), 0);
  for (int step = 1000; step > 20; --step) fly(step);  // the place is in the window again
  ASSERT_TRUE(map.geometry().index_of(Vec3(1.1, 1.5, 0.1)));
  EXPECT_FALSE(known(map, Vec3(1.1, 1.5, 0.1)));
}

// Voxel by voxel, a body of this size would take for ever.
TEST_F(Senses, ABodyThatIsLargerThanTheMapClearsTheMapAndNoMore) {
  LiveMap map = make(1, 4);
  see(map, {kNear}, kFrom);
  see(map, {}, kFrom, 1e9);
  const VoxelGrid grid = map.grid();
  EXPECT_EQ(grid.known.count(), grid.known.voxels());
  EXPECT_EQ(grid.raw.count(), 0);
}

TEST_F(Senses, UpdatesOfAWindowThatFollowsKeepASubscriberInStep) {
  Random random(6);
  for (const auto policy : {UnknownPolicy::occupied, UnknownPolicy::blocked, UnknownPolicy::free}) {
    LiveOptions options;
    options.follows = true;
    LiveMap map = LiveMap::unknown_space(kRoom, 0.2, {policy, 0.5}, options).value();
    VoxelGrid subscriber = map.grid();
    Vec3 at(0.1, 0.1, 0.1);
    for (int step = 0; step < 60; ++step) {
      at += Vec3(random.uniform(-4, 5), random.uniform(-1, 1), random.uniform(-0.5, 0.5));
      std::vector<Vec3> points;
      for (int k = 0; k < 40; ++k) {
        points.push_back(at +
                         Vec3(random.uniform(-6, 6), random.uniform(-6, 6), random.uniform(-1, 1)));
      }
      see(map, points, at);
      ASSERT_TRUE(apply(subscriber, result_.update));
      const VoxelGrid grid = map.grid();
      EXPECT_LT((subscriber.geometry.origin_map - grid.geometry.origin_map).norm(), 1e-9);
      EXPECT_EQ(subscriber.grown, grid.grown);
      EXPECT_EQ(subscriber.known, grid.known);
      EXPECT_EQ(subscriber.raw, grid.raw);
    }
  }
}

}  // namespace
}  // namespace goshawk::map_server
