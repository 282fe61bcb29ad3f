#include "goshawk/core/stop_part.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "goshawk/core/free_curve.hpp"
#include "goshawk/core/inflation.hpp"
#include "goshawk/core/random.hpp"

namespace goshawk::stops {
namespace {

constexpr Index3 kSize{100, 50, 20};
const std::vector kRoom{Polytope::box(Vec3(-50, -50, -50), Vec3(50, 50, 50))};

/// 20 x 10 x 4 m, free; unknown from x = seen_m on, with pockets of what was not seen before that.
std::shared_ptr<VoxelGrid> seen_until(double seen_m, Random* pockets = nullptr) {
  auto grid = std::make_shared<VoxelGrid>();
  grid->geometry = {.origin_map = {0, -5, 0}, .resolution_m = 0.2, .size = kSize};
  grid->known = BitGrid(kSize, false);
  grid->raw = BitGrid(kSize, true, false);
  grid->inflation_m = 0.2;
  grid->unknown_is_occupied = false;
  grid->version = 9;
  for (int z = 0; z < kSize.z; ++z) {
    for (int y = 0; y < kSize.y; ++y) {
      for (int x = 0; x < kSize.x; ++x) {
        const bool hidden = pockets != nullptr && x > 15 && pockets->chance(3e-4);
        grid->known.set({x, y, z}, 0.2 * (x + 1) <= seen_m + 1e-9 && !hidden);
        grid->raw.set({x, y, z}, pockets != nullptr && x > 15 && pockets->chance(1e-4));
      }
    }
  }
  grid->grown = inflate(grid->raw, grid->inflation_m, 0.2).value();
  return grid;
}

CertifiedTrajectory certified(Trajectory trajectory, double a_max_m_s2, double j_max_m_s3 = 0.0,
                              double v_max_m_s = 12.0) {
  const FlatState start = trajectory.sample(0.0), end = trajectory.sample(trajectory.duration_s());
  return certify(std::move(trajectory), kRoom,
                 {.v_max_m_s = v_max_m_s, .a_max_m_s2 = a_max_m_s2, .j_max_m_s3 = j_max_m_s3},
                 start, end)
      .value();
}

/// From rest at x = 1 m to rest at x = 19 m, at its fastest 15/8 of the mean.
CertifiedTrajectory straight(double duration_s, double a_max_m_s2) {
  return certified({{BezierPiece::between({.position = {1.1, 0.1, 2.1}},
                                          {.position = {18.9, 0.1, 2.1}}, duration_s)}},
                   a_max_m_s2);
}

/// To the far side in a few bends, at random.
CertifiedTrajectory winding(Random& random) {
  Trajectory trajectory;
  FlatState state{.position = {1.1, 0.1, 2.1}};
  const double speed = random.uniform(0.8, 3.0);
  for (int i = 1; i <= 4; ++i) {
    FlatState next{.position = {1.1 + 4.4 * i, random.uniform(-3, 3), random.uniform(1, 3)}};
    if (i < 4) next.velocity = Vec3(speed, random.uniform(-0.7, 0.7), random.uniform(-0.3, 0.3));
    trajectory.pieces.push_back(BezierPiece::between(state, next, 6.5 / speed));
    state = next;
  }
  double most_m_s = 0.0, most_m_s2 = 0.0;
  for (const auto& piece : trajectory.pieces) {
    most_m_s = std::max(most_m_s, piece.velocity_points().colwise().norm().maxCoeff());
    most_m_s2 = std::max(most_m_s2, piece.acceleration_points().colwise().norm().maxCoeff());
  }
  return certified(std::move(trajectory), 1.3 * most_m_s2, 0.0, 1.1 * most_m_s);
}

CommittedTrajectory commit(const CertifiedTrajectory& nominal, std::optional<StopPart> stop) {
  return CommittedTrajectory::make({.id = 1, .nominal = nominal, .stop = std::move(stop)}).value();
}

/// Is every voxel within the body, around a point that is flown, known and no obstacle? By brute
/// force over all voxels near it.
bool body_is_seen_free(const VoxelGrid& grid, const Vec3& p_map) {
  const Vec3 p = grid.geometry.to_grid(p_map);
  const double radius = grid.inflation_m / grid.geometry.resolution_m;
  const Index3 c{int(p.x()), int(p.y()), int(p.z())};
  for (int z = c.z - 3; z <= c.z + 3; ++z) {
    for (int y = c.y - 3; y <= c.y + 3; ++y) {
      for (int x = c.x - 3; x <= c.x + 3; ++x) {
        const Vec3 lo(x, y, z);
        const double gap = (p - p.cwiseMax(lo).cwiseMin(lo + Vec3::Ones())).norm();
        if (gap >= radius - 1e-6 || !grid.known.contains({x, y, z})) continue;
        if (!grid.known.get({x, y, z}) || grid.raw.get({x, y, z})) return false;
      }
    }
  }
  return true;
}

TEST(LatestStop, EverythingFlownInRandomWorldsIsSeenFreeAndEndsAtRest) {
  Random random(11);
  int stops = 0, whole = 0, none = 0;
  for (int run = 0; run < 120; ++run) {
    SCOPED_TRACE(run);
    const auto grid = seen_until(random.chance(0.1) ? 1.35 : random.uniform(4.0, 22.0), &random);
    const CertifiedTrajectory nominal = winding(random);
    const auto stop = latest_stop(nominal, FreeSpace(grid), 0.0);
    if (!stop) {
      EXPECT_EQ(stop.code(), ErrorCode::trajectory_blocked);
      ++none;
      continue;
    }
    (*stop ? stops : whole)++;
    const CommittedTrajectory committed = commit(nominal, *stop);
    const Trajectory& flown = committed.flown();
    for (int i = 0; i <= 1000; ++i) {
      const Vec3 p = flown.sample(flown.duration_s() * i / 1000).position;
      ASSERT_TRUE(body_is_seen_free(*grid, p)) << to_text(p);
    }
    EXPECT_LT(flown.sample(flown.duration_s()).velocity.norm(), 1e-3);
    EXPECT_TRUE(check_against(FreeSpace(grid), committed, 0.0));
  }
  EXPECT_GT(stops, 60);
  EXPECT_GT(whole, 0);
  EXPECT_GT(none, 0);
}

TEST(LatestStop, TheStopLeavesTheNominalPartWithoutAJump) {
  Random random(12);
  for (int run = 0; run < 50; ++run) {
    const CertifiedTrajectory nominal = winding(random);
    const auto stop = latest_stop(nominal, FreeSpace(seen_until(random.uniform(6, 16))), 0.0);
    if (!stop || !*stop) continue;
    const Trajectory flown = commit(nominal, *stop).flown();
    const FlatState before = flown.sample((*stop)->after_s - 1e-9);
    const FlatState after = flown.sample((*stop)->after_s + 1e-9);
    EXPECT_LT(largest_difference(before, after), 1e-6);
  }
}

// On a straight line at constant speed physics knows the answer: what is free, less v^2 / (2 a) and
// what the ramps of the deceleration cost.
TEST(LatestStop, OnAStraightLineItBrakesAsLateAsPhysicsAllows) {
  const double v = 3.0, a = 4.0, j = 40.0;
  Trajectory line{
      {BezierPiece::between({.position = {1.1, 0.1, 2.1}, .velocity = {v, 0, 0}},
                            {.position = {16.1, 0.1, 2.1}, .velocity = {v, 0, 0}}, 5.0)}};
  const CertifiedTrajectory nominal = certified(std::move(line), a, j);
  for (const double seen_m : {6.0, 9.0, 12.0}) {
    const auto stop = latest_stop(nominal, FreeSpace(seen_until(seen_m)), 0.0).value();
    ASSERT_TRUE(stop);
    const double free_m = seen_m - 0.2 - 1.1;  // the centre stays a voxel, the body, away
    const double ramp_s = 1.2 * a / j;
    const double latest_s = (free_m - v * v / (2 * a) - v * ramp_s / 2.0) / v;
    EXPECT_LE(stop->after_s, latest_s + 1e-6);
    EXPECT_GE(stop->after_s, latest_s - kStopStep_s);
    const Trajectory& way = stop->trajectory.trajectory();
    EXPECT_NEAR(way.sample(way.duration_s()).position.x(), seen_m - 0.2, v * kStopStep_s);
  }
}

// Between bounds: no stop begins later than the hardest brake of all must, and ours not much
// sooner.
TEST(LatestStop, BeginsNotMuchSoonerThanTheHardestBrakeMust) {
  Random random(13);
  int looked = 0;
  for (int run = 0; run < 30; ++run) {
    const CertifiedTrajectory nominal = winding(random);
    const auto grid = seen_until(random.uniform(7, 15));
    const auto stop = latest_stop(nominal, FreeSpace(grid), 0.0);
    if (!stop || !*stop) continue;
    const double free_s = find_obstruction(FreeSpace(grid), nominal.trajectory())->time_s;
    // Even the hardest brake of all, at once at the limit and without a ramp, needs v / (2 a) of
    // the path's time; ours has a ramp of 0.3 s, and a limit that turns share.
    const FlatState s = nominal.trajectory().sample((*stop)->after_s);
    const double least_s = s.velocity.norm() / (2.0 * nominal.limits().a_max_m_s2);
    EXPECT_LE((*stop)->after_s + least_s, free_s);
    EXPECT_GE((*stop)->after_s + 3.2 * least_s + 0.3 + 2 * kStopStep_s, free_s);
    ++looked;
  }
  EXPECT_GT(looked, 15);
}

TEST(LatestStop, IsNotNeededInSpaceThatIsKnownToTheEnd) {
  const auto stop = latest_stop(straight(12.0, 4.0), FreeSpace(seen_until(99.0)), 0.0);
  ASSERT_TRUE(stop);
  EXPECT_FALSE(*stop);
}

TEST(LatestStop, ComesForANominalPartThatDoesNotEndAtRest) {
  const CertifiedTrajectory nominal = certified(
      {{BezierPiece::between({.position = {1.1, 0.1, 2.1}},
                             {.position = {10.0, 0.1, 2.1}, .velocity = {2, 0, 0}}, 6.0)}},
      4.0);
  const auto stop = latest_stop(nominal, FreeSpace(seen_until(99.0)), 0.0).value();
  ASSERT_TRUE(stop);
  EXPECT_GT(stop->after_s, 5.0);
}

TEST(LatestStop, WhatWasFlownAlreadyIsNotLookedAt) {
  const CertifiedTrajectory nominal = straight(12.0, 4.0);
  auto grid = seen_until(99.0);
  grid->known.set({6, 25, 10}, false);  // beside the start
  EXPECT_FALSE(latest_stop(nominal, FreeSpace(grid), 0.0));
  EXPECT_TRUE(latest_stop(nominal, FreeSpace(grid), 4.0));
}

TEST(LatestStop, WithoutRoomToBrakeThePlaceIsNamed) {
  auto grid = seen_until(0.6);
  const auto stop = latest_stop(straight(12.0, 4.0), FreeSpace(grid), 0.0);
  ASSERT_FALSE(stop);
  EXPECT_THAT(stop.error().message, testing::HasSubstr("map 9 has space that was never seen"));
}

}  // namespace
}  // namespace goshawk::stops
