#include "goshawk/core/line_of_sight.hpp"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <set>
#include <tuple>
#include <vector>

#include "goshawk/core/random.hpp"

namespace goshawk {
namespace {

// By how much the cube of voxel i is apart from the segment along the axis that separates them
// best: segment against box by separating axes (the three faces, and the segment crossed with
// each). <= 0: they meet.
double separation(const Vec3& a, const Vec3& b, Index3 i) {
  const Vec3 center(i.x + 0.5, i.y + 0.5, i.z + 0.5);
  const double half = 0.5;
  const Vec3 middle = 0.5 * (a + b) - center;
  const Vec3 reach = 0.5 * (b - a);
  double worst = -HUGE_VAL;
  for (int axis = 0; axis < 3; ++axis) {
    worst = std::max(worst, std::abs(middle[axis]) - std::abs(reach[axis]) - half);
    const Vec3 normal = reach.cross(Vec3::Unit(axis));
    const double length = normal.norm();
    if (length < 1e-12) continue;
    const double box = half * normal.cwiseAbs().sum();
    worst = std::max(worst, (std::abs(middle.dot(normal)) - box) / length);
  }
  return worst;
}

using Key = std::tuple<int, int, int>;
Key key(Index3 i) {
  return {i.x, i.y, i.z};
}

// Every cube that meets the segment is in the supercover, each once; every cube in it meets the
// segment, or misses by no more than the slack.
void expect_supercover(const Vec3& a, const Vec3& b) {
  const auto cells = supercover(a, b);
  std::set<Key> listed;
  for (const Index3 i : cells) {
    ASSERT_TRUE(listed.insert(key(i)).second) << "twice: " << to_text(i);
    ASSERT_LE(separation(a, b, i), 1e-8) << to_text(i) << " of " << a << " - " << b;
  }
  const Vec3 lower = a.cwiseMin(b);
  const Vec3 upper = a.cwiseMax(b);
  for (int z = int(std::floor(lower.z())) - 2; z <= int(std::ceil(upper.z())) + 1; ++z) {
    for (int y = int(std::floor(lower.y())) - 2; y <= int(std::ceil(upper.y())) + 1; ++y) {
      for (int x = int(std::floor(lower.x())) - 2; x <= int(std::ceil(upper.x())) + 1; ++x) {
        if (separation(a, b, {x, y, z}) > 0.0) continue;
        ASSERT_TRUE(listed.contains(key({x, y, z}))) << to_text(Index3{x, y, z}) << " is missed by "
                                                     << a.transpose() << " - " << b.transpose();
      }
    }
  }
}

Vec3 random_point(Random& random, double size) {
  return {random.uniform(0, size), random.uniform(0, size), random.uniform(0, size)};
}

Vec3 lattice_point(Random& random, int size, int steps) {  // multiples of 1 / steps
  return Vec3(random.below(size * steps + 1), random.below(size * steps + 1),
              random.below(size * steps + 1)) /
         steps;
}

TEST(Supercover, IsEveryCubeThatARandomSegmentMeets) {
  Random random(1);
  for (int n = 0; n < 1500; ++n) {
    expect_supercover(random_point(random, 8.0), random_point(random, 8.0));
    if (HasFatalFailure()) return;
  }
}

TEST(Supercover, IsEveryCubeThatASegmentBetweenCornersEdgesAndCentresMeets) {
  Random random(2);
  for (int n = 0; n < 3000; ++n) {
    const int steps = 1 + n % 4;  // corners; corners and centres; thirds; quarters
    expect_supercover(lattice_point(random, 5, steps), lattice_point(random, 5, steps));
    if (HasFatalFailure()) return;
  }
}

TEST(Supercover, IsEveryCubeThatAnAxisAlignedOrDiagonalSegmentMeets) {
  Random random(3);
  for (int n = 0; n < 1500; ++n) {
    const Vec3 a = n % 2 == 0 ? lattice_point(random, 5, 2) : random_point(random, 5.0);
    const Vec3 way(random.below(3) - 1, random.below(3) - 1, random.below(3) - 1);
    const double length = n % 3 == 0 ? 1.0 + random.below(5) : random.uniform(0.0, 5.0);
    expect_supercover(a, a + length * way);
    if (HasFatalFailure()) return;
  }
}

TEST(Supercover, HoldsForNegativeCoordinatesAndAlmostAxisAlignedSegments) {
  Random random(4);
  for (int n = 0; n < 1000; ++n) {
    const Vec3 a = random_point(random, 6.0) - Vec3::Constant(3.0);
    Vec3 b = a;
    b[n % 3] += random.uniform(-5.0, 5.0);
    b[(n + 1) % 3] += std::pow(10.0, -random.uniform(1.0, 17.0));
    expect_supercover(a, b);
    if (HasFatalFailure()) return;
  }
}

TEST(Supercover, OfAPointIsTheCubesThatShareIt) {
  EXPECT_EQ(supercover(Vec3(1.5, 2.5, 3.5), Vec3(1.5, 2.5, 3.5)), (std::vector<Index3>{{1, 2, 3}}));
  EXPECT_EQ(supercover(Vec3(1, 2.5, 3.5), Vec3(1, 2.5, 3.5)).size(), 2U);  // on a face
  EXPECT_EQ(supercover(Vec3(1, 2, 3.5), Vec3(1, 2, 3.5)).size(), 4U);      // on an edge
  EXPECT_EQ(supercover(Vec3(1, 2, 3), Vec3(1, 2, 3)).size(), 8U);          // on a corner
}

TEST(Supercover, CountsWhatTheSegmentOnlyTouches) {
  // Along an edge: four columns of cubes, and one layer beyond each end.
  EXPECT_EQ(supercover(Vec3(0, 0, 0), Vec3(3, 0, 0)).size(), 4U * 5U);
  // The space diagonal of a cube: itself, and seven more around each of its two corners.
  EXPECT_EQ(supercover(Vec3(0, 0, 0), Vec3(1, 1, 1)).size(), 15U);
  // The plane diagonal through the middle of a layer.
  EXPECT_EQ(supercover(Vec3(0.5, 0.5, 0.5), Vec3(1.5, 1.5, 0.5)).size(), 4U);
}

TEST(Supercover, GoesFromTheFirstPointToTheSecondAlongTheLongestAxis) {
  const auto there = supercover(Vec3(0.2, 0.3, 0.4), Vec3(9.7, 3.1, 2.2));
  EXPECT_TRUE(std::ranges::is_sorted(there, {}, &Index3::x));
  const auto back = supercover(Vec3(9.7, 3.1, 2.2), Vec3(0.2, 0.3, 0.4));
  EXPECT_TRUE(std::ranges::is_sorted(back, std::ranges::greater{}, &Index3::x));
  EXPECT_EQ(there.size(), back.size());
}

TEST(Supercover, ThrowsForWhatIsNotFinite) {
  EXPECT_THROW(supercover(Vec3(NAN, 0, 0), Vec3::Zero()), std::invalid_argument);
  EXPECT_THROW(supercover(Vec3::Zero(), Vec3(0, INFINITY, 0)), std::invalid_argument);
  EXPECT_THROW(supercover(Vec3::Zero(), Vec3(0, 1e300, 0)), std::invalid_argument);
}

BitGrid random_grid(Index3 size, bool outside, Random& random) {
  BitGrid grid(size, outside);
  for (int n = 0; n < 12; ++n) {
    grid.set({random.below(size.x), random.below(size.y), random.below(size.z)}, true);
  }
  return grid;
}

// nothing: too close to call (a cube within 1e-8 of the segment, but not met)
std::optional<bool> brute_force_free(const BitGrid& grid, const Vec3& a, const Vec3& b) {
  bool close = false;
  for (int z = -4; z <= grid.size().z + 3; ++z) {
    for (int y = -4; y <= grid.size().y + 3; ++y) {
      for (int x = -4; x <= grid.size().x + 3; ++x) {
        if (!grid.test({x, y, z})) continue;
        const double apart = separation(a, b, {x, y, z});
        if (apart <= 0.0) return false;
        close |= apart < 1e-8;
      }
    }
  }
  if (close) return {};
  return true;
}

TEST(LineIsFree, AgreesWithTheCubesThatTheSegmentMeets) {
  Random random(5);
  int free = 0;
  int blocked = 0;
  for (int n = 0; n < 3000; ++n) {
    const BitGrid grid = random_grid({9, 7, 5}, n % 2 == 0, random);
    const auto point = [&] {
      const Vec3 p = n % 3 == 0 ? lattice_point(random, 1, 24) : random_point(random, 1.0);
      return Vec3(p.cwiseProduct(Vec3(12, 10, 8)) - Vec3::Constant(n % 5 == 0 ? 1.5 : 0.0));
    };
    const Vec3 a = point();
    const Vec3 b = n % 7 == 0 ? a : point();
    const auto expected = brute_force_free(grid, a, b);
    if (!expected) continue;
    ASSERT_EQ(line_is_free(grid, a, b), *expected) << a.transpose() << " - " << b.transpose();
    ASSERT_EQ(line_is_free(grid, b, a), *expected) << b.transpose() << " - " << a.transpose();
    (*expected ? free : blocked) += 1;
  }
  EXPECT_GT(free, 300);
  EXPECT_GT(blocked, 300);
}

// Long ones, and ends on or next to the faces of the grid: the walk and the samples that
// line_is_free takes inside see what the supercover does.
TEST(LineIsFree, LooksAtTheSupercoverOfLongSegments) {
  Random random(6);
  int free = 0;
  for (int n = 0; n < 20000; ++n) {
    const Index3 size{60, 40, 20};
    BitGrid grid(size, true);
    for (int k = random.below(60); k > 0; --k) {
      grid.set({random.below(size.x), random.below(size.y), random.below(size.z)}, true);
    }
    const auto point = [&] {
      const Vec3 upper(size.x, size.y, size.z);
      if (n % 3 == 0) return Vec3(upper.cwiseProduct(random_point(random, 1.0)));
      Vec3 p(random.below(size.x), random.below(size.y), random.below(size.z));
      if (n % 3 == 1) return Vec3(p + Vec3::Constant(0.5));
      p[random.below(3)] += 1e-9 * random.uniform(0.5, 3.0);
      return Vec3(p.cwiseMin(upper - Vec3::Constant(1e-7)));
    };
    const Vec3 a = point(), b = point();
    bool expected = true;
    for (const Index3 i : supercover(a, b)) expected &= !grid.test(i);
    ASSERT_EQ(line_is_free(grid, a, b), expected) << a.transpose() << " - " << b.transpose();
    free += expected;
  }
  EXPECT_GT(free, 3000);
}

TEST(LineIsFree, IsBlockedByACubeThatIsOnlyTouched) {
  BitGrid grid({8, 8, 8}, true);
  grid.set({4, 4, 4}, true);
  EXPECT_FALSE(line_is_free(grid, Vec3(1, 4, 4.5), Vec3(7, 4, 4.5)));  // along a face
  EXPECT_FALSE(line_is_free(grid, Vec3(1, 4, 4), Vec3(7, 4, 4)));      // along an edge
  EXPECT_FALSE(line_is_free(grid, Vec3(3, 5, 3.5), Vec3(5, 3, 4.5)));  // across an edge
  EXPECT_FALSE(line_is_free(grid, Vec3(3, 5, 4), Vec3(5, 3, 4)));      // across a corner
  EXPECT_FALSE(line_is_free(grid, Vec3(1, 4, 4.5), Vec3(4, 4, 4.5)));  // ends on it
  EXPECT_TRUE(line_is_free(grid, Vec3(1, 3.999, 4.5), Vec3(7, 3.999, 4.5)));
  EXPECT_TRUE(line_is_free(grid, Vec3(1, 4.5, 4.5), Vec3(3.999, 4.5, 4.5)));
}

TEST(LineIsFree, TakesTheOutsideAsTheGridDoes) {
  const BitGrid closed({8, 8, 8}, true);
  const BitGrid open({8, 8, 8}, false);
  const Vec3 inside(4, 4, 4);
  for (const Vec3& out : {Vec3(9, 4, 4), Vec3(4, -1, 4), Vec3(4, 4, 8), Vec3(0, 4, 4)}) {
    EXPECT_FALSE(line_is_free(closed, inside, out));
    EXPECT_FALSE(line_is_free(closed, out, inside));
    EXPECT_TRUE(line_is_free(open, inside, out));
    EXPECT_TRUE(line_is_free(open, out, inside));
  }
  EXPECT_FALSE(line_is_free(BitGrid(), inside, inside));
}

TEST(LineIsFree, NeverCallsFreeWhatIsNotFinite) {
  for (const bool outside : {false, true}) {
    const BitGrid grid({8, 8, 8}, outside);
    for (const double bad : {double(NAN), double(INFINITY), -double(INFINITY)}) {
      for (int axis = 0; axis < 3; ++axis) {
        Vec3 p(4, 4, 4);
        p[axis] = bad;
        EXPECT_FALSE(line_is_free(grid, p, Vec3(4, 4, 4)));
        EXPECT_FALSE(line_is_free(grid, Vec3(4, 4, 4), p));
        EXPECT_FALSE(line_is_free(grid, p, p));
      }
    }
  }
}

TEST(LineIsFree, AnswersForHugeSegments) {
  BitGrid open({8, 8, 8}, false);
  EXPECT_TRUE(line_is_free(open, Vec3(4.5, 4.5, -1e9), Vec3(4.5, 4.5, 1e9)));
  EXPECT_TRUE(line_is_free(open, Vec3(-1e300, 4.5, 4.5), Vec3(1e300, 4.5, 4.5)));
  open.set({4, 4, 4}, true);
  EXPECT_FALSE(line_is_free(open, Vec3(4.5, 4.5, -1e9), Vec3(4.5, 4.5, 1e9)));
  EXPECT_FALSE(line_is_free(BitGrid({8, 8, 8}, true), Vec3(4, 4, 4), Vec3(4, 4, 1e300)));
}

TEST(LineIsFree, MapCoordinatesAreVoxelCoordinatesScaledAndShifted) {
  VoxelGrid grid;
  grid.geometry = {Vec3(-1.0, 2.0, 0.5), 0.2, {10, 8, 6}};
  grid.grown = BitGrid(grid.geometry.size, true);
  grid.grown.set({5, 4, 3}, true);
  const auto center = [&](int x, int y, int z) { return grid.geometry.center({x, y, z}); };
  EXPECT_FALSE(line_is_free(grid, center(1, 4, 3), center(8, 4, 3)));
  EXPECT_TRUE(line_is_free(grid, center(1, 4, 3), center(4, 4, 3)));
  EXPECT_TRUE(line_is_free(grid, center(1, 3, 3), center(8, 3, 3)));
  EXPECT_FALSE(line_is_free(grid, center(1, 3, 3), Vec3(10, 10, 10)));
}

}  // namespace
}  // namespace goshawk
