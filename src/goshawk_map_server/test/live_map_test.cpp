#include "goshawk/map_server/live_map.hpp"

#include <gmock/gmock.h>

#include <limits>

#include "scan_support.hpp"
#include "support.hpp"

namespace goshawk::map_server {
namespace {

using testing::insert;

std::vector<Vec3> random_scan(Random& random, const Vec3& from, int rays) {
  std::vector<Vec3> points;
  for (int i = 0; i < rays; ++i) {
    const Vec3 way(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-0.5, 0.5));
    points.push_back(from + random.uniform(0.5, 6.0) * way);
  }
  return points;
}

void expect_same(const VoxelGrid& a, const VoxelGrid& b) {
  EXPECT_EQ(a.grown, b.grown);
  EXPECT_EQ(a.known, b.known);
  EXPECT_EQ(a.raw, b.raw);
  EXPECT_EQ(a.version, b.version);
}

// Is the grid what one would get by growing the whole window anew?
void expect_rebuilt(const LiveMap& map) {
  const VoxelGrid grid = map.grid();
  const auto anew =
      make_voxel_grid({grid.geometry, grid.raw, grid.known}, map.growth(), grid.version);
  if (anew) return expect_same(grid, *anew);
  EXPECT_EQ(anew.code(), ErrorCode::map_empty);
  EXPECT_EQ(grid.grown.count(), grid.grown.voxels());
}

TEST(LiveMap, UpdatesGiveWhatAFullRebuildGives) {
  Random random(31);
  for (int round = 0; round < 24; ++round) {
    const Growth growth{UnknownPolicy(round % 3), random.uniform(0.0, round % 2 == 0 ? 0.25 : 0.9),
                        round % 4 == 0 ? 0.2 : 0.0};
    const Box box{Vec3(-7.4, -2.0, -1.0), Vec3(8.0, 2.2, 1.4)};
    LiveMap map = LiveMap::unknown_space(box, 0.2, growth).value();
    VoxelGrid subscriber = map.grid();
    for (int scan = 0; scan < 5; ++scan) {
      const Vec3 from(random.uniform(-3, 3), random.uniform(-1, 1), 0.1);
      const auto result = insert(map, random_scan(random, from, 80), from, 4.0);
      ASSERT_TRUE(result) << result.error().message;
      ASSERT_TRUE(apply(subscriber, result->update));
      expect_same(subscriber, map.grid());
      expect_rebuilt(map);
    }
  }
}

TEST(LiveMap, NothingUnseenBecomesFreeUnderTheStrictPolicies) {
  Random random(32);
  for (const auto policy : {UnknownPolicy::occupied, UnknownPolicy::blocked}) {
    LiveMap map =
        LiveMap::unknown_space({Vec3(-4, -2, -1), Vec3(4, 2, 1)}, 0.1, {policy, 0.1}).value();
    EXPECT_EQ(map.grid().grown.count(), map.grid().grown.voxels());
    const Vec3 from(0.05, 0.05, 0.05);
    ASSERT_TRUE(insert(map, random_scan(random, from, 300), from, 5.0));
    const BitGrid grown = map.grid().grown;
    EXPECT_LT(grown.count(), grown.voxels());
    const auto grown_words = grown.to_words(), known_words = map.grid().known.to_words();
    for (std::size_t i = 0; i < grown_words.size(); ++i) {
      EXPECT_EQ(~grown_words[i] & ~known_words[i], 0U);
    }
  }
}

TEST(LiveMap, OnlyBricksThatChangedAreSent) {
  LiveMap map =
      LiveMap::unknown_space({Vec3(0, 0, 0), Vec3(64, 16, 8)}, 0.1, {UnknownPolicy::free, 0.2})
          .value();
  const Vec3 from(1.05, 1.05, 1.05);
  const std::vector<Vec3> one{Vec3(2.05, 1.05, 1.05)};
  const auto first = insert(map, one, from, 10.0).value();
  EXPECT_GE(first.update.bricks.size(), 1U);
  EXPECT_LE(first.update.bricks.size(), 12U);
  EXPECT_EQ(first.update.from_version, 1U);
  EXPECT_EQ(first.update.to_version, 2U);
  const auto again = insert(map, one, from, 10.0).value();
  EXPECT_TRUE(again.update.bricks.empty());
  EXPECT_EQ(again.update.to_version, 3U);
  for (std::size_t i = 0; i < first.update.bricks.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_FALSE(first.update.bricks[i].index == first.update.bricks[j].index);
    }
  }
}

