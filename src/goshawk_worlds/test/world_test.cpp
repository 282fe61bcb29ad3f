#include "goshawk/worlds/world.hpp"

#include <gmock/gmock.h>

#include <cstdlib>
#include <limits>
#include <vector>

#include "goshawk/core/inflation.hpp"

namespace goshawk::worlds {
namespace {

// FNV-1a over the words, byte by byte from the lowest: one number for one world.
std::uint64_t fingerprint(const BitGrid& grid) {
  std::uint64_t hash = 0xCBF29CE484222325ULL;
  for (BitGrid::Word word : grid.to_words()) {
    for (int byte = 0; byte < 8; ++byte, word >>= 8) {
      hash = (hash ^ (word & 0xFF)) * 0x100000001B3ULL;
    }
  }
  return hash;
}

// Grows by the definition: every pair of cubes, no shared code with goshawk::inflate.
std::int64_t count_blocked_by_definition(const World& world, double radius_m) {
  const Index3 n = world.geometry.size;
  const double r = radius_m / world.geometry.resolution_m;
  const int reach = int(r) + 1;
  const auto gap = [](int k) { return double(std::max(0, std::abs(k) - 1)); };
  std::int64_t blocked = 0;
  for (int z = 0; z < n.z; ++z) {
    for (int y = 0; y < n.y; ++y) {
      for (int x = 0; x < n.x; ++x) {
        bool hit = false;
        for (int k = -reach; k <= reach && !hit; ++k) {
          for (int j = -reach; j <= reach && !hit; ++j) {
            for (int i = -reach; i <= reach && !hit; ++i) {
              const Index3 other{x + i, y + j, z + k};
              const double d2 = gap(i) * gap(i) + gap(j) * gap(j) + gap(k) * gap(k);
              hit =
                  d2 < r * r - 1e-9 && world.occupied.contains(other) && world.occupied.get(other);
            }
          }
        }
        blocked += hit ? 1 : 0;
      }
    }
  }
  return blocked;
}

// The voxels that face-to-face steps reach from `from`.
BitGrid reachable(const BitGrid& blocked, Index3 from) {
  BitGrid seen(blocked.size(), false);
  std::vector<Index3> open{from};
  seen.set(from, true);
  while (!open.empty()) {
    const Index3 at = open.back();
    open.pop_back();
    for (const Index3 step :
         {Index3{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}}) {
      const Index3 next = at + step;
      if (!seen.contains(next) || blocked.get(next) || seen.get(next)) continue;
      seen.set(next, true);
      open.push_back(next);
    }
  }
  return seen;
}

WorldSpec spec_of(const std::string& kind, double density, std::uint64_t seed) {
  WorldSpec spec = default_world();
  spec.kind = kind;
  spec.density = density;
  spec.seed = seed;
  return spec;
}

TEST(World, SameSpecGivesTheSameWorldAndAnotherSeedAnother) {
  for (const std::string& kind : world_kinds()) {
    const World a = make_world(spec_of(kind, 0.3, 7)).value();
    const World b = make_world(spec_of(kind, 0.3, 7)).value();
    const World c = make_world(spec_of(kind, 0.3, 8)).value();
    EXPECT_EQ(a.occupied, b.occupied) << kind;
    EXPECT_FALSE(a.occupied == c.occupied) << kind;
  }
}

// The bytes of a world are an interface: benchmarks name a spec, not a file.
TEST(World, BytesNeverChange) {
  EXPECT_EQ(fingerprint(make_world(spec_of("noise", 0.1, 1)).value().occupied),
            15951441774513777870ULL);
  EXPECT_EQ(fingerprint(make_world(spec_of("boxes", 0.4, 1)).value().occupied),
            17992939061100410695ULL);
  EXPECT_EQ(fingerprint(make_world(spec_of("boxes", 0.1, 42)).value().occupied),
            8472406293252374757ULL);
  EXPECT_EQ(fingerprint(make_world(spec_of("forest", 0.3, 1)).value().occupied),
            3482057018376969354ULL);
  EXPECT_EQ(fingerprint(make_world(spec_of("office", 0.4, 1)).value().occupied),
            2079729182464795195ULL);
}

TEST(World, DefaultWorldIsThePaddedBoxOfTheThesis) {
  const World world = make_world(default_world()).value();
  EXPECT_EQ(world.geometry.size, (Index3{30, 44, 20}));
  EXPECT_TRUE(world.geometry.origin_map.isApprox(Vec3(0.0, -0.4, 0.0)));
  EXPECT_TRUE(world.geometry.upper_corner_map().isApprox(Vec3(6.0, 8.4, 4.0)));
  EXPECT_TRUE(world.occupied.outside());
}

TEST(World, BlockedShareOfTheGrownMapIsTheDensity) {
  for (const std::string kind : {"boxes", "forest"}) {
    for (const double density : {0.0, 0.1, 0.25, 0.4, 0.6}) {
      const World world = make_world(spec_of(kind, density, 3)).value();
      const double share =
          double(count_blocked_by_definition(world, 0.2)) / double(world.occupied.voxels());
      EXPECT_NEAR(share, density, kDensityTolerance) << kind;
    }
  }
}

TEST(World, OfficeIsFurnishedToTheDensityOrHasNoFurniture) {
  WorldSpec spec = spec_of("office", 0.0, 4);
  spec.keep_free.clear();
  const World walls = make_world(spec).value();
  const double walls_share =
      double(count_blocked_by_definition(walls, 0.2)) / double(walls.occupied.voxels());
  spec.density = walls_share + 0.1;
  const World furnished = make_world(spec).value();
  EXPECT_NEAR(
      double(count_blocked_by_definition(furnished, 0.2)) / double(furnished.occupied.voxels()),
      spec.density, kDensityTolerance);
  EXPECT_GT(furnished.occupied.count(), walls.occupied.count());
}

TEST(World, NoiseOccupiesTheShareOfVoxels) {
  WorldSpec spec = spec_of("noise", 0.3, 5);
  spec.keep_free.clear();
  const World world = make_world(spec).value();
  // Five standard deviations of a binomial of 26 400 draws.
  EXPECT_NEAR(double(world.occupied.count()) / double(world.occupied.voxels()), 0.3, 0.0142);
}

TEST(World, KeptPointsAreFreeAfterGrowthInEveryVoxelThatHoldsThem) {
  for (const std::string& kind : world_kinds()) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      const World world = make_world(spec_of(kind, 0.35, seed)).value();
      const BitGrid grown = inflate(world.occupied, 0.2, 0.2).value();
      for (const Vec3& p : default_world().keep_free) {
        for (int corner = 0; corner < 8; ++corner) {
          const Vec3 side(corner & 1 ? 1e-4 : -1e-4, corner & 2 ? 1e-4 : -1e-4,
                          corner & 4 ? 1e-4 : -1e-4);
          const auto voxel = world.geometry.index_of(p + side);
          ASSERT_TRUE(voxel);
          EXPECT_FALSE(grown.get(*voxel)) << kind << " seed " << seed;
        }
      }
    }
  }
}

