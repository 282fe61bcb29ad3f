#include "goshawk/map_server/map_tools.hpp"

#include <gtest/gtest.h>

#include <array>

#include "support.hpp"

namespace goshawk::map_server {
namespace {

constexpr double kResolution_m = 0.5;
constexpr std::int64_t kMost = 1'000'000;

RawVoxels random_map(Random& random) {
  const Index3 size{1 + random.below(150), 1 + random.below(12), 1 + random.below(12)};
  const Index3 corner{random.below(100) - 50, random.below(10) - 5, random.below(10) - 5};
  RawVoxels map;
  map.geometry = {kResolution_m * Vec3(corner.x, corner.y, corner.z), kResolution_m, size};
  map.known = testing::random_bits(size, false, 0.6, random);
  map.occupied = testing::random_bits(size, true, 0.4, random);
  for (int z = 0; z < size.z; ++z) {
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x) {
        if (!map.known.get({x, y, z})) map.occupied.set({x, y, z}, false);
      }
    }
  }
  return map;
}

enum class Voxel { unknown, free, occupied };

Voxel at(const RawVoxels& map, const Vec3& p) {
  const auto index = map.geometry.index_of(p);
  if (!index || !map.known.get(*index)) return Voxel::unknown;
  return map.occupied.get(*index) ? Voxel::occupied : Voxel::free;
}

// visit(centre) for every voxel of a box that holds all random maps
template <typename Visit>
void for_all(Visit&& visit) {
  for (int z = -6; z < 18; ++z) {
    for (int y = -6; y < 18; ++y) {
      for (int x = -51; x < 201; ++x) {
        visit(kResolution_m * Vec3(x + 0.5, y + 0.5, z + 0.5));
      }
    }
  }
}

Voxel merged(const std::array<RawVoxels, 3>& maps, MergeRule rule, const Vec3& p) {
  Voxel result = Voxel::unknown;
  for (const RawVoxels& map : maps) {
    const Voxel voxel = at(map, p);
    if (voxel == Voxel::unknown) continue;
    if (rule == MergeRule::later || result != Voxel::occupied) result = voxel;
  }
  return result;
}

TEST(MapTools, MergedMapsSayVoxelByVoxelWhatTheRuleSays) {
  Random random(61);
  for (int round = 0; round < 6; ++round) {
    const std::array maps{random_map(random), random_map(random), random_map(random)};
    for (const MergeRule rule : {MergeRule::occupied, MergeRule::later}) {
      const RawVoxels all = merge(maps, rule, kMost).value();
      int different = 0;
      for_all([&](const Vec3& p) { different += at(all, p) != merged(maps, rule, p) ? 1 : 0; });
      EXPECT_EQ(different, 0);
    }
  }
}

TEST(MapTools, ADifferenceCountsEveryVoxelOnce) {
  Random random(62);
  for (int round = 0; round < 6; ++round) {
    const RawVoxels before = random_map(random), after = random_map(random);
    MapDifference expected;
    for_all([&](const Vec3& p) {
      const Voxel a = at(before, p), b = at(after, p);
      if (a == Voxel::unknown && b == Voxel::unknown) return;
      if (a == b)
        ++expected.same;
      else if (a == Voxel::unknown)
        ++expected.learnt;
      else if (b == Voxel::unknown)
        ++expected.forgotten;
      else if (b == Voxel::occupied)
        ++expected.appeared;
      else
        ++expected.vanished;
    });
    const MapDifference found = difference(before, after, kMost).value();
    EXPECT_EQ(found.same, expected.same);
    EXPECT_EQ(found.appeared, expected.appeared);
    EXPECT_EQ(found.vanished, expected.vanished);
    EXPECT_EQ(found.learnt, expected.learnt);
    EXPECT_EQ(found.forgotten, expected.forgotten);
    EXPECT_FALSE(difference(after, after, kMost)->any());
  }
}

TEST(MapTools, ATrimmedMapSaysTheSameInTheSmallestBox) {
  Random random(63);
  for (int round = 0; round < 20; ++round) {
    RawVoxels map = random_map(random);
    const Index3 n = map.geometry.size;
    map.known = BitGrid(n, false);
    for (int k = 0; k < 3; ++k) {
      map.known.set({random.below(n.x), random.below(n.y), random.below(n.z)}, true);
    }
    const RawVoxels cut = trimmed(map).value();
    EXPECT_FALSE(difference(map, cut, kMost)->forgotten > 0);
    EXPECT_FALSE(difference(map, cut, kMost)->learnt > 0);
    const Index3 m = cut.geometry.size;  // its outermost layers hold known voxels
    for (const int x : {0, m.x - 1}) {
      EXPECT_GT(cut.known.window({x, 0, 0}, {1, m.y, m.z}).count(), 0);
    }
    for (const int y : {0, m.y - 1}) {
      EXPECT_GT(cut.known.window({0, y, 0}, {m.x, 1, m.z}).count(), 0);
    }
    for (const int z : {0, m.z - 1}) {
      EXPECT_GT(cut.known.window({0, 0, z}, {m.x, m.y, 1}).count(), 0);
    }
    map.known = BitGrid(n, false);
    EXPECT_EQ(trimmed(map).code(), ErrorCode::map_empty);
  }
}

TEST(MapTools, MapsThatDoNotFitTogetherAreRefused) {
  Random random(64);
  const RawVoxels map = random_map(random);
  RawVoxels coarse = map;
  coarse.geometry.resolution_m = 1.0;
  EXPECT_EQ(merge(std::array{map, coarse}, MergeRule::later, kMost).code(),
            ErrorCode::invalid_input);
  EXPECT_EQ(difference(map, coarse, kMost).code(), ErrorCode::invalid_input);
  EXPECT_EQ(merge({}, MergeRule::later, kMost).code(), ErrorCode::invalid_input);
  EXPECT_EQ(merge(std::array{map}, MergeRule::later, 1).code(), ErrorCode::map_too_large);
}

}  // namespace
}  // namespace goshawk::map_server