TEST(LiveMap, AnObstacleThatGoesAwayIsFreedAgain) {
  LiveMap map =
      LiveMap::unknown_space({Vec3(0, 0, 0), Vec3(6, 3, 2)}, 0.1, {UnknownPolicy::blocked, 0.15})
          .value();
  const Vec3 from(0.55, 1.05, 1.05);
  const Vec3 box_at(2.05, 1.05, 1.05);
  const std::vector<Vec3> near_hit{box_at};
  const std::vector<Vec3> far_hit{Vec3(5.05, 1.05, 1.05)};
  ASSERT_TRUE(insert(map, near_hit, from, 10.0));
  const Index3 voxel = *map.grid().geometry.index_of(box_at);
  EXPECT_TRUE(map.grid().grown.get(voxel));
  for (int i = 0; i < 10; ++i) ASSERT_TRUE(insert(map, far_hit, from, 10.0));
  EXPECT_FALSE(map.grid().grown.get(voxel));
}

TEST(LiveMap, BadScansChangeNothingAndBadPointsAreCounted) {
  LiveMap map = LiveMap::unknown_space({Vec3(0, 0, 0), Vec3(4, 4, 2)}, 0.1, {}).value();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  const VoxelGrid before = map.grid();
  const std::vector<Vec3> points{Vec3(1, 1, 1), Vec3(nan, 0, 0), Vec3(1e300, 1e300, 0),
                                 Vec3(1e38, -1e38, 1e38), Vec3(inf, 0, 0)};
  EXPECT_EQ(insert(map, points, Vec3(nan, 0, 0), 5.0).code(), ErrorCode::invalid_input);
  EXPECT_EQ(insert(map, points, Vec3::Ones(), 0.0).code(), ErrorCode::invalid_input);
  EXPECT_EQ(insert(map, points, Vec3::Ones(), nan).code(), ErrorCode::invalid_input);
  EXPECT_EQ(insert(map, points, Vec3(1e9, 0, 0), 5.0).code(), ErrorCode::map_too_large);
  const std::vector<Vec3> two_origins{Vec3::Ones(), Vec3::Ones()};
  ScanResult unused;
  EXPECT_EQ(map.insert_scan({.points_map = points, .origins_map = two_origins}, unused).code(),
            ErrorCode::invalid_input);
  EXPECT_EQ(map.insert_scan({.points_map = points, .origins_map = {}}, unused).code(),
            ErrorCode::invalid_input);
  expect_same(map.grid(), before);
  const auto result = insert(map, points, Vec3(0.55, 0.55, 0.55), 5.0).value();
  EXPECT_EQ(result.points_left_out, 3);  // a length that overflows is not finite either
  EXPECT_GT(map.grid().known.count(), 5);
  EXPECT_TRUE(insert(map, {}, Vec3::Ones(), 5.0));
}

TEST(LiveMap, MissingReturnsDoNotBlockTheSensor) {
  LiveMap map = LiveMap::unknown_space({Vec3::Zero(), Vec3(4, 4, 2)}, 0.1, {}).value();
  const Vec3 from(0.55, 0.55, 0.55);
  const std::vector<Vec3> points{from, Vec3(3.05, 0.55, 0.55), from};
  EXPECT_EQ(insert(map, points, from, 5.0).value().points_left_out, 2);
  const Index3 voxel = *map.grid().geometry.index_of(from);
  EXPECT_TRUE(map.grid().known.get(voxel));
  EXPECT_FALSE(map.grid().raw.get(voxel));
}

TEST(LiveMap, StartsFromALoadedMap) {
  const testing::Folder folder;
  const MapSource source = load_map(folder.write("m.3dmap", "voxel 30 30 30\n15 15 15\n")).value();
  LiveMap map = LiveMap::from_source(source, {}, {UnknownPolicy::occupied, 0.3}).value();
  EXPECT_EQ(map.grid().version, 1U);
  VoxelGrid subscriber = map.grid();
  const Vec3 from(1.1, 1.1, 1.1);
  const std::vector<Vec3> wall{Vec3(1.1, 4.1, 1.1), Vec3(1.3, 4.1, 1.1)};
  for (int i = 0; i < 8; ++i) {
    const auto result = insert(map, wall, from, 10.0).value();
    ASSERT_TRUE(apply(subscriber, result.update));
  }
  EXPECT_TRUE(subscriber.grown.get(*subscriber.geometry.index_of(wall[0])));
  expect_same(subscriber, map.grid());
  expect_rebuilt(map);
}

TEST(LiveMap, BadBoxesAreRefused) {
  EXPECT_EQ(LiveMap::unknown_space({Vec3::Ones(), Vec3::Zero()}, 0.1, {}).code(),
            ErrorCode::invalid_parameter);
  EXPECT_EQ(LiveMap::unknown_space({Vec3::Zero(), Vec3::Ones()}, -0.1, {}).code(),
            ErrorCode::invalid_parameter);
  EXPECT_EQ(
      LiveMap::unknown_space({Vec3::Zero(), Vec3::Ones()}, 0.1, {UnknownPolicy::free, -1.0}).code(),
      ErrorCode::invalid_input);
}

}  // namespace
}  // namespace goshawk::map_server
