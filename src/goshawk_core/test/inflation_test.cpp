#include "goshawk/core/inflation.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "goshawk/core/random.hpp"

namespace goshawk {
namespace {

std::vector<Index3> set_voxels(const BitGrid& grid) {
  std::vector<Index3> set;
  for (int z = 0; z < grid.size().z; ++z) {
    for (int y = 0; y < grid.size().y; ++y) {
      for (int x = 0; x < grid.size().x; ++x) {
        if (grid.get({x, y, z})) set.push_back({x, y, z});
      }
    }
  }
  return set;
}

// Squared distance between two cubes, in whole voxel edges: exact.
std::int64_t cube_distance_squared(Index3 a, Index3 b) {
  const auto gap = [](int i, int j) { return std::int64_t(std::max(0, std::abs(i - j) - 1)); };
  return gap(a.x, b.x) * gap(a.x, b.x) + gap(a.y, b.y) * gap(a.y, b.y) +
         gap(a.z, b.z) * gap(a.z, b.z);
}

// The definition: distance^2 < radius^2, radius^2 = numerator / denominator in voxels^2, so that
// the comparison is of integers.
BitGrid brute_force(const BitGrid& occupied, std::int64_t numerator, std::int64_t denominator) {
  BitGrid grown = occupied;
  const auto sources = set_voxels(occupied);
  for (int z = 0; z < occupied.size().z; ++z) {
    for (int y = 0; y < occupied.size().y; ++y) {
      for (int x = 0; x < occupied.size().x; ++x) {
        grown.set({x, y, z}, std::ranges::any_of(sources, [&](Index3 s) {
                    return cube_distance_squared(s, {x, y, z}) * denominator < numerator;
                  }));
      }
    }
  }
  return grown;
}

BitGrid random_grid(Index3 size, bool outside, double share, Random& random) {
  BitGrid grid(size, outside);
  const auto count = std::max(1, int(share * double(grid.voxels())));
  for (int n = 0; n < count; ++n) {
    grid.set({random.below(size.x), random.below(size.y), random.below(size.z)}, true);
  }
  return grid;
}

TEST(Inflate, EqualsTheDistanceBetweenCubesOnEverySizeAndRadius) {
  Random random(1);
  const std::vector<Index3> sizes{{1, 1, 1},   {7, 5, 4},   {63, 6, 5},  {64, 6, 5},  {65, 5, 6},
                                  {127, 4, 4}, {128, 4, 4}, {129, 3, 5}, {200, 1, 1}, {1, 40, 3}};
  for (const Index3 size : sizes) {
    for (const bool outside : {false, true}) {
      const BitGrid grid = random_grid(size, outside, 0.004, random);
      // Radii in tenths of a voxel: below one, whole numbers, and in between, up to the grid.
      for (const int tenths : {1, 5, 9, 10, 11, 14, 15, 20, 21, 25, 30, 35, 40, 63, 300, 660}) {
        const auto grown = inflate(grid, tenths * 0.1, 1.0);
        ASSERT_TRUE(grown.ok());
        ASSERT_TRUE(*grown == brute_force(grid, std::int64_t{tenths} * tenths, 100))
            << to_text(size) << " radius " << tenths * 0.1;
      }
    }
  }
}

TEST(Inflate, DoesNotReachFurtherWhenTheRadiusIsAMultipleOfTheResolution) {
  // 0.6 / 0.2, 0.3 / 0.1 and the like are not whole numbers in floating point.
  Random random(2);
  const BitGrid grid = random_grid({70, 12, 9}, true, 0.002, random);
  for (const double resolution : {0.05, 0.1, 0.2, 0.3, 0.7, 1.1}) {
    for (int n = 1; n <= 12; ++n) {
      const BitGrid expected = brute_force(grid, std::int64_t{n} * n, 1);
      ASSERT_TRUE(*inflate(grid, n * resolution, resolution) == expected) << n << " " << resolution;
      double sum = 0.0;
      for (int i = 0; i < n; ++i) sum += resolution;
      ASSERT_TRUE(*inflate(grid, sum, resolution) == expected) << n << " " << resolution;
    }
  }
  EXPECT_TRUE(*inflate(grid, 0.6, 0.2) == brute_force(grid, 9, 1));
  EXPECT_TRUE(*inflate(grid, 0.15, 0.05) == brute_force(grid, 9, 1));
}

TEST(Inflate, ReachesADiagonalGapAsSoonAsTheRadiusExceedsIt) {
  // Gaps of (3, 4, 0), (1, 2, 2) and (2, 3, 6) voxels lie at exactly 5, 3 and 7.
  for (const auto& [gap, distance] :
       {std::pair{Index3{3, 4, 0}, 5}, {Index3{1, 2, 2}, 3}, {Index3{2, 3, 6}, 7}}) {
    BitGrid grid({24, 24, 24}, true);
    grid.set({8, 8, 8}, true);
    const Index3 target = Index3{9, 9, 9} + gap;
    EXPECT_FALSE(inflate(grid, distance * 0.2, 0.2)->get(target));
    EXPECT_TRUE(inflate(grid, distance * 0.2 + 1e-6, 0.2)->get(target));
    EXPECT_FALSE(inflate(grid, distance * 0.2 - 1e-6, 0.2)->get(target));
  }
}

TEST(Inflate, SetsAllTouchingVoxelsForAnyRadiusAboveZero) {
  BitGrid grid({70, 9, 9}, true);
  grid.set({64, 4, 4}, true);
  for (const double radius : {5e-324, 1e-300, 1e-12, 1e-6, 1e-3, 0.2}) {
    EXPECT_EQ(inflate(grid, radius, 0.2)->count(), 27) << radius;
  }
}

TEST(Inflate, ReturnsACopyForARadiusOfZero) {
  Random random(3);
  const BitGrid grid = random_grid({66, 5, 5}, true, 0.1, random);
  EXPECT_TRUE(*inflate(grid, 0.0, 0.2) == grid);
}

TEST(Inflate, DoesNotLetTheOutsideGrowIn) {
  const BitGrid grid({65, 4, 4}, true);
  EXPECT_EQ(inflate(grid, 0.5, 0.2)->count(), 0);
  EXPECT_EQ(inflate(grid, 1e9, 0.2)->count(), 0);
}

TEST(Inflate, GrowsMoreWithALargerRadiusAndNeverFreesAVoxel) {
  Random random(4);
  const BitGrid grid = random_grid({100, 15, 10}, true, 0.001, random);
  BitGrid before = grid;
  for (int n = 1; n <= 30; ++n) {
    const BitGrid grown = *inflate(grid, n * 0.13, 0.2);
    const auto old_words = before.to_words(), words = grown.to_words();
    for (std::size_t w = 0; w < words.size(); ++w) {
      ASSERT_EQ(old_words[w] & ~words[w], 0U);
    }
    before = grown;
  }
}

TEST(Inflate, FillsTheGridForAHugeRadiusAtOnce) {
  BitGrid grid({300, 200, 50}, true);
  grid.set({0, 0, 0}, true);
  for (const double radius : {1e3, 1e9, 1e100, 1e308}) {
    EXPECT_EQ(inflate(grid, radius, 0.2)->count(), grid.voxels()) << radius;
  }
  EXPECT_EQ(inflate(grid, 1e300, 1e-300)->count(), grid.voxels());
}

TEST(Inflate, ReachesTheFarthestCornerExactlyWhenTheRadiusDoes) {
  const Index3 size{66, 40, 30};
  BitGrid grid(size, true);
  grid.set({0, 0, 0}, true);
  const double distance = std::sqrt(64.0 * 64.0 + 38.0 * 38.0 + 28.0 * 28.0);
  EXPECT_EQ(inflate(grid, distance * 0.9999, 1.0)->count(), grid.voxels() - 1);
  EXPECT_EQ(inflate(grid, distance * 1.0001, 1.0)->count(), grid.voxels());
  EXPECT_EQ(inflate(grid, distance * 1.002, 1.0)->count(), grid.voxels());
}

TEST(Inflate, RefusesWhatIsNotAllowed) {
  const BitGrid grid({3, 3, 3}, true);
  for (const double bad : {-0.1, double(NAN), double(INFINITY), -double(INFINITY)}) {
    EXPECT_EQ(inflate(grid, bad, 0.2).code(), ErrorCode::invalid_input) << bad;
    EXPECT_EQ(inflate(grid, 0.2, bad).code(), ErrorCode::invalid_input) << bad;
  }
  EXPECT_EQ(inflate(grid, 0.2, 0.0).code(), ErrorCode::invalid_input);
  EXPECT_EQ(inflate(BitGrid(), 0.2, 0.2).code(), ErrorCode::map_empty);
  EXPECT_EQ(inflate(BitGrid(), 0.0, 0.2).code(), ErrorCode::map_empty);
}

}  // namespace
}  // namespace goshawk