TEST(World, MostDefaultWorldsHaveAWay) {
  int with_a_way = 0;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    WorldSpec spec = default_world();
    spec.seed = seed;
    const World world = make_world(spec).value();
    const BitGrid grown = inflate(world.occupied, 0.2, 0.2).value();
    const BitGrid seen = reachable(grown, *world.geometry.index_of(spec.keep_free[0]));
    with_a_way += seen.get(*world.geometry.index_of(spec.keep_free[1])) ? 1 : 0;
  }
  RecordProperty("with_a_way_of_100", with_a_way);
  EXPECT_GE(with_a_way, 80);
}

TEST(World, EveryRoomOfAnOfficeCanBeReached) {
  for (std::uint64_t seed = 0; seed < 30; ++seed) {
    WorldSpec spec = spec_of("office", 0.0, seed);
    spec.size_m = Vec3(14.0, 10.0, 3.0);
    spec.keep_free.clear();
    const World world = make_world(spec).value();
    const BitGrid grown = inflate(world.occupied, 0.2, 0.2).value();
    // At half a metre there are only floor, walls and doors: all of the floor is one piece.
    const int z = 2;
    std::int64_t floor_voxels = 0;
    std::int64_t reached = 0;
    BitGrid seen;
    for (int y = 0; y < grown.size().y; ++y) {
      for (int x = 0; x < grown.size().x; ++x) {
        if (grown.get({x, y, z})) continue;
        if (seen.empty()) seen = reachable(grown, {x, y, z});
        ++floor_voxels;
        reached += seen.get({x, y, z}) ? 1 : 0;
      }
    }
    EXPECT_GT(floor_voxels, 1000);
    EXPECT_EQ(reached, floor_voxels) << "seed " << seed;
  }
}

