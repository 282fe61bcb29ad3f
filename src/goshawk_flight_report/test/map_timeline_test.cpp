// The maps of a flight, and what a page plays of them.
#include "goshawk/flight_report/map_timeline.hpp"

#include <gtest/gtest.h>

#include "../src/map_growth.hpp"
#include "goshawk/core/random.hpp"

namespace goshawk::flight_report::test {
namespace {

/// A window of 70 x 9 x 9 voxels of 0.5 m with random content.
VoxelGrid random_grid(Random& random, const Vec3& origin = Vec3::Zero()) {
  VoxelGrid grid;
  grid.geometry = {origin, 0.5, {70, 9, 9}};
  grid.grown = BitGrid(grid.geometry.size, true, false);
  grid.known = grid.raw = BitGrid(grid.geometry.size, false);
  for (int z = 0; z < 9; ++z) {
    for (int y = 0; y < 9; ++y) {
      for (int x = 0; x < 70; ++x) {
        grid.known.set({x, y, z}, random.chance(0.5));
        grid.raw.set({x, y, z}, random.chance(0.3));
      }
    }
  }
  return grid;
}

/// Reads what runs_of() wrote, by another way than a page does: a voxel a time.
std::vector<bool> bits_of(const std::string& text) {
  std::string bytes;
  std::uint32_t word = 0;
  int digits = 0;
  const std::string alphabet = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  for (const char c : text) {
    if (c == '=') break;
    word = word << 6 | std::uint32_t(alphabet.find(c));
    if (++digits % 4 != 1) bytes += char(word >> (6 - 2 * ((digits - 1) % 4)) & 255U);
  }
  std::vector<bool> bits;
  bool value = false;
  std::uint64_t length = 0;
  int shift = 0;
  for (const char c : bytes) {
    length |= std::uint64_t(c & 127) << shift;
    shift += 7;
    if (c & 128) continue;
    bits.insert(bits.end(), length, value);
    value = !value;
    length = 0;
    shift = 0;
  }
  return bits;
}

TEST(MapTimeline, KeepsMomentsApartAndTheNewestMap) {
  MapTimeline timeline(1.0, 4);
  Random random(1);
  std::vector<VoxelGrid> grids;
  for (int k = 0; k <= 10; ++k) {
    grids.push_back(random_grid(random));
    grids.back().version = std::uint64_t(k);
    timeline.take(0.5 * k, grids.back());
    timeline.take(0.5 * k + 0.25, grids.back());  // the same again
  }
  const auto moments = timeline.moments();
  ASSERT_EQ(moments.size(), 4);  // 0, 1, 2, 3; then every second: 0, 2; 4; and the newest
  const double times_s[] = {0.0, 2.0, 4.0, 5.0};
  for (std::size_t k = 0; k < 4; ++k) {
    EXPECT_EQ(moments[k].t_s, times_s[k]);
    EXPECT_EQ(moments[k].grid.raw, grids[std::size_t(2.0 * times_s[k])].raw);
  }
}

TEST(MapTimeline, AppliesUpdatesThatFollowAndLeavesOutOthers) {
  Random random(2);
  MapTimeline timeline(0.0);
  GridUpdate update;
  update.from_version = 7;
  update.to_version = 8;
  EXPECT_TRUE(timeline.take(0.0, update));  // nothing to apply it to
  EXPECT_TRUE(timeline.moments().empty());

  VoxelGrid grid = random_grid(random);
  grid.version = 7;
  timeline.take(1.0, grid);
  Brick brick = brick_of(grid, {1, 0, 1});
  for (auto& word : brick.known) word = ~BitGrid::Word{0};
  update.bricks = {brick};
  EXPECT_TRUE(timeline.take(2.0, update));
  EXPECT_TRUE(timeline.take(3.0, update)) << "one that does not follow any more";
  const auto moments = timeline.moments();
  ASSERT_EQ(moments.size(), 2);
  EXPECT_EQ(moments[0].grid.known, grid.known) << "versions that are kept stay as they were";
  EXPECT_TRUE(moments[1].grid.known.test({69, 7, 8}));
  EXPECT_EQ(timeline.newest()->version, 8);

  update.from_version = 8;
  update.bricks[0].index = {9, 0, 0};
  EXPECT_EQ(timeline.take(4.0, update).code(), ErrorCode::invalid_input);
}

TEST(MapTimeline, SpreadTakesTheEndsAndOthersBetween) {
  std::vector<MapMoment> moments(9);
  for (int k = 0; k < 9; ++k) moments[std::size_t(k)].t_s = k;
  const auto times = [&](std::size_t count) {
    std::vector<double> t_s;
    for (const auto& moment : spread(moments, count)) t_s.push_back(moment.t_s);
    return t_s;
  };
  EXPECT_EQ(times(1), std::vector<double>({8}));
  EXPECT_EQ(times(2), std::vector<double>({0, 8}));
  EXPECT_EQ(times(3), std::vector<double>({0, 4, 8}));
  EXPECT_EQ(times(20).size(), 9);
}

TEST(MapGrowth, AddsUpToEachMomentWhereverTheWindowIs) {
  Random random(3);
  std::vector<MapMoment> moments;
  const Vec3 origins[] = {{0, 0, 0}, {32, 4, 0}, {32, 4, 0}, {-32, 0, -4}};
  for (std::size_t k = 0; k < 4; ++k) {
    moments.push_back({double(k), random_grid(random, origins[k]), {}});
  }
  const MapGrowth growth = growth_of(moments);
  ASSERT_EQ(growth.changes.size(), 4);
  const Index3 size = growth.geometry.size;
  EXPECT_EQ(size, (Index3{198, 17, 17}));
  EXPECT_EQ(growth.geometry.origin_map, Vec3(-32, 0, -4));
  std::vector<bool> obstacles(std::size_t(size.x * size.y * size.z)), known = obstacles;
  for (std::size_t k = 0; k < 4; ++k) {
    const auto flips = bits_of(growth.changes[k].obstacles),
               learnt = bits_of(growth.changes[k].known);
    ASSERT_EQ(flips.size(), obstacles.size());
    ASSERT_EQ(learnt.size(), known.size());
    for (std::size_t i = 0; i < flips.size(); ++i) {
      obstacles[i] = obstacles[i] != flips[i];
      known[i] = known[i] != learnt[i];
    }
    for (int z = 0; z < size.z; ++z) {
      for (int y = 0; y < size.y; ++y) {
        for (int x = 0; x < size.x; ++x) {
          const Vec3 place = growth.geometry.center({x, y, z});
          bool is_known = false, is_obstacle = false;
          for (std::size_t m = 0; m <= k; ++m) {  // the newest window that held the place
            const auto i = moments[m].grid.geometry.index_of(place);
            if (!i) continue;
            is_known = moments[m].grid.known.test(*i);
            is_obstacle = is_known && moments[m].grid.raw.test(*i);
          }
          const std::size_t at = std::size_t(x + size.x * (y + size.y * z));
          ASSERT_EQ(known[at], is_known) << k << ": " << x << ", " << y << ", " << z;
          ASSERT_EQ(obstacles[at], is_obstacle) << k << ": " << x << ", " << y << ", " << z;
        }
      }
    }
  }
}

TEST(MapGrowth, LeavesOutOtherRastersAndWorldsThatAPageCannotDraw) {
  Random random(4);
  std::vector<MapMoment> moments{{0.0, random_grid(random, {0.2, 0, 0}), {}},
                                 {1.0, random_grid(random), {}}};
  EXPECT_EQ(growth_of(moments).changes.size(), 1);
  moments[0].grid.geometry.origin_map = {32000, 32000, 0};
  EXPECT_TRUE(growth_of(moments).changes.empty());
  EXPECT_TRUE(growth_of({}).changes.empty());
}

}  // namespace
}  // namespace goshawk::flight_report::test
