#include "goshawk/core/free_space.hpp"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "goshawk/core/free_curve.hpp"
#include "goshawk/core/inflation.hpp"
#include "goshawk/core/random.hpp"

namespace goshawk {
namespace {

constexpr Index3 kSize{70, 9, 8};

/// Obstacles that are known, and space that was never seen; the map leaves it free.
VoxelGrid unfolded(Random& random, double inflation_m, double unseen_share) {
  VoxelGrid grid;
  grid.geometry = {.origin_map = {-1.0, 2.0, 0.5}, .resolution_m = 0.2, .size = kSize};
  grid.known = BitGrid(kSize, false);
  grid.raw = BitGrid(kSize, true, false);
  grid.inflation_m = inflation_m;
  grid.unknown_is_occupied = false;
  grid.version = 3;
  for (int z = 0; z < kSize.z; ++z) {
    for (int y = 0; y < kSize.y; ++y) {
      for (int x = 0; x < kSize.x; ++x) {
        const bool known = !random.chance(unseen_share);
        grid.known.set({x, y, z}, known);
        grid.raw.set({x, y, z}, known && random.chance(0.01));
      }
    }
  }
  grid.grown = inflate(grid.raw, inflation_m, 0.2).value();
  return grid;
}

/// [voxels] the gap between two voxels' cubes
double gap(Index3 a, Index3 b) {
  const auto along = [](int i, int k) { return double(std::max(0, std::abs(i - k) - 1)); };
  return std::hypot(along(a.x, b.x), along(a.y, b.y), along(a.z, b.z));
}

/// By looking at every voxel of the map.
bool body_was_seen_free(const VoxelGrid& grid, Index3 centre) {
  const double radius = grid.inflation_m / grid.geometry.resolution_m;
  for (int z = 0; z < kSize.z; ++z) {
    for (int y = 0; y < kSize.y; ++y) {
      for (int x = 0; x < kSize.x; ++x) {
        const Index3 i{x, y, z};
        const bool near = i == centre || (radius > 0.0 && gap(i, centre) < radius * (1 - 1e-9));
        if (near && (!grid.known.get(i) || grid.raw.get(i))) return false;
      }
    }
  }
  return true;
}

TEST(FreeSpace, IsWhereTheWholeBodyWasSeenFree) {
  Random random(4);
  for (const double inflation_m : {0.0, 0.15, 0.2, 0.45}) {
    SCOPED_TRACE(inflation_m);
    const auto grid = std::make_shared<VoxelGrid>(
        unfolded(random, inflation_m, inflation_m > 0.3 ? 0.002 : 0.02));
    const FreeSpace space(grid);
    ASSERT_TRUE(space.asks_for_known());
    int free = 0, unseen = 0;
    for (int z = 0; z < kSize.z; ++z) {
      for (int y = 0; y < kSize.y; ++y) {
        for (int x = 0; x < kSize.x; ++x) {
          const bool wanted = body_was_seen_free(*grid, {x, y, z});
          ASSERT_EQ(space.is_free({x, y, z}), wanted) << x << ' ' << y << ' ' << z;
          free += wanted ? 1 : 0;
          unseen += !wanted && !grid->grown.get({x, y, z}) ? 1 : 0;
        }
      }
    }
    EXPECT_GT(free, 100);
    EXPECT_GT(unseen, 20);
    EXPECT_FALSE(space.is_free({-1, 0, 0})) << "outside";
    EXPECT_FALSE(space.is_free({0, 0, kSize.z}));
  }
}

TEST(FreeSpace, OfARowTheFirstBlockedVoxelIsNamed) {
  Random random(5);
  const auto grid = std::make_shared<VoxelGrid>(unfolded(random, 0.25, 0.005));
  const FreeSpace space(grid);
  for (int run = 0; run < 200; ++run) {
    const int y = random.below(kSize.y), z = random.below(kSize.z);
    const int from = random.below(kSize.x), to = from + random.below(kSize.x - from);
    std::optional<Index3> wanted;
    for (int x = to; x >= from; --x) {
      if (!body_was_seen_free(*grid, {x, y, z})) wanted = Index3{x, y, z};
    }
    const auto found = first_blocked(space.view(), from, to, y, z);
    ASSERT_EQ(found.has_value(), wanted.has_value());
    if (!found) continue;
    // An obstacle is named before what was not seen.
    ASSERT_FALSE(body_was_seen_free(*grid, *found));
    ASSERT_GE(found->x, wanted->x);
    if (!grid->grown.get(*found)) {
      ASSERT_EQ(*found, *wanted);
    }
  }
}

TEST(FreeSpace, IsWhatTheMapSaysIfTheMapCountsUnknownSpaceAsOccupiedOrAllIsKnown) {
  Random random(6);
  const VoxelGrid lax = unfolded(random, 0.2, 0.1);
  VoxelGrid strict = lax;
  strict.unknown_is_occupied = true;
  VoxelGrid known = lax;
  known.known = {};
  for (const auto& grid : {strict, known}) {
    const FreeSpace space(std::make_shared<const VoxelGrid>(grid));
    EXPECT_FALSE(space.asks_for_known());
    for (int x = 0; x < kSize.x; ++x)
      EXPECT_EQ(space.is_free({x, 4, 4}), !grid.grown.get({x, 4, 4}));
  }
  const FreeSpace flown_unseen(std::make_shared<const VoxelGrid>(lax), true);
  EXPECT_FALSE(flown_unseen.asks_for_known());
}

TEST(FreeSpace, OutlivesCopiesAndFollowsTheMap) {
  Random random(7);
  const auto first = std::make_shared<const VoxelGrid>(unfolded(random, 0.2, 0.1));
  auto space = std::make_unique<FreeSpace>(first);
  FreeSpace copy = *space;
  space.reset();
  EXPECT_TRUE(copy.asks_for_known());
  EXPECT_FALSE(copy.view().body.empty());
  VoxelGrid all_known = *first;
  all_known.known = BitGrid(kSize, false, true);
  all_known.grown = BitGrid(kSize, true);
  copy.set_map(std::make_shared<const VoxelGrid>(all_known));
  EXPECT_FALSE(first_blocked(copy.view(), 0, kSize.x - 1, 4, 4));
}

TEST(FreeSpace, AnObstructionByWhatWasNeverSeenSaysSo) {
  VoxelGrid grid;
  grid.geometry = {.resolution_m = 0.2, .size = {40, 10, 10}};
  grid.grown = BitGrid(grid.geometry.size, true);
  grid.known = BitGrid(grid.geometry.size, false, true);
  grid.unknown_is_occupied = false;
  grid.inflation_m = 0.2;
  grid.version = 12;
  grid.known.set({20, 5, 5}, false);
  const FreeSpace space(std::make_shared<const VoxelGrid>(grid));
  const auto line = BezierPiece::between({.position = Vec3(1.0, 1.1, 1.1)},
                                         {.position = Vec3(7.0, 1.1, 1.1)}, 6.0);
  EXPECT_FALSE(find_obstruction(grid, line)) << "planned through";
  const auto found = find_obstruction(space, line);
  ASSERT_TRUE(found);
  EXPECT_EQ(found->voxel, (Index3{19, 5, 5})) << "the body, grown by a voxel, reaches the next";
  EXPECT_NEAR(line.sample(found->time_s).position.x(), 3.8, 1e-3);
  EXPECT_THAT(to_text(*space.grid(), *found),
              testing::HasSubstr("map 12 has space that was never seen"));
}

}  // namespace
}  // namespace goshawk
