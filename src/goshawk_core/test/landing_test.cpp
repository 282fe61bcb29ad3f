#include "goshawk/core/landing.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "goshawk/core/inflation.hpp"
#include "goshawk/core/random.hpp"

namespace goshawk {
namespace {

using testing::HasSubstr;

// 2 x 2 x 4 m of 0.1 m, from the origin; `raw` is grown as the map server does.
VoxelGrid grid_of(const BitGrid& raw, double inflation_m = 0.2) {
  VoxelGrid grid;
  grid.geometry = {.origin_map = Vec3::Zero(), .resolution_m = 0.1, .size = raw.size()};
  grid.grown = inflate(raw, inflation_m, 0.1).value();
  grid.inflation_m = inflation_m;
  return grid;
}

BitGrid empty_room() {
  return {{20, 20, 40}, true};
}

BitGrid room_with_floor(int layers) {
  BitGrid raw = empty_room();
  for (int z = 0; z < layers; ++z) {
    for (int y = 0; y < 20; ++y) raw.set_run(0, 20, y, z, true);
  }
  return raw;
}

ErrorCode down(const VoxelGrid& grid, const Vec3& from, double land_height_m = 0.05) {
  return check_way_down(grid, from, land_height_m).code();
}

TEST(WayDown, IsFreeInAnEmptyRoomAndOverItsFloor) {
  EXPECT_EQ(down(grid_of(empty_room()), {1, 1, 2}), ErrorCode::ok);
  EXPECT_EQ(down(grid_of(room_with_floor(1)), {1, 1, 2}), ErrorCode::ok);
  EXPECT_EQ(down(grid_of(room_with_floor(3)), {1, 1, 2}, 0.25), ErrorCode::ok);
  // The same floor is an obstacle for a vehicle that believes the ground to be lower.
  EXPECT_EQ(down(grid_of(room_with_floor(3)), {1, 1, 2}, 0.15), ErrorCode::goal_occupied);
}

TEST(WayDown, IsBlockedByWhateverRisesAboveTheGroundsLayerWithinTheInflation) {
  for (int z = 1; z < 15; ++z) {
    BitGrid raw = room_with_floor(1);
    raw.set({10, 10, z}, true);
    const VoxelGrid grid = grid_of(raw);
    for (int x = 0; x < 20; ++x) {
      // Cubes at a distance of less than 0.2 m are blocked.
      const bool near = std::abs(x - 10) <= 2;
      EXPECT_EQ(down(grid, grid.geometry.center({x, 10, 30})),
                near ? ErrorCode::goal_occupied : ErrorCode::ok)
          << "obstacle in layer " << z << ", column " << x;
    }
  }
  const auto answer = check_way_down(grid_of(room_with_floor(9)), {1, 1, 2}, 0.05);
  ASSERT_FALSE(answer);
  EXPECT_THAT(answer.error().message, HasSubstr("something is below"));
}

TEST(WayDown, IsBlockedBySpaceThatWasNotMeasuredWhateverThePolicy) {
  VoxelGrid grid = grid_of(empty_room());
  grid.known = BitGrid(grid.geometry.size, false, true);
  grid.unknown_is_occupied = false;
  EXPECT_EQ(down(grid, {1, 1, 2}), ErrorCode::ok);
  grid.known.set({10, 10, 7}, false);
  EXPECT_EQ(down(grid, {1.05, 1.05, 2}), ErrorCode::goal_unknown);
  EXPECT_EQ(down(grid, {0.85, 1.05, 2}), ErrorCode::ok);
}

TEST(WayDown, OnAFaceBetweenVoxelsOneFreeColumnIsEnough) {
  VoxelGrid grid = grid_of(empty_room());
  grid.grown.set({10, 10, 20}, true);
  EXPECT_EQ(down(grid, {1.0, 1.05, 3}), ErrorCode::ok);
  EXPECT_EQ(down(grid, {1.01, 1.05, 3}), ErrorCode::goal_occupied);
  EXPECT_EQ(down(grid, {0.0, 0.0, 3}), ErrorCode::ok);
  EXPECT_EQ(down(grid, {-1e-12, 2.0, 3}), ErrorCode::ok);
}

TEST(WayDown, OutsideTheMapNothingIsFree) {
  const VoxelGrid grid = grid_of(empty_room());
  EXPECT_EQ(down(grid, {-0.01, 1, 2}), ErrorCode::goal_outside);
  EXPECT_EQ(down(grid, {1, 1, 4.1}), ErrorCode::goal_outside);
  EXPECT_EQ(down(grid, {1, 1, 2}, -0.5), ErrorCode::goal_outside);
  EXPECT_EQ(down(grid, {std::nan(""), 1, 2}), ErrorCode::invalid_input);
  EXPECT_EQ(down(grid, {1, 1, 2}, HUGE_VAL), ErrorCode::invalid_input);
  // Above the map the ground is, or the vehicle is already below: nothing is between them.
  EXPECT_EQ(down(grid, {1, 1, 2}, 100.0), ErrorCode::ok);
}

// Against the meaning, by distances between cubes in voxels; the ground, grown by four, hides what
// is lower at the sides.
bool rises_near(const BitGrid& raw, Index3 from, int ground) {
  const Index3 size = raw.size();
  for (int z = ground + 1; z < size.z; ++z) {
    const int hidden = std::max(0, 4 - (z - ground));
    for (int y = 0; y < size.y; ++y) {
      for (int x = 0; x < size.x; ++x) {
        const int dx = std::max(0, std::abs(x - from.x) - 1);
        const int dy = std::max(0, std::abs(y - from.y) - 1);
        if (raw.get({x, y, z}) && dx * dx + dy * dy + hidden * hidden < 16) return true;
      }
    }
  }
  return false;
}

TEST(WayDown, AgreesWithDistancesInRandomRooms) {
  Random random(7);
  int free = 0;
  for (int trial = 0; trial < 400; ++trial) {
    BitGrid raw(Index3{16, 16, 20}, true);
    for (int k = 0; k < 4; ++k)
      raw.set({random.below(16), random.below(16), random.below(20)}, true);
    const VoxelGrid grid = grid_of(raw, 0.4);
    const Index3 from{random.below(16), random.below(16), 19};
    const int ground = random.below(4);
    const bool blocked = rises_near(raw, from, ground);
    free += !blocked;
    const double height = 0.1 * (ground + 0.5);
    EXPECT_EQ(down(grid, grid.geometry.center(from), height) == ErrorCode::ok, !blocked) << trial;
  }
  EXPECT_GT(free, 40);
  EXPECT_LT(free, 360);
}

TEST(LandingGuard, FollowsItsRule) {
  LandingGuard by_map(LandingRule::map, 0.05);
  EXPECT_TRUE(by_map.needs_map());
  EXPECT_EQ(by_map.check({1, 1, 2}).code(), ErrorCode::no_map);
  by_map.set_map(std::make_shared<VoxelGrid>(grid_of(room_with_floor(9))));
  EXPECT_FALSE(by_map.needs_map());
  EXPECT_EQ(by_map.check({1, 1, 2}).code(), ErrorCode::goal_occupied);
  by_map.set_map(std::make_shared<VoxelGrid>(grid_of(empty_room())));
  EXPECT_TRUE(by_map.check({1, 1, 2}));

  EXPECT_TRUE(LandingGuard(LandingRule::anywhere, 0.05).check({1, 1, 2}));
  EXPECT_FALSE(LandingGuard(LandingRule::anywhere, 0.05).needs_map());
  EXPECT_EQ(LandingGuard(LandingRule::never, 0.05).check({1, 1, 2}).code(), ErrorCode::cancelled);
}

}  // namespace
}  // namespace goshawk
