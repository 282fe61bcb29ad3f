// A vehicle that rests where no plan may begin, because the map learnt obstacles late.
#include "goshawk/navigator/way_out.hpp"

#include <algorithm>

#include "goshawk/core/free_curve.hpp"
#include "goshawk/core/inflation.hpp"
#include "goshawk/core/random.hpp"
#include "harness.hpp"

namespace goshawk::navigator {
namespace {

constexpr double kEdge_m = 0.2;
constexpr double kRadius_m = 0.2;
const Index3 kRoomSize{40, 40, 20};
const Limits kSlow{.v_max_m_s = 1.0, .a_max_m_s2 = 2.0, .j_max_m_s3 = 20.0};

VoxelGrid room_with(const std::vector<Index3>& obstacles, std::uint64_t version = 9) {
  VoxelGrid grid;
  grid.geometry = {.origin_map = {-4.0, -4.0, -1.0}, .resolution_m = kEdge_m, .size = kRoomSize};
  grid.known = BitGrid(kRoomSize, false, true);
  grid.raw = BitGrid(kRoomSize, true, false);
  for (const Index3 voxel : obstacles) grid.raw.set(voxel, true);
  grid.grown = inflate(grid.raw, kRadius_m + 0.2, kEdge_m).value();
  grid.inflation_m = kRadius_m;
  grid.unknown_is_occupied = false;
  grid.version = version;
  return grid;
}

FreeSpace seen(VoxelGrid grid) {
  return FreeSpace(std::make_shared<const VoxelGrid>(std::move(grid)));
}

double from_cube_m(const VoxelGrid& grid, Index3 voxel, const Vec3& p_map) {
  const Vec3 low = grid.geometry.lower_corner(voxel);
  return (p_map - p_map.cwiseMax(low).cwiseMin(low + Vec3::Constant(kEdge_m))).norm();
}

TEST(WayOut, LeadsToFreeSpaceAndComesNoNearerToAnythingByBruteForce) {
  Random random(2);
  int found = 0, none = 0;
  for (int run = 0; run < 200; ++run) {
    std::vector<Index3> obstacles;
    for (int i = 0; i < 60; ++i) {
      obstacles.push_back({15 + random.below(10), 15 + random.below(10), 5 + random.below(10)});
    }
    const FreeSpace space = seen(room_with(obstacles));
    const Vec3 rest(random.uniform(-0.9, 0.9), random.uniform(-0.9, 0.9), random.uniform(0, 1.9));
    if (!space.grid()->grown.get(*space.grid()->geometry.index_of(rest))) continue;
    const auto way = way_out(rest, space, kSlow);
    if (!way) {
      EXPECT_EQ(way.code(), ErrorCode::start_occupied);
      ++none;
      continue;
    }
    ++found;
    const Trajectory& flown = way->trajectory();
    EXPECT_TRUE(way->ends_at_rest());
    const Vec3 end = flown.sample(flown.duration_s()).position;
    EXPECT_FALSE(space.grid()->grown.get(*space.grid()->geometry.index_of(end)));
    for (const Index3 voxel : obstacles) {
      const double least_m =
          std::min(kRadius_m, from_cube_m(*space.grid(), voxel, rest)) - 2.0 * kTouch_m;
      for (int i = 0; i <= 100; ++i) {
        const Vec3 p = flown.sample(flown.duration_s() * i / 100).position;
        ASSERT_GE(from_cube_m(*space.grid(), voxel, p), least_m);
      }
    }
  }
  EXPECT_GT(found, 50);
  EXPECT_GT(none, 5);
}

TEST(WayOut, KeepsEveryKindOfLimit) {
  const FreeSpace space = seen(room_with({{20, 20, 9}}));
  for (const LimitNorm norm :
       {LimitNorm::euclidean, LimitNorm::per_axis, LimitNorm::horizontal_vertical}) {
    Limits limits = kSlow;
    limits.norm = norm;
    if (norm == LimitNorm::horizontal_vertical) limits.v_max_vertical_m_s = 0.3;
    const auto way = way_out(Vec3(0.1, 0.1, 1.15), space, limits);
    ASSERT_TRUE(way) << way.error().message;
    EXPECT_TRUE(way->certificate().holds());
  }
}

/// The vehicle hovers at kHome; a voxel 0.2 m below it has just become an obstacle.
VoxelGrid below_home(std::uint64_t version) {
  return room_with({{20, 20, 8}}, version);
}

TEST(WayOut, AVehicleAtRestInTheReserveLeavesAndThePlanBeginsAtTheEndOfItsWay) {
  Harness h;
  h.map(below_home(6));
  h.map_version = 6;
  h.goal(Vec3(3, 0, 1));
  ASSERT_EQ(h.commits.size(), 1u) << "the way out";
  const CommittedTrajectory way = h.commits[0];
  EXPECT_LT((way.flown().sample(0.0).position - kHome).norm(), 1e-9);
  ASSERT_EQ(h.plans.size(), 1u);
  EXPECT_EQ(*h.plans[0].start_time_ns,
            way.start_time_ns() + std::int64_t(std::llround(way.flown().duration_s() * 1e9)));
  const Vec3 start = h.plans[0].start.position;
  EXPECT_LT((start - way.flown().sample(way.flown().duration_s()).position).norm(), 1e-9);
  h.tracker_says(way.id(), ok());
  h.answer();
  ASSERT_EQ(h.commits.size(), 2u);
  h.pass(12.0);
  EXPECT_EQ(h.last().state, State::arrived);
}

TEST(WayOut, WithoutOneThePlanIsAskedForWhereTheVehicleIsSoThatTheSearchSaysWhyNot) {
  Harness h;
  std::vector<Index3> shell;
  for (int z = 7; z <= 12; ++z) {
    for (int y = 17; y <= 22; ++y) {
      for (int x = 17; x <= 22; ++x) {
        const bool inside = x > 17 && x < 22 && y > 17 && y < 22 && z > 7 && z < 12;
        if (!inside) shell.push_back({x, y, z});
      }
    }
  }
  h.map(room_with(shell, 6));
  h.goal(Vec3(3, 0, 1));
  EXPECT_TRUE(h.commits.empty());
  ASSERT_EQ(h.plans.size(), 1u);
  EXPECT_LT((h.plans[0].start.position - kHome).norm(), 1e-9);
  EXPECT_FALSE(h.plans[0].start_time_ns);
}

TEST(WayOut, WhatIsFlownThroughTheReserveIsPlannedAnewFromWhereItLeavesIt) {
  Harness h;
  VoxelGrid grid = room_with({{30, 18, 9}});  // 0.4 m beside the way, which the reserve covers
  grid.known = BitGrid(kRoomSize, false);
  for (int z = 0; z < kRoomSize.z; ++z) {
    for (int y = 0; y < kRoomSize.y; ++y) grid.known.set_run(0, 36, y, z, true);
  }
  grid.version = 6;
  VoxelGrid before = grid;
  before.raw = BitGrid(kRoomSize, true, false);
  before.grown = BitGrid(kRoomSize, true, false);
  h.map(before);
  h.map_version = 6;
  h.goal(Vec3(3.8, 0.05, 1));
  h.answer(8.0);
  ASSERT_EQ(h.commits.size(), 1u);
  ASSERT_TRUE(h.commits[0].stop());
  h.pass(3.0);
  grid.version = 7;
  const auto is_blocked = [&](const Vec3& p) { return grid.grown.get(*grid.geometry.index_of(p)); };
  while (!is_blocked(h.vehicle().position) && h.vehicle().position.x() < 3.0) h.pass(0.02);
  ASSERT_TRUE(is_blocked(h.vehicle().position));
  const std::size_t asked = h.plans.size(), committed = h.commits.size();
  h.map(grid);
  EXPECT_EQ(h.commits.size(), committed) << "nothing to brake for";
  for (int i = 0; i < 20 && h.plans.size() == asked; ++i) h.pass(0.02);
  ASSERT_GT(h.plans.size(), asked);
  EXPECT_FALSE(is_blocked(h.plans.back().start.position));
}

}  // namespace
}  // namespace goshawk::navigator
