#include "goshawk/core/brick_map.hpp"

#include <gtest/gtest.h>

#include <map>
#include <stdexcept>
#include <tuple>

#include "goshawk/core/inflation.hpp"
#include "goshawk/core/random.hpp"

namespace goshawk {
namespace {

// What the map must be, kept voxel by voxel on a raster that does not move.
class PlainWorld {
 public:
  enum class State { unknown, free, occupied };
  State at(Index3 i) const {
    const auto found = states_.find({i.x, i.y, i.z});
    return found == states_.end() ? State::unknown : found->second;
  }
  void set(Index3 i, State state) { states_[{i.x, i.y, i.z}] = state; }

 private:
  std::map<std::tuple<int, int, int>, State> states_;
};

struct Dense {
  BitGrid grown, known, raw;
};

Dense dense_of(const BrickMap& map) {
  Dense d{BitGrid(map.size(), true, map.default_grown()), BitGrid(map.size(), false),
          BitGrid(map.size(), true)};
  map.write_dense(d.grown, d.known, d.raw);
  return d;
}

// The window at `lower` of the world, grown anew as a whole.
Dense anew(const PlainWorld& world, Index3 lower, Index3 size, const BrickGrowth& growth) {
  Dense d{BitGrid(size, true), BitGrid(size, false), BitGrid(size, true)};
  BitGrid growing(size, true);
  for (int z = 0; z < size.z; ++z) {
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x) {
        const auto state = world.at(lower + Index3{x, y, z});
        const bool raw = state == PlainWorld::State::occupied;
        const bool known = state != PlainWorld::State::unknown;
        d.raw.set({x, y, z}, raw);
        d.known.set({x, y, z}, known);
        growing.set({x, y, z}, raw || (growth.unknown_grows && !known));
      }
    }
  }
  d.grown = inflate(growing, growth.inflation_m, growth.resolution_m).value();
  for (int z = 0; z < size.z; ++z) {
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x) {
        if (growth.unknown_is_occupied && !d.known.get({x, y, z})) d.grown.set({x, y, z}, true);
      }
    }
  }
  return d;
}

void expect_same(const Dense& a, const Dense& b) {
  EXPECT_EQ(a.raw, b.raw);
  EXPECT_EQ(a.known, b.known);
  EXPECT_EQ(a.grown, b.grown);
}

// Writes a voxel of the world into the map whose window begins at `lower`.
void write(BrickMap& map, PlainWorld& world, Index3 lower, Index3 voxel, PlainWorld::State state) {
  world.set(lower + voxel, state);
  const Index3 brick{voxel.x >> 6, voxel.y >> 3, voxel.z >> 3};
  const int row = 8 * (voxel.z & 7) + (voxel.y & 7);
  const auto* held = map.find(brick);
  const BrickMap::Word bit = BrickMap::Word{1} << (voxel.x & 63);
  BrickMap::Word raw = held != nullptr ? held->raw[std::size_t(row)] : 0;
  BrickMap::Word known = held != nullptr ? held->known[std::size_t(row)] : 0;
  raw = state == PlainWorld::State::occupied ? raw | bit : raw & ~bit;
  known = state == PlainWorld::State::unknown ? known & ~bit : known | bit;
  map.write(brick, row, raw, known);
}

BrickGrowth growth_of(int policy, double inflation_m) {
  return {inflation_m, 0.2, policy != 2, policy == 0};
}

void write_some(BrickMap& map, PlainWorld& world, Index3 lower, int boxes, Random& random) {
  const Index3 n = map.size();
  for (int i = 0; i < boxes; ++i) {
    const auto state = PlainWorld::State(random.below(3));
    const Index3 from{random.below(n.x), random.below(n.y), random.below(n.z)};
    const Index3 side{1 + random.below(9), 1 + random.below(4), 1 + random.below(4)};
    for (int z = from.z; z < std::min(n.z, from.z + side.z); ++z) {
      for (int y = from.y; y < std::min(n.y, from.y + side.y); ++y) {
        for (int x = from.x; x < std::min(n.x, from.x + side.x); ++x) {
          write(map, world, lower, {x, y, z}, state);
        }
      }
    }
  }
}

TEST(BrickMap, GrownBitsAreThoseOfGrowingTheWholeWindowAnew) {
  Random random(5);
  for (int round = 0; round < 30; ++round) {
    const Index3 size{1 + random.below(150), 1 + random.below(30), 1 + random.below(20)};
    const double inflation_m = round % 5 == 0 ? 0.0 : random.uniform(0.0, 1.4);
    const BrickGrowth growth = growth_of(round % 3, inflation_m);
    BrickMap map = BrickMap::make(size, growth).value();
    PlainWorld world;
    for (int step = 0; step < 4; ++step) {
      write_some(map, world, {}, 12, random);
      map.regrow();
      const Dense dense = dense_of(map);
      expect_same(dense, anew(world, {}, size, growth));
      EXPECT_EQ(map.any_free(), dense.grown.count() < dense.grown.voxels());
    }
  }
}

