#include "goshawk/core/grid_update.hpp"

#include <gtest/gtest.h>

#include <map>

#include "goshawk/core/random.hpp"

namespace goshawk {
namespace {

// Sizes on both sides of the edges of bricks.
const std::vector<Index3> kGridSizes{{70, 9, 3}, {64, 8, 8}, {200, 17, 20}, {1, 1, 1}, {130, 24, 9}};

VoxelGrid grid_to_update(Index3 size = {70, 9, 3}) {
  VoxelGrid grid;
  grid.geometry = {Vec3::Zero(), 0.1, size};
  grid.grown = BitGrid(size, true);
  grid.known = BitGrid(size, false);
  grid.version = 5;
  return grid;
}

Brick full_brick(Index3 index) {
  Brick brick;
  brick.index = index;
  brick.grown.fill(~BitGrid::Word{0});
  brick.known.fill(~BitGrid::Word{0});
  return brick;
}

// A map as a list of voxels on the unbounded raster: what a window shows is looked up, not moved.
struct PlainMap {
  struct Voxel {
    bool grown, known, raw;
  };

  explicit PlainMap(const VoxelGrid& grid)
      : size(grid.geometry.size), unknown_is_occupied(grid.unknown_is_occupied) {}

  void apply(const GridUpdate& update) {
    const Index3 by{64 * update.shift.x, 8 * update.shift.y, 8 * update.shift.z};
    std::map<std::array<int, 3>, Voxel> moved;
    for (const auto& [at, voxel] : voxels) {
      const Index3 i{at[0] - by.x, at[1] - by.y, at[2] - by.z};
      if (contains(i)) moved[{i.x, i.y, i.z}] = voxel;
    }
    voxels = std::move(moved);
    for (const Brick& brick : update.bricks) write(brick);
  }

  void write(const Brick& brick) {
    for (int n = 0; n < 64 * Brick::kWords; ++n) {
      const auto word = std::size_t(n / 64);
      const Index3 i{64 * brick.index.x + n % 64, 8 * brick.index.y + int(word % 8),
                     8 * brick.index.z + int(word / 8)};
      if (!contains(i)) continue;
      const auto bit = [&](const Brick::Words& words) { return (words[word] >> (n % 64) & 1U) != 0; };
      voxels[{i.x, i.y, i.z}] = {bit(brick.grown), bit(brick.known), brick.raw && bit(*brick.raw)};
    }
  }

  bool contains(Index3 i) const {
    return i.x >= 0 && i.y >= 0 && i.z >= 0 && i.x < size.x && i.y < size.y && i.z < size.z;
  }
  Voxel at(Index3 i) const {
    const auto found = voxels.find({i.x, i.y, i.z});
    return found == voxels.end() ? Voxel{unknown_is_occupied, false, false} : found->second;
  }

