#include "ray_scan.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <set>
#include <tuple>
#include <vector>

#include "goshawk/core/random.hpp"
#include "scan_support.hpp"

namespace goshawk::map_server {
namespace {

using Voxel = std::tuple<int, int, int>;
using Voxels = std::set<Voxel>;

struct Seen {
  Voxels missed, hit;
};

Seen seen_of(RayScan& scan) {
  Seen seen;
  scan.for_lines(
      [&](Index3 brick, int first_row, const RayScan::Word* missed, const RayScan::Word* hit) {
        for (int k = 0; k < RayScan::kLine; ++k) {
          const int row = first_row + k;
          for (int x = 0; x < 64; ++x) {
            const Voxel voxel{64 * brick.x + x, 8 * brick.y + row % 8, 8 * brick.z + row / 8};
            const bool twice = ((missed[k] >> x & 1U) != 0 && !seen.missed.insert(voxel).second) ||
                               ((hit[k] >> x & 1U) != 0 && !seen.hit.insert(voxel).second);
            EXPECT_FALSE(twice);
          }
        }
      });
  return seen;
}

Voxel voxel_at(const Vec3& p) {
  return {int(std::floor(p.x())), int(std::floor(p.y())), int(std::floor(p.z()))};
}

// Every voxel of the box against the ray, cube by cube: the truth, but where a ray only touches.
void expect_ray(const Seen& seen, const Vec3& from, const Vec3& to, bool hits, Index3 lower,
                Index3 upper) {
  const Voxel end = voxel_at(to);
  const double length = (to - from).norm();
  for (int z = lower.z; z < upper.z; ++z) {
    for (int y = lower.y; y < upper.y; ++y) {
      for (int x = lower.x; x < upper.x; ++x) {
        const Voxel voxel{x, y, z};
        const bool missed = seen.missed.contains(voxel);
        EXPECT_EQ(seen.hit.contains(voxel), hits && voxel == end);
        if (voxel == end) {
          EXPECT_FALSE(missed);
          continue;
        }
        const Vec3 corner(x, y, z);
        if (testing::share_inside(from, to, corner, -1e-9) * length > 1e-8) {
          EXPECT_TRUE(missed) << x << ' ' << y << ' ' << z;
        } else if (testing::share_inside(from, to, corner, 1e-8) < 0.0) {
          EXPECT_FALSE(missed) << x << ' ' << y << ' ' << z;
        }
      }
    }
  }
}

Vec3 place(Random& random, double low, double high, bool on_raster) {
  Vec3 p(random.uniform(low, high), random.uniform(low, high), random.uniform(low, high));
  if (on_raster) p = (2.0 * p).array().round().matrix() / 2.0;
  return p;
}

// Inside of a box, from outside, through, past; on the raster of faces and edges too.
void expect_rays(Index3 lower_brick, Index3 counts, const Vec3& way, int rounds, Random& random) {
  const Index3 lower{64 * lower_brick.x, 8 * lower_brick.y, 8 * lower_brick.z};
  const Index3 upper = lower + Index3{64 * counts.x, 8 * counts.y, 8 * counts.z};
  const Vec3 middle = 0.5 * Vec3(lower.x + upper.x, lower.y + upper.y, lower.z + upper.z);
  RayScan scan;
  for (int round = 0; round < rounds; ++round) {
    const bool on_raster = round % 4 == 0;
    const double spread = round % 3 == 0 ? 40.0 : 7.9;
    const Vec3 from = middle + place(random, -spread, spread, on_raster);
    Vec3 to = middle + place(random, -spread, spread, on_raster);
    if (round % 5 == 0) to[round / 5 % 3] = from[round / 5 % 3];
    if (round % 7 == 0) to = from + random.uniform(-60.0, 60.0) * way;
    const bool hits = random.chance(0.5);
    scan.begin(lower_brick, counts);
    scan.cast(from, to, hits, nullptr);
    expect_ray(seen_of(scan), from, to, hits, lower, upper);
  }
}

TEST(RayScan, MeetsTheVoxelsThatABruteForceCasterMeets) {
  Random random(3);
  expect_rays({1, 1, 0}, {2, 2, 2}, Vec3(1.0, 0.05, -0.1), 400, random);
  expect_rays({0, 2, 1}, {1, 17, 1}, Vec3(-0.05, 1.0, 0.1), 120, random);  // words along y too
}

TEST(RayScan, AScanIsTheUnionOfItsRaysAndBeginForgetsTheOneBefore) {
  Random random(4);
  RayScan all, single;
  for (int round = 0; round < 5; ++round) {
    const Index3 counts{1 + random.below(3), 1 + random.below(3), 1 + random.below(3)};
    all.begin({}, counts);
    Seen expected;
    for (int ray = 0; ray < 60; ++ray) {
      const Vec3 from = place(random, -4.0, 30.0, false), to = place(random, -4.0, 30.0, false);
      all.cast(from, to, ray % 2 == 0, nullptr);
      single.begin({}, counts);
      single.cast(from, to, ray % 2 == 0, nullptr);
      expected.missed.merge(seen_of(single).missed);
      expected.hit.merge(seen_of(single).hit);
    }
    const Seen seen = seen_of(all);
    EXPECT_EQ(seen.missed, expected.missed);
    EXPECT_EQ(seen.hit, expected.hit);
  }
}

TEST(RayScan, RaysThatAreAlmostStraightOrFarAwayStayInsideTheBox) {
  RayScan scan;
  scan.begin({}, {1, 1, 1});
  for (const double tiny : {0.0, 1e-300, 1e-12, 1e-7, -1e-7, -1e-12}) {
    for (const double far : {5.0, 1e3, 1e6, 5e8}) {
      scan.cast(Vec3(2.0, 3.0, 4.0), Vec3(2.0 + far, 3.0 + tiny, 4.0 - tiny), true, nullptr);
      scan.cast(Vec3(2.0 - far, 3.0, 4.0), Vec3(2.5, 3.0 + tiny, 4.0 + tiny), false, nullptr);
    }
  }
  for (const Voxel& voxel : seen_of(scan).missed) {
    EXPECT_GE(std::get<1>(voxel), 2);
    EXPECT_LE(std::get<1>(voxel), 3);
    EXPECT_GE(std::get<2>(voxel), 3);
    EXPECT_LE(std::get<2>(voxel), 4);
  }
  EXPECT_TRUE(seen_of(scan).missed.contains({63, 3, 4}));
}

// A floor of one layer, known as such, and a sensor just above it.
BrickMap floor_map() {
  BrickMap map = BrickMap::make({64, 24, 16}, {}).value();
  for (int y = 0; y < 3; ++y) {
    for (int row = 0; row < 8; ++row)
      map.write({0, y, 0}, row + 16, ~std::uint64_t{0}, ~std::uint64_t{0});
  }
  return map;
}

TEST(RayScan, AGrazedFloorIsNotPassedThrough) {
  const BrickMap map = floor_map();  // z = 2
  RayScan scan;
  const Vec3 from(2.5, 12.5, 5.0), to(50.5, 12.7, 2.5);
  scan.begin({}, map.counts());
  scan.cast(from, to, true, nullptr);
  const Seen eaten = seen_of(scan);
  EXPECT_TRUE(eaten.missed.contains({45, 12, 2}));
  scan.begin({}, map.counts());
  scan.cast(from, to, true, &map);
  const Seen kept = seen_of(scan);
  for (const Voxel& voxel : kept.missed) EXPECT_NE(std::get<2>(voxel), 2);
  for (const Voxel& voxel : eaten.missed) {
    EXPECT_TRUE(std::get<2>(voxel) == 2 || kept.missed.contains(voxel));
  }
  EXPECT_EQ(kept.hit, eaten.hit);
}

TEST(RayScan, AFloorThatARayDoesNotEndInIsPassedThrough) {
  const BrickMap map = floor_map();
  RayScan scan;
  scan.begin({}, map.counts());
  scan.cast(Vec3(2.5, 12.5, 5.0), Vec3(30.5, 12.5, 0.5), true, &map);  // through it
  const Seen seen = seen_of(scan);
  EXPECT_TRUE(seen.missed.contains({20, 12, 2}) || seen.missed.contains({19, 12, 2}));
}

TEST(RayScan, AThingInFrontOfAWallIsPassedThroughWhenItHasLeft) {
  // A wall at x = 40, and the ghost of a pole that stood before it.
  BrickMap map = BrickMap::make({64, 24, 16}, {}).value();
  for (int z = 0; z < 16; ++z) {
    for (int y = 0; y < 24; ++y) {
      const bool pole = y >= 11 && y <= 13;
      const std::uint64_t wall = std::uint64_t{1} << 40;
      const std::uint64_t ghost = pole ? std::uint64_t{7} << 37 : 0;
      map.write({0, y / 8, z / 8}, 8 * (z % 8) + y % 8, wall | ghost, ~std::uint64_t{0});
    }
  }
  RayScan scan;
  scan.begin({}, map.counts());
  for (double y = 8.05; y < 17.0; y += 0.1) {
    for (double z = 4.05; z < 12.0; z += 0.1) {
      scan.cast(Vec3(2.5, 12.5, 8.5), Vec3(40.5, y, z), true, &map);
    }
  }
  const Seen seen = seen_of(scan);
  for (int y = 11; y <= 13; ++y) {
    for (int x = 37; x < 40; ++x) EXPECT_TRUE(seen.missed.contains({x, y, 8})) << x << ' ' << y;
  }
}

// Every word of a scan, by its place: for scans that are too large for sets of voxels.
std::vector<std::uint64_t> words_of(RayScan& scan) {
  std::vector<std::uint64_t> words;
  scan.for_lines(
      [&](Index3 brick, int first_row, const RayScan::Word* missed, const RayScan::Word* hit) {
        words.push_back((std::uint64_t(brick.x) << 40) + (std::uint64_t(brick.y) << 24) +
                        (std::uint64_t(brick.z) << 8) + std::uint64_t(first_row));
        words.insert(words.end(), missed, missed + RayScan::kLine);
        words.insert(words.end(), hit, hit + RayScan::kLine);
      });
  return words;
}

TEST(RayScan, RaysThatAreWalkedTogetherSetTheBitsThatTheySetOneByOne) {
  Random random(5);
  const BrickMap map = floor_map();
  RayScan together, alone(RayScan::Walking::one_by_one);
  for (const int rays : {1, 3, 4, 5, 700, 20000}) {
    const Index3 counts{3, 20, 6};
    together.begin({-1, 0, 0}, counts);
    alone.begin({-1, 0, 0}, counts);
    const Vec3 origin(20.3, 77.7, 21.1);  // most rays begin and end inside of the box
    for (int k = 0; k < rays; ++k) {
      const bool on_raster = k % 11 == 0;
      const Vec3 from = k % 5 == 0 ? place(random, -10.0, 60.0, on_raster) : origin;
      Vec3 to = origin + place(random, -75.0, 75.0, on_raster);
      if (k % 3 == 0) to.z() = from.z();
      if (k % 7 == 0) to.x() = from.x();
      const bool hits = k % 2 == 0;
      const BrickMap* held = k % 4 == 0 ? &map : nullptr;
      together.cast(from, to, hits, held);
      alone.cast(from, to, hits, held);
    }
    const auto words = words_of(together);
    EXPECT_FALSE(words.empty());
    EXPECT_EQ(words, words_of(alone)) << rays;
  }
}

TEST(RayScan, AScanThatWasNotReadIsForgottenByBegin) {
  RayScan scan;
  scan.begin({}, {1, 1, 1});
  scan.cast(Vec3(1.5, 1.5, 1.5), Vec3(60.5, 6.5, 6.5), true, nullptr);
  scan.begin({}, {1, 1, 1});
  EXPECT_TRUE(words_of(scan).empty());
}

}  // namespace
}  // namespace goshawk::map_server
