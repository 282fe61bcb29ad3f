#include "goshawk/core/grid_geometry.hpp"

#include "goshawk/core/inflation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "goshawk/core/random.hpp"

namespace goshawk {
namespace {

VoxelGrid small_grid() {
  VoxelGrid grid;
  grid.geometry = {Vec3(-1.0, 2.0, 0.5), 0.2, {10, 6, 4}};
  grid.grown = BitGrid(grid.geometry.size, true);
  grid.known = BitGrid(grid.geometry.size, false, true);
  return grid;
}

TEST(GridGeometry, FindsTheVoxelOfEveryPointInside) {
  Random random(1);
  for (int n = 0; n < 2000; ++n) {
    const GridGeometry geometry{
        Vec3(random.uniform(-50, 50), random.uniform(-50, 50), 0.1),
        random.uniform(0.01, 2.0),
        {1 + random.below(200), 1 + random.below(200), 1 + random.below(9)}};
    const Index3 i{random.below(geometry.size.x), random.below(geometry.size.y),
                   random.below(geometry.size.z)};
    ASSERT_EQ(geometry.index_of(geometry.center(i)), i);
    const Vec3 inside =
        geometry.lower_corner(i) + geometry.resolution_m * Vec3(random.uniform(0.001, 0.999),
                                                                random.uniform(0.001, 0.999), 0.5);
    ASSERT_EQ(geometry.index_of(inside), i);
    ASSERT_LT((geometry.to_grid(geometry.center(i)) - Vec3(i.x + 0.5, i.y + 0.5, i.z + 0.5)).norm(),
              1e-9);
  }
}

TEST(GridGeometry, GivesASharedFaceToTheUpperVoxel) {
  const GridGeometry geometry{Vec3(-1.0, 0.0, 2.0), 0.25, {8, 8, 8}};
  EXPECT_EQ(geometry.index_of(Vec3(-1.0, 0.0, 2.0)), (Index3{0, 0, 0}));
  EXPECT_EQ(geometry.index_of(Vec3(-0.75, 0.25, 2.5)), (Index3{1, 1, 2}));
  EXPECT_FALSE(geometry.index_of(geometry.upper_corner_map()));
  EXPECT_FALSE(geometry.index_of(Vec3(1.0, 0.1, 2.1)));
  EXPECT_FALSE(geometry.index_of(Vec3(std::nextafter(-1.0, -2.0), 0.1, 2.1)));
}

TEST(GridGeometry, FindsNoVoxelForPointsThatAreNowhere) {
  const GridGeometry geometry{Vec3::Zero(), 0.2, {10, 10, 10}};
  for (const double bad : {double(NAN), double(INFINITY), -double(INFINITY), 1e300, -1e300, 1e10}) {
    for (int axis = 0; axis < 3; ++axis) {
      Vec3 p(1.0, 1.0, 1.0);
      p[axis] = bad;
      EXPECT_FALSE(geometry.index_of(p)) << to_text(p);
    }
  }
}

TEST(GridGeometry, ChecksEveryPart) {
  EXPECT_TRUE((GridGeometry{Vec3::Zero(), 0.2, {1, 1, 1}}.check().ok()));
  EXPECT_EQ((GridGeometry{Vec3(0, NAN, 0), 0.2, {1, 1, 1}}.check().code()),
            ErrorCode::invalid_input);
  for (const double bad : {0.0, -0.2, double(NAN), double(INFINITY)}) {
    EXPECT_EQ((GridGeometry{Vec3::Zero(), bad, {1, 1, 1}}.check().code()),
              ErrorCode::invalid_input);
  }
  EXPECT_EQ((GridGeometry{Vec3::Zero(), 0.2, {1, 0, 1}}.check().code()), ErrorCode::map_empty);
}

TEST(VoxelGrid, ChecksThatItsBitsFitItsGeometry) {
  EXPECT_TRUE(small_grid().check().ok());
  VoxelGrid no_known = small_grid();
  no_known.known = {};
  EXPECT_TRUE(no_known.check().ok());
  EXPECT_TRUE(no_known.is_known({0, 0, 0}));
  EXPECT_FALSE(no_known.is_known({-1, 0, 0}));
  VoxelGrid wrong = small_grid();
  wrong.grown = BitGrid({10, 6, 5}, true);
  EXPECT_EQ(wrong.check().code(), ErrorCode::invalid_input);
  wrong = small_grid();
  wrong.known = BitGrid({9, 6, 4}, false);
  EXPECT_EQ(wrong.check().code(), ErrorCode::invalid_input);
  EXPECT_EQ(VoxelGrid{}.check().code(), ErrorCode::map_empty);
}

TEST(Locate, FindsAFreeVoxel) {
  const VoxelGrid grid = small_grid();
  const auto index = locate(grid, grid.geometry.center({3, 2, 1}), Endpoint::start);
  ASSERT_TRUE(index.ok());
  EXPECT_EQ(*index, (Index3{3, 2, 1}));
}

TEST(Locate, NamesTheEndAndTheReason) {
  VoxelGrid grid = small_grid();
  grid.grown.set({1, 1, 1}, true);
  grid.grown.set({2, 1, 1}, true);
  grid.known.set({2, 1, 1}, false);
  const Vec3 occupied = grid.geometry.center({1, 1, 1});
  const Vec3 unknown = grid.geometry.center({2, 1, 1});
  const Vec3 outside(5.0, 2.1, 0.6);
  EXPECT_EQ(locate(grid, occupied, Endpoint::start).code(), ErrorCode::start_occupied);
  EXPECT_EQ(locate(grid, occupied, Endpoint::goal).code(), ErrorCode::goal_occupied);
  EXPECT_EQ(locate(grid, unknown, Endpoint::start).code(), ErrorCode::start_unknown);
  EXPECT_EQ(locate(grid, unknown, Endpoint::goal).code(), ErrorCode::goal_unknown);
  EXPECT_EQ(locate(grid, outside, Endpoint::start).code(), ErrorCode::start_outside);
  EXPECT_EQ(locate(grid, outside, Endpoint::goal).code(), ErrorCode::goal_outside);
  const std::string sentence = locate(grid, outside, Endpoint::goal).error().message;
  EXPECT_NE(sentence.find("goal (5.000, 2.100, 0.600)"), std::string::npos) << sentence;
}

TEST(Locate, CallsAVoxelOccupiedWhereUnknownCountsAsFreeOrAllIsKnown) {
  VoxelGrid grid = small_grid();
  grid.grown.set({2, 1, 1}, true);
  grid.known.set({2, 1, 1}, false);
  const Vec3 p = grid.geometry.center({2, 1, 1});
  grid.unknown_is_occupied = false;
  EXPECT_EQ(locate(grid, p, Endpoint::goal).code(), ErrorCode::goal_occupied);
  grid.unknown_is_occupied = true;
  grid.known = {};
  EXPECT_EQ(locate(grid, p, Endpoint::goal).code(), ErrorCode::goal_occupied);
}

// A room of 40 x 40 x 20 voxels of 0.1 m, of which the right half was never measured, with a floor
// and a pillar; grown by 0.25 m.
VoxelGrid half_known_room(bool raw) {
  VoxelGrid grid;
  grid.geometry = {Vec3::Zero(), 0.1, {40, 40, 20}};
  BitGrid occupied(grid.geometry.size, true);
  grid.known = BitGrid(grid.geometry.size, false);
  BitGrid blocked = occupied;
  for (int z = 0; z < 20; ++z) {
    for (int y = 0; y < 40; ++y) {
      grid.known.set_run(0, 20, y, z, true);
      blocked.set_run(20, 40, y, z, true);
      if (z == 0) occupied.set_run(0, 20, y, z, true);
    }
    occupied.set({5, 20, z}, true);
  }
  for (int z = 0; z < 20; ++z) {
    for (int y = 0; y < 40; ++y) {
      for (int x = 0; x < 20; ++x) {
        if (occupied.get({x, y, z})) blocked.set({x, y, z}, true);
      }
    }
  }
  grid.inflation_m = 0.25;
  grid.unknown_grows = true;
  grid.grown = inflate(blocked, grid.inflation_m, grid.geometry.resolution_m).value();
  if (raw) grid.raw = occupied;
  return grid;
}

TEST(Locate, SaysWhatIsTooNear) {
  const VoxelGrid grid = half_known_room(true), without_raw = half_known_room(false);
  const auto told = [&](const VoxelGrid& g, const Vec3& p) {
    const auto located = locate(g, p, Endpoint::goal);
    EXPECT_EQ(located.code(), ErrorCode::goal_occupied) << to_text(p);
    return located ? "free" : located.error().message;
  };
  const auto says = [](const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
  };
  EXPECT_PRED2(says, told(grid, {1.55, 0.55, 0.05}), "lies in an obstacle");
  EXPECT_PRED2(says, told(grid, {1.55, 0.55, 0.25}),
               "closer than 0.25 m to the obstacle at (1.550, 0.550, 0.050), below it");
  EXPECT_PRED2(says, told(grid, {0.75, 2.05, 1.05}), "(0.550, 2.050, 1.050), beside it");
  EXPECT_PRED2(says, told(grid, {1.85, 0.55, 1.05}), "closer than 0.25 m to unknown space");
  EXPECT_FALSE(says(told(grid, {1.85, 0.55, 1.05}), "obstacle,"));
  // Without the obstacles as measured both may be near.
  EXPECT_PRED2(says, told(without_raw, {1.85, 0.55, 1.05}), "unknown: free); or");
  EXPECT_PRED2(says, told(without_raw, {0.75, 2.05, 1.05}), "lies in an obstacle, or closer than");
  EXPECT_EQ(locate(grid, {3.05, 0.55, 1.05}, Endpoint::goal).code(), ErrorCode::goal_unknown);
  EXPECT_TRUE(locate(grid, {1.05, 0.55, 1.05}, Endpoint::goal));
}

// By the growth of obstacles alone, which inflate() knows.
TEST(Locate, BlamesObstaclesWhereTheyBlockAndElseUnknownSpace) {
  const VoxelGrid grid = half_known_room(true);
  const BitGrid by_obstacles =
      inflate(grid.raw, grid.inflation_m, grid.geometry.resolution_m).value();
  int obstacles = 0, unknown = 0;
  for (int k = 0; k < 20 * 40 * 20; ++k) {
    const Index3 i{k % 20, k / 20 % 40, k / 800};  // the half that is known
    const auto located = locate(grid, grid.geometry.center(i), Endpoint::start);
    ASSERT_EQ(located.ok(), !grid.grown.get(i));
    if (located) continue;
    const bool blames_unknown =
        located.error().message.find("to unknown space") != std::string::npos;
    ASSERT_EQ(blames_unknown, !by_obstacles.get(i)) << located.error().message;
    ++(blames_unknown ? unknown : obstacles);
  }
  EXPECT_GT(unknown, 1000);
  EXPECT_GT(obstacles, 1000);
}

TEST(Locate, RefusesWhatIsNotFiniteAndKeepsHugeNumbersReadable) {
  const VoxelGrid grid = small_grid();
  for (const Endpoint end : {Endpoint::start, Endpoint::goal}) {
    EXPECT_EQ(locate(grid, Vec3(0, NAN, 0), end).code(), ErrorCode::invalid_input);
    EXPECT_EQ(locate(grid, Vec3(0, 0, INFINITY), end).code(), ErrorCode::invalid_input);
  }
  const auto far = locate(grid, Vec3(1e300, 0, -1e300), Endpoint::goal);
  EXPECT_EQ(far.code(), ErrorCode::goal_outside);
  EXPECT_NE(far.error().message.find("(1e+300, 0, -1e+300)"), std::string::npos)
      << far.error().message;
}

/// [voxels^2] between the cubes of two voxels
int squared_gap(Index3 a, Index3 b) {
  const auto along = [](int i, int k) { return std::max(0, std::abs(i - k) - 1); };
  const int x = along(a.x, b.x), y = along(a.y, b.y), z = along(a.z, b.z);
  return x * x + y * y + z * z;
}

/// The voxel whose centre a sentence names after these words.
std::optional<Index3> named_after(const std::string& words, const std::string& sentence,
                                  const GridGeometry& geometry) {
  const auto at = sentence.find(words);
  double x = 0.0, y = 0.0, z = 0.0;
  if (at == std::string::npos ||
      std::sscanf(sentence.c_str() + at + words.size(), "(%lf, %lf, %lf)", &x, &y, &z) != 3) {
    return {};
  }
  return geometry.index_of(Vec3(x, y, z));
}

// By looking at every voxel.
TEST(Locate, NamesAnObstacleThanWhichNoneIsNearer) {
  Random random(2);
  int named = 0;
  for (int round = 0; round < 30; ++round) {
    VoxelGrid grid;
    grid.geometry = {Vec3(-1.0, 2.0, 0.5), 0.2, {14, 13, 12}};
    grid.raw = BitGrid(grid.geometry.size, true);
    std::vector<Index3> obstacles;
    for (int k = 0; k < 4; ++k) {
      obstacles.push_back({random.below(14), random.below(13), random.below(12)});
      grid.raw.set(obstacles.back(), true);
    }
    grid.inflation_m = random.uniform(0.2, 0.9);
    grid.grown = inflate(grid.raw, grid.inflation_m, 0.2).value();
    for (int k = 0; k < 14 * 13 * 12; ++k) {
      const Index3 i{k % 14, k / 14 % 13, k / (14 * 13)};
      if (!grid.grown.get(i) || grid.raw.get(i)) continue;
      const auto located = locate(grid, grid.geometry.center(i), Endpoint::start);
      ASSERT_EQ(located.code(), ErrorCode::start_occupied);
      const auto told = named_after("the obstacle at ", located.error().message, grid.geometry);
      ASSERT_TRUE(told) << located.error().message;
      ASSERT_TRUE(grid.raw.get(*told));
      int least = std::numeric_limits<int>::max();
      for (const Index3 o : obstacles) least = std::min(least, squared_gap(i, o));
      ASSERT_EQ(squared_gap(i, *told), least) << located.error().message;
      ++named;
    }
  }
  EXPECT_GT(named, 1000);
}

}  // namespace
}  // namespace goshawk