TEST(World, BadSpecsAreRefusedWithASentence) {
  const auto refuse = [](auto&& spoil, ErrorCode code) {
    WorldSpec spec = default_world();
    spoil(spec);
    const auto world = make_world(spec);
    ASSERT_EQ(world.code(), code);
    EXPECT_GT(world.error().message.size(), 20U);
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  using S = WorldSpec;
  refuse([](S& s) { s.kind = "ocean"; }, ErrorCode::invalid_parameter);
  refuse([&](S& s) { s.size_m.x() = nan; }, ErrorCode::invalid_parameter);
  refuse([&](S& s) { s.size_m.y() = inf; }, ErrorCode::invalid_parameter);
  refuse([](S& s) { s.size_m.z() = 0.0; }, ErrorCode::invalid_parameter);
  refuse([](S& s) { s.size_m.z() = -1.0; }, ErrorCode::invalid_parameter);
  refuse([](S& s) { s.resolution_m = 0.0; }, ErrorCode::invalid_parameter);
  refuse([](S& s) { s.resolution_m = 1e-9; }, ErrorCode::map_too_large);
  refuse([](S& s) { s.size_m = Vec3(1e4, 1e4, 1e4); }, ErrorCode::map_too_large);
  refuse([&](S& s) { s.density = nan; }, ErrorCode::invalid_parameter);
  refuse([](S& s) { s.density = 1.0; }, ErrorCode::invalid_parameter);
  refuse([](S& s) { s.density = -0.1; }, ErrorCode::invalid_parameter);
  refuse([&](S& s) { s.origin_m.x() = nan; }, ErrorCode::invalid_parameter);
  refuse([](S& s) { s.inflation_m = -0.1; }, ErrorCode::invalid_parameter);
  refuse([](S& s) { s.keep_free.push_back(Vec3(99, 0, 0)); }, ErrorCode::invalid_input);
  refuse([&](S& s) { s.keep_free.push_back(Vec3(nan, 0, 0)); }, ErrorCode::invalid_input);
  refuse(
      [](S& s) {
        s.kind = "office";
        s.size_m.x() = 3.0;
        s.keep_free.clear();
      },
      ErrorCode::invalid_parameter);
  // One voxel cannot be 0.4 blocked.
  refuse(
      [](S& s) {
        s.size_m = Vec3(0.2, 0.2, 0.2);
        s.keep_free.clear();
      },
      ErrorCode::invalid_parameter);
}

TEST(World, AnInflationFarLargerThanTheWorldEndsInASentence) {
  WorldSpec spec = default_world();
  spec.inflation_m = 1e9;
  EXPECT_EQ(make_world(spec).code(), ErrorCode::invalid_parameter);
}

}  // namespace
}  // namespace goshawk::worlds