TEST(BrickMap, AGrowthWiderThanABrickIsExactToo) {
  Random random(6);
  const Index3 size{200, 12, 5};
  for (int policy = 0; policy < 3; ++policy) {
    const BrickGrowth growth = growth_of(policy, 14.0);  // 70 voxels
    BrickMap map = BrickMap::make(size, growth).value();
    PlainWorld world;
    for (int x = 0; x < size.x; ++x) {
      for (int y = 0; y < size.y; ++y) {
        for (int z = 0; z < size.z; ++z) {
          write(map, world, {}, {x, y, z}, PlainWorld::State::free);
        }
      }
    }
    write(map, world, {}, {3, 2, 1}, PlainWorld::State::occupied);
    map.regrow();
    expect_same(dense_of(map), anew(world, {}, size, growth));
    EXPECT_LT(dense_of(map).grown.count(), size.x * size.y * size.z);
  }
}

TEST(BrickMap, ChangedBricksBringASubscriberUpToDate) {
  Random random(7);
  const Index3 size{130, 20, 17};
  for (int policy = 0; policy < 3; ++policy) {
    const BrickGrowth growth = growth_of(policy, 0.5);
    BrickMap map = BrickMap::make(size, growth).value();
    const auto view = [&] {
      Dense d = dense_of(map);
      return VoxelGrid{.geometry = {Vec3::Zero(), 0.2, size},
                       .grown = std::move(d.grown),
                       .known = std::move(d.known),
                       .raw = std::move(d.raw)};
    };
    VoxelGrid subscriber = view();
    PlainWorld world;
    for (int step = 0; step < 10; ++step) {
      write_some(map, world, {}, 3, random);
      GridUpdate update;
      for (const Index3 index : map.regrow()) {
        update.bricks.push_back(map.brick(index));
        EXPECT_FALSE(brick_of(subscriber, index) == update.bricks.back());
      }
      ASSERT_TRUE(apply(subscriber, update));
      const VoxelGrid now = view();
      EXPECT_EQ(subscriber.grown, now.grown);
      EXPECT_EQ(subscriber.known, now.known);
      EXPECT_EQ(subscriber.raw, now.raw);
    }
    EXPECT_TRUE(map.regrow().empty());
  }
}

// The part of the world that lies in a window: what left it is forgotten.
void forget_outside(PlainWorld& world, Index3 lower, Index3 size) {
  PlainWorld kept;
  for (int z = 0; z < size.z; ++z) {
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x) {
        const Index3 at = lower + Index3{x, y, z};
        if (world.at(at) != PlainWorld::State::unknown) kept.set(at, world.at(at));
      }
    }
  }
  world = kept;
}

TEST(BrickMap, AWindowThatMovesIsThatOfGrowingAnewAndUpdatesSubscribers) {
  Random random(8);
  const Index3 size{192, 24, 16};
  for (int round = 0; round < 12; ++round) {
    const BrickGrowth growth = growth_of(round % 3, random.uniform(0.1, 2.0));
    BrickMap map = BrickMap::make(size, growth).value();
    PlainWorld world;
    VoxelGrid subscriber{.geometry = {Vec3::Zero(), 0.2, size},
                         .grown = dense_of(map).grown,
                         .known = dense_of(map).known,
                         .raw = dense_of(map).raw,
                         .unknown_is_occupied = growth.unknown_is_occupied};
    Index3 lower;
    for (int step = 0; step < 5; ++step) {
      write_some(map, world, lower, 20, random);
      const Index3 by{random.below(5) - 2, random.below(5) - 2, random.below(3) - 1};
      map.shift(by, [&](Index3 brick, const BrickMap::Bits&) {
        const Index3 to = brick - by;
        EXPECT_TRUE(to.x < 0 || to.y < 0 || to.z < 0 || to.x >= 3 || to.y >= 3 || to.z >= 2);
      });
      lower = lower + Index3{64 * by.x, 8 * by.y, 8 * by.z};
      forget_outside(world, lower, size);
      GridUpdate update;
      update.shift = by;
      for (const Index3 index : map.regrow()) update.bricks.push_back(map.brick(index));
      ASSERT_TRUE(apply(subscriber, update));
      const Dense now = dense_of(map);
      expect_same(now, anew(world, lower, size, growth));
      expect_same(now, {subscriber.grown, subscriber.known, subscriber.raw});
    }
  }
}