  Index3 size;
  bool unknown_is_occupied;
  std::map<std::array<int, 3>, Voxel> voxels;
};

void expect_same(const VoxelGrid& grid, const PlainMap& plain) {
  for (int z = 0; z < plain.size.z; ++z) {
    for (int y = 0; y < plain.size.y; ++y) {
      for (int x = 0; x < plain.size.x; ++x) {
        const auto voxel = plain.at({x, y, z});
        ASSERT_EQ(grid.grown.get({x, y, z}), voxel.grown) << to_text(Index3{x, y, z});
        ASSERT_EQ(grid.known.get({x, y, z}), voxel.known) << to_text(Index3{x, y, z});
        if (!grid.raw.empty()) {
          ASSERT_EQ(grid.raw.get({x, y, z}), voxel.raw) << to_text(Index3{x, y, z});
        }
      }
    }
  }
  // Padding as it must be: words that are read back are the same grid.
  ASSERT_EQ(BitGrid::from_words(plain.size, true, grid.grown.to_words()).value().to_words(),
            grid.grown.to_words());
  ASSERT_EQ(BitGrid::from_words(plain.size, false, grid.known.to_words()).value().to_words(),
            grid.known.to_words());
}

GridUpdate random_update(const VoxelGrid& grid, Random& random) {
  GridUpdate update;
  update.from_version = grid.version;
  update.to_version = grid.version + 1;
  const auto step = [&] { return random.chance(0.7) ? 0 : random.below(5) - 2; };
  if (random.chance(0.5)) update.shift = {step(), step(), step()};
  const Index3 counts = brick_counts(grid.geometry.size);
  for (int n = random.below(4); n > 0; --n) {
    Brick brick;
    brick.index = {random.below(counts.x), random.below(counts.y), random.below(counts.z)};
    if (!grid.raw.empty()) brick.raw.emplace();
    for (std::size_t w = 0; w < brick.grown.size(); ++w) {
      brick.grown[w] = random.next();
      brick.known[w] = random.next();
      if (brick.raw) (*brick.raw)[w] = random.next();
    }
    update.bricks.push_back(brick);
  }
  return update;
}

TEST(GridUpdate, BricksCoverTheGrid) {
  EXPECT_EQ(brick_counts({1, 1, 1}), (Index3{1, 1, 1}));
  EXPECT_EQ(brick_counts({64, 8, 8}), (Index3{1, 1, 1}));
  EXPECT_EQ(brick_counts({65, 9, 17}), (Index3{2, 2, 3}));
}

TEST(GridUpdate, FollowsAPlainMapThroughUpdatesAndShiftsAndKeepsVersionsThatOthersHold) {
  Random random(1);
  for (const Index3 size : kGridSizes) {
    for (const bool raw : {false, true}) {
      VoxelGrid grid = grid_to_update(size);
      grid.unknown_is_occupied = raw;
      grid.grown = BitGrid(size, true, grid.unknown_is_occupied);
      if (raw) grid.raw = BitGrid(size, true);
      PlainMap plain(grid);
      for (int n = 0; n < 25; ++n) {
        const VoxelGrid held = grid;
        const PlainMap plain_held = plain;
        const GridUpdate update = random_update(grid, random);
        ASSERT_TRUE(apply(grid, update));
        plain.apply(update);
        ASSERT_NO_FATAL_FAILURE(expect_same(grid, plain));
        ASSERT_NO_FATAL_FAILURE(expect_same(held, plain_held));
        EXPECT_EQ(grid.version, held.version + 1);
      }
    }
  }
}

TEST(GridUpdate, MovesTheOriginWithTheWindow) {
  VoxelGrid grid = grid_to_update();
  ASSERT_TRUE(apply(grid, {5, 6, {1, -2, 3}, {}}));
  EXPECT_TRUE(grid.geometry.origin_map.isApprox(Vec3(6.4, -1.6, 2.4)));
  ASSERT_TRUE(apply(grid, {6, 7, {2147483647, -2147483647, 5}, {}}));
  EXPECT_EQ(grid.known.count(), 0);
}

TEST(GridUpdate, ABrickAtTheEdgeTouchesNeitherPaddingNorNeighbours) {
  VoxelGrid grid = grid_to_update();
  ASSERT_TRUE(apply(grid, {5, 6, {}, {full_brick({1, 1, 0})}}));
  EXPECT_EQ(grid.version, 6U);
  EXPECT_EQ(grid.grown.count(), 6 * 1 * 3);
  EXPECT_EQ(grid.known.count(), 6 * 1 * 3);
}

TEST(GridUpdate, WhatDoesNotChangeIsNotCloned) {
  VoxelGrid grid = grid_to_update({640, 80, 80});
  const VoxelGrid before = grid;
  ASSERT_TRUE(apply(grid, {5, 6, {}, {full_brick({3, 4, 5}), brick_of(grid, {1, 1, 1})}}));
  int changed = 0;
  for_changed_chunks(before.grown, grid.grown, [&](BitGrid::Rows rows) {
    EXPECT_EQ(rows.y0, 32);
    EXPECT_EQ(rows.z0, 40);
    ++changed;
  });
  EXPECT_EQ(changed, 1);
  EXPECT_EQ(grid.grown.row(8, 8), before.grown.row(8, 8)) << "the brick that stays the same";
  EXPECT_NE(grid.grown.row(32, 40), before.grown.row(32, 40));
}

TEST(GridUpdate, BricksAreReadAsTheyAreWritten) {
  Random random(2);
  VoxelGrid grid = grid_to_update();
  grid.raw = BitGrid(grid.geometry.size, true);
  ASSERT_TRUE(apply(grid, random_update(grid, random)));
  VoxelGrid copy = grid_to_update();
  copy.raw = BitGrid(copy.geometry.size, true);
  GridUpdate all{5, 6, {}, {}};
  const Index3 counts = brick_counts(grid.geometry.size);
  for (int z = 0; z < counts.z; ++z) {
    for (int y = 0; y < counts.y; ++y) {
      for (int x = 0; x < counts.x; ++x) all.bricks.push_back(brick_of(grid, {x, y, z}));
    }
  }
  ASSERT_TRUE(apply(copy, all));
  EXPECT_EQ(copy.grown, grid.grown);
  EXPECT_EQ(copy.known, grid.known);
  EXPECT_EQ(copy.raw, grid.raw);
}

TEST(GridUpdate, WhatDoesNotFitIsRefusedWholly) {
  VoxelGrid before = grid_to_update();
  VoxelGrid grid = before;
  const auto refused = [&](const GridUpdate& update) {
    EXPECT_EQ(apply(grid, update).code(), ErrorCode::invalid_input);
    EXPECT_EQ(grid.grown, before.grown);
    EXPECT_EQ(grid.version, before.version);
    EXPECT_EQ(grid.geometry.origin_map, before.geometry.origin_map);
  };
  refused({4, 6, {}, {}});
  refused({5, 6, {1, 0, 0}, {full_brick({0, 0, 0}), full_brick({2, 0, 0})}});
  refused({5, 6, {}, {full_brick({0, 0, 0}), full_brick({0, -1, 0})}});
  refused({5, 6, {}, {full_brick({0, 0, 0}), full_brick({0, 0, 2147483647})}});
  grid.raw = BitGrid(grid.geometry.size, true);
  refused({5, 6, {}, {full_brick({0, 0, 0})}});
  grid.raw = BitGrid();
  grid.known = BitGrid();
  refused({5, 6, {}, {full_brick({0, 0, 0})}});
}

}  // namespace
}  // namespace goshawk
