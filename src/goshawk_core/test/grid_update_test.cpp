#include "goshawk/core/grid_update.hpp"

#include <gmock/gmock.h>

#include "goshawk/core/random.hpp"

namespace goshawk {
namespace {

VoxelGrid grid_to_update() {
  VoxelGrid grid;
  grid.geometry = {Vec3::Zero(), 0.1, {70, 9, 3}};
  grid.occupied = BitGrid(grid.geometry.size, true);
  grid.known = BitGrid(grid.geometry.size, false);
  grid.version = 5;
  return grid;
}

Brick full_brick(Index3 index) {
  Brick brick;
  brick.index = index;
  brick.occupied.fill(~BitGrid::Word{0});
  brick.known.fill(~BitGrid::Word{0});
  return brick;
}

TEST(GridUpdate, BricksCoverTheGrid) {
  EXPECT_EQ(brick_counts({1, 1, 1}), (Index3{1, 1, 1}));
  EXPECT_EQ(brick_counts({64, 8, 8}), (Index3{1, 1, 1}));
  EXPECT_EQ(brick_counts({65, 9, 17}), (Index3{2, 2, 3}));
}

TEST(GridUpdate, ABrickAtTheEdgeTouchesNeitherPaddingNorNeighbours) {
  VoxelGrid grid = grid_to_update();
  ASSERT_TRUE(apply(grid, {5, 6, {full_brick({1, 1, 0})}}));
  EXPECT_EQ(grid.version, 6U);
  EXPECT_EQ(grid.occupied.count(), 6 * 1 * 3);
  EXPECT_EQ(grid.known.count(), 6 * 1 * 3);
  const Index3 size = grid.geometry.size;
  EXPECT_EQ(grid.occupied,
            BitGrid::from_words(size, true, BitGrid(grid.occupied).take_words()).value());
  EXPECT_EQ(grid.known, BitGrid::from_words(size, false, BitGrid(grid.known).take_words()).value());
}

TEST(GridUpdate, WhatDoesNotFitIsRefusedWholly) {
  const VoxelGrid before = grid_to_update();
  VoxelGrid grid = before;
  const auto refused = [&](const GridUpdate& update) {
    EXPECT_EQ(apply(grid, update).code(), ErrorCode::invalid_input);
    EXPECT_EQ(grid.occupied, before.occupied);
    EXPECT_EQ(grid.version, before.version);
  };
  refused({4, 6, {}});
  refused({5, 6, {full_brick({0, 0, 0}), full_brick({2, 0, 0})}});
  refused({5, 6, {full_brick({0, 0, 0}), full_brick({0, -1, 0})}});
  refused({5, 6, {full_brick({0, 0, 0}), full_brick({0, 0, 2147483647})}});
  grid.known = BitGrid();
  refused({5, 6, {full_brick({0, 0, 0})}});
}

}  // namespace
}  // namespace goshawk