// Nothing that was measured is lost: what leaves is handed over with the bits that it had.
TEST(BrickMap, WhatLeavesTheWindowIsHandedOverWholeWheneverItMoves) {
  Random random(9);
  const Index3 size{192, 24, 16};
  const BrickGrowth growth = growth_of(1, 0.6);
  BrickMap map = BrickMap::make(size, growth).value();
  PlainWorld world;
  Index3 lower;
  std::size_t left = 0;
  for (int step = 0; step < 40; ++step) {
    if (random.chance(0.7)) write_some(map, world, lower, 6, random);
    if (random.chance(0.3)) map.regrow();
    const Index3 by{random.below(3) - 1, random.below(3) - 1, random.below(3) - 1};
    map.shift(by, [&](Index3 brick, const BrickMap::Bits& bits) {
      ++left;
      for (int k = 0; k < 64 * 8 * 8; ++k) {
        const Index3 in{k % 64, k / 64 % 8, k / 512};
        const auto row = std::size_t(8 * in.z + in.y);
        const auto state =
            world.at(lower + Index3{64 * brick.x + in.x, 8 * brick.y + in.y, 8 * brick.z + in.z});
        const bool raw = bits.raw[row] >> in.x & 1U, known = bits.known[row] >> in.x & 1U;
        ASSERT_EQ(known, state != PlainWorld::State::unknown);
        ASSERT_EQ(raw, state == PlainWorld::State::occupied);
      }
    });
    lower = lower + Index3{64 * by.x, 8 * by.y, 8 * by.z};
    forget_outside(world, lower, size);
  }
  EXPECT_GT(left, 20U);
}

// Writes, moves and growths in any order, some of them several times in a row.
TEST(BrickMap, InAnyOrderOfWhatIsDoneItIsTheWindowGrownAnew) {
  Random random(10);
  const Index3 size{128, 16, 16};
  for (int round = 0; round < 9; ++round) {
    const BrickGrowth growth = growth_of(round % 3, random.uniform(0.0, 1.0));
    BrickMap map = BrickMap::make(size, growth).value();
    PlainWorld world;
    Index3 lower;
    for (int step = 0; step < 24; ++step) {
      const int what = random.below(4);
      if (what < 2) {
        write_some(map, world, lower, 4, random);
      } else if (what == 2) {
        const Index3 by{random.below(3) - 1, random.below(3) - 1, random.below(3) - 1};
        map.shift(by, [](Index3, const BrickMap::Bits&) {});
        lower = lower + Index3{64 * by.x, 8 * by.y, 8 * by.z};
        forget_outside(world, lower, size);
      } else {
        map.regrow();
        const Dense dense = dense_of(map);
        expect_same(dense, anew(world, lower, size, growth));
        EXPECT_EQ(map.any_free(), dense.grown.count() < dense.grown.voxels());
      }
      for (int k = 0; k < 50; ++k) {  // single voxels, inside and around
        const Index3 i{random.below(140) - 6, random.below(28) - 6, random.below(28) - 6};
        const bool inside = i.x >= 0 && i.y >= 0 && i.z >= 0 && i.x < 128 && i.y < 16 && i.z < 16;
        const auto state = inside ? world.at(lower + i) : PlainWorld::State::unknown;
        ASSERT_EQ(map.is_known(i), state != PlainWorld::State::unknown);
        ASSERT_EQ(map.is_raw(i), state == PlainWorld::State::occupied);
      }
    }
  }
}

TEST(BrickMap, BricksThatLeaveAreHandedOverAndTheirMemoryIsUsedAgain) {
  BrickMap map = BrickMap::make({128, 8, 8}, growth_of(2, 0.0)).value();
  for (int step = 0; step < 50; ++step) {
    map.write({1, 0, 0}, 5, 1, 3);
    map.regrow();
    int left = 0;
    map.shift({1, 0, 0}, [&](Index3 brick, const BrickMap::Bits& bits) {
      ++left;
      EXPECT_EQ(brick, (Index3{0, 0, 0}));
      EXPECT_EQ(bits.raw[5], 1U);
      EXPECT_EQ(bits.known[5], 3U);
    });
    EXPECT_EQ(left, step == 0 ? 0 : 1);
    EXPECT_LE(map.bricks_held(), 2U);
  }
}

TEST(BrickMap, OnlyWholeBricksMove) {
  BrickMap map = BrickMap::make({100, 8, 8}, growth_of(0, 0.2)).value();
  EXPECT_THROW(map.shift({1, 0, 0}, [](Index3, const BrickMap::Bits&) {}), std::logic_error);
}

TEST(BrickMap, BadSizesAndGrowthsAreRefused) {
  EXPECT_EQ(BrickMap::make({0, 1, 1}, {}).code(), ErrorCode::map_empty);
  EXPECT_EQ(BrickMap::make({1 << 30, 1 << 30, 1}, {}).code(), ErrorCode::map_too_large);
  EXPECT_EQ(BrickMap::make({1, 1, 1}, {.inflation_m = -1.0}).code(), ErrorCode::invalid_input);
  EXPECT_EQ(BrickMap::make({1, 1, 1}, {.resolution_m = 0.0}).code(), ErrorCode::invalid_input);
}

}  // namespace
}  // namespace goshawk
