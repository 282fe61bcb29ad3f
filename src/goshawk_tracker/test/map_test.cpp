#include <gmock/gmock.h>

#include <cmath>

#include "goshawk/core/stop_part.hpp"
#include "goshawk/tracker/tracker.hpp"
#include "trajectories.hpp"

namespace goshawk::tracker {
namespace {

using testing::HasSubstr;

std::int64_t in_ns(double s) {
  return std::llround(s * 1e9);
}

/// 20 x 20 x 6 m of 0.2 m, its middle at (0, 0, 3); blocked in a wall of one voxel's thickness
/// from wall_m to wall_m + 0.2 in x, if that is given.
std::shared_ptr<const VoxelGrid> hall(std::uint64_t version, std::optional<double> wall_m = {}) {
  auto grid = std::make_shared<VoxelGrid>();
  grid->geometry = {.origin_map = {-10.0, -10.0, 0.0}, .resolution_m = 0.2, .size = {100, 100, 30}};
  grid->grown = BitGrid(grid->geometry.size, true);
  grid->version = version;
  if (!wall_m) return grid;
  const int x = int(std::lround((*wall_m + 10.0) / 0.2));
  for (int z = 0; z < 30; ++z) {
    for (int y = 0; y < 100; ++y) grid->grown.set({x, y, z}, true);
  }
  return grid;
}

RigidBodyState state_at(const FlatState& flat) {
  RigidBodyState state;
  state.position_map = flat.position;
  state.velocity_map = flat.velocity;
  return state;
}

/// Along x from (0, 0, 1) to (8, 0, 1), 2 m/s at its middle; its map is version 5.
CommittedTrajectory eight_metres(std::uint64_t id = 1, std::uint64_t map_version = 5) {
  const Draft draft = straight_line({0, 0, 1}, {8, 0, 1}, 7.5);
  auto certified =
      certify(draft.trajectory, draft.polytopes, draft.limits, draft.start, draft.goal);
  return CommittedTrajectory::make(
             {.id = id, .nominal = std::move(certified).value(), .map_version = map_version})
      .value();
}

/// A tracker whose vehicle is always where it should be.
struct Flown {
  explicit Flown(const Config& config = {}) : tracker(Tracker::create(config).value()) {
    EXPECT_TRUE(tracker.step(state_at({.position = {0, 0, 1}}), 0));
  }
  void until(double end_s) {
    for (; time_s < end_s; time_s += 0.01) {
      const FlatState wanted = tracker.status().reference;
      farthest_x_m = std::max(farthest_x_m, wanted.position.x());
      hardest_m_s2 = std::max(hardest_m_s2, wanted.acceleration.norm());
      ASSERT_TRUE(tracker.step(state_at(wanted), in_ns(time_s)));
    }
  }
  std::int64_t now_ns() const { return in_ns(time_s); }

  Tracker tracker;
  double time_s = 0.01;
  double farthest_x_m = 0.0;
  double hardest_m_s2 = 0.0;
};

TEST(MapInFlight, WithoutAMapNothingIsFlown) {
  Flown flown;
  const auto refused = flown.tracker.accept(eight_metres(), 0);
  EXPECT_EQ(refused.code(), ErrorCode::no_map);
  EXPECT_THAT(refused.error().message, HasSubstr("map_server"));
  EXPECT_EQ(flown.tracker.status().queued, 0);
  flown.tracker.set_map(hall(5), 0);
  EXPECT_TRUE(flown.tracker.accept(eight_metres(), 0));
}

TEST(MapInFlight, WithoutAMapEverythingIsFlownIfThatIsWished) {
  Flown flown(without_map());
  EXPECT_TRUE(flown.tracker.accept(eight_metres(), 0));
}

TEST(MapInFlight, AVersionThatHasNotComeIsRefused) {
  Flown flown;
  flown.tracker.set_map(hall(4), 0);
  const auto refused = flown.tracker.accept(eight_metres(), 0);
  EXPECT_EQ(refused.code(), ErrorCode::no_map);
  EXPECT_THAT(refused.error().message, HasSubstr("planned in map 5"));
  EXPECT_THAT(refused.error().message, HasSubstr("is 4"));
  flown.tracker.set_map(hall(900), 0);
  EXPECT_TRUE(flown.tracker.accept(eight_metres(), 0)) << "a newer one decides";
}

TEST(MapInFlight, AForgedTrajectoryThroughAnObstacleIsRefusedWithPlaceAndVersion) {
  Flown flown;
  flown.tracker.set_map(hall(5, 4.0), 0);
  const auto refused = flown.tracker.accept(eight_metres(), 0);
  EXPECT_EQ(refused.code(), ErrorCode::trajectory_blocked);
  EXPECT_THAT(refused.error().message, HasSubstr("map 5 has an obstacle at (4.1"));
  EXPECT_EQ(flown.tracker.status().queued, 0);
}

/// The hall, seen up to there; the map leaves the rest free for planning.
std::shared_ptr<const VoxelGrid> seen_hall(std::uint64_t version, double seen_m) {
  auto grid = std::make_shared<VoxelGrid>(*hall(version));
  grid->known = BitGrid(grid->geometry.size, false);
  for (int z = 0; z < 30; ++z) {
    for (int y = 0; y < 100; ++y) {
      grid->known.set_run(0, int(std::lround((seen_m + 10.0) / 0.2)), y, z, true);
    }
  }
  grid->unknown_is_occupied = false;
  grid->inflation_m = 0.2;
  return grid;
}

TEST(MapInFlight, SpaceThatWasNeverSeenIsNotFlownThrough) {
  Flown flown;
  flown.tracker.set_map(seen_hall(5, 8.0), 0);
  const auto refused = flown.tracker.accept(eight_metres(), 0);
  EXPECT_EQ(refused.code(), ErrorCode::trajectory_blocked);
  EXPECT_THAT(refused.error().message, HasSubstr("map 5 has space that was never seen within"));
  flown.tracker.set_map(seen_hall(6, 8.6), 0);
  EXPECT_TRUE(flown.tracker.accept(eight_metres(), 0)) << "the whole body was seen free";
  // And if it is forgotten on the way, the vehicle brakes before it.
  flown.until(3.74);
  flown.tracker.set_map(seen_hall(7, 7.0), flown.now_ns());
  EXPECT_EQ(flown.tracker.status().fault.code, ErrorCode::trajectory_blocked);
  flown.until(8.0);
  EXPECT_LT(flown.farthest_x_m, 6.8 + 1e-9);
  EXPECT_EQ(flown.tracker.status().mode, Mode::hold);
}

TEST(MapInFlight, SpaceThatWasNeverSeenIsFlownThroughIfThatIsWished) {
  Config config;
  config.fly_unknown = true;
  Flown flown(config);
  flown.tracker.set_map(seen_hall(5, 2.0), 0);
  EXPECT_TRUE(flown.tracker.accept(eight_metres(), 0));
}

TEST(MapInFlight, WhatLiesBehindTheVehicleIsNoConflict) {
  Flown flown;
  flown.tracker.set_map(hall(5), 0);
  ASSERT_TRUE(flown.tracker.accept(eight_metres(), 0));
  flown.until(4.0);
  flown.tracker.set_map(hall(6, 1.0), flown.now_ns());
  flown.until(8.0);
  EXPECT_EQ(flown.tracker.status().fault.code, ErrorCode::ok);
  EXPECT_NEAR(flown.farthest_x_m, 8.0, 1e-9);
}

TEST(MapInFlight, BeforeANewObstacleTheVehicleBrakesAtOnceAsGentlyAsItMay) {
  for (const double wall_m : {4.6, 5.0, 6.0, 7.8}) {
    SCOPED_TRACE(wall_m);
    Flown flown;
    flown.tracker.set_map(hall(5), 0);
    ASSERT_TRUE(flown.tracker.accept(eight_metres(17), 0));
    flown.until(3.74);  // at 4 m with 2 m/s
    flown.tracker.set_map(hall(6, wall_m), flown.now_ns());
    const auto status = flown.tracker.status();
    EXPECT_EQ(status.fault.code, ErrorCode::trajectory_blocked);
    EXPECT_EQ(status.lost_trajectory_id, 17U);
    EXPECT_THAT(status.fault.message, HasSubstr("map 6 has an obstacle at"));
    EXPECT_THAT(status.fault.message, HasSubstr("braking before it"));
    flown.until(7.0);
    EXPECT_EQ(flown.tracker.status().mode, Mode::hold);
    EXPECT_LT(flown.farthest_x_m, wall_m + 1e-9);
    EXPECT_LT(flown.hardest_m_s2, wall_m >= 5.6 ? 3.5 : 8.0);
  }
}

/// The hall, seen up to there, with a wall.
std::shared_ptr<const VoxelGrid> seen_hall_with_wall(std::uint64_t version, double seen_m,
                                                     double wall_m) {
  auto grid = std::make_shared<VoxelGrid>(*seen_hall(version, seen_m));
  grid->grown = hall(version, wall_m)->grown;
  return grid;
}

/// Eight metres that lead into the unseen, with the stop part that map 5 asks for.
CommittedTrajectory into_the_unseen() {
  const CommittedTrajectory whole = eight_metres(17);
  auto stop = latest_stop(whole.nominal(), FreeSpace(seen_hall(5, 8.0)), 0.0).value();
  EXPECT_TRUE(stop);
  return CommittedTrajectory::make(
             {.id = 17, .nominal = whole.nominal(), .stop = *std::move(stop), .map_version = 5})
      .value();
}

TEST(MapInFlight, WhatHasAStopPartGoesOnAsFarAsANewObstacleAllowsAndNothingIsLost) {
  Flown flown;
  flown.tracker.set_map(seen_hall(5, 8.0), 0);
  ASSERT_TRUE(flown.tracker.accept(into_the_unseen(), 0));
  flown.until(2.0);
  flown.tracker.set_map(seen_hall_with_wall(6, 8.0, 6.0), flown.now_ns());
  EXPECT_EQ(flown.tracker.status().fault.code, ErrorCode::ok);
  EXPECT_EQ(flown.tracker.status().mode, Mode::follow);
  flown.until(3.0);
  const FlatState planned = into_the_unseen().nominal().trajectory().sample(flown.time_s - 0.01);
  EXPECT_LT(largest_difference(flown.tracker.status().reference, planned), 1e-9) << "at full speed";
  flown.until(9.0);
  EXPECT_EQ(flown.tracker.status().mode, Mode::hold);
  EXPECT_EQ(flown.tracker.status().lost_trajectory_id, 0U);
  EXPECT_LT(flown.farthest_x_m, 6.0 + 1e-9);
  EXPECT_GT(flown.farthest_x_m, 5.5);
}

TEST(MapInFlight, IfNoSoonerStopFitsItIsBrakedForAtOnce) {
  Flown flown;
  flown.tracker.set_map(seen_hall(5, 8.0), 0);
  ASSERT_TRUE(flown.tracker.accept(into_the_unseen(), 0));
  flown.until(3.74);
  flown.tracker.set_map(seen_hall_with_wall(6, 8.0, 4.8), flown.now_ns());
  EXPECT_EQ(flown.tracker.status().lost_trajectory_id, 17U);
  flown.until(9.0);
  EXPECT_LT(flown.farthest_x_m, 4.8 + 1e-9);
}

// Too near for any stop that its limits allow: it still brakes, and says so.
TEST(MapInFlight, IfNoStopIsFreeTheOneThatMeetsTheObstacleLastIsFlown) {
  Flown flown;
  flown.tracker.set_map(hall(5), 0);
  ASSERT_TRUE(flown.tracker.accept(eight_metres(), 0));
  flown.until(3.74);
  flown.tracker.set_map(hall(6, 4.2), flown.now_ns());
  EXPECT_THAT(flown.tracker.status().fault.message, HasSubstr("no stop within the limits"));
  flown.until(6.0);
  EXPECT_EQ(flown.tracker.status().mode, Mode::hold);
  EXPECT_LT(flown.farthest_x_m, 4.62);
}

TEST(MapInFlight, AStopThatBecomesBlockedIsReplaced) {
  Flown flown;
  flown.tracker.set_map(hall(5), 0);
  ASSERT_TRUE(flown.tracker.accept(eight_metres(), 0));
  flown.until(3.74);
  flown.tracker.set_map(hall(6, 6.0), flown.now_ns());  // a gentle stop ends at 5 m
  flown.until(3.8);
  flown.tracker.set_map(hall(7, 4.8), flown.now_ns());
  EXPECT_THAT(flown.tracker.status().fault.message, HasSubstr("map 7"));
  flown.until(6.0);
  EXPECT_LT(flown.farthest_x_m, 4.8 + 1e-9);
}

TEST(MapInFlight, ATrajectoryThatWaitsAndIsBlockedIsDroppedAndThePresentOneGoesOn) {
  Flown flown;
  flown.tracker.set_map(hall(5), 0);
  ASSERT_TRUE(flown.tracker.accept(eight_metres(1), 0));
  flown.until(2.0);
  // From the first trajectory's state at 3 s to a place beside it.
  Draft aside;
  aside.id = 2;
  const Draft first = straight_line({0, 0, 1}, {8, 0, 1}, 7.5);
  aside.trajectory.pieces = {
      BezierPiece::between(first.trajectory.sample(3.0), {.position = {4.5, 3.0, 1.0}}, 4.0)};
  aside.start_time_ns = in_ns(3.0);
  certify_as_is(aside);
  ASSERT_TRUE(flown.tracker.accept(aside, flown.now_ns()));
  auto beside = std::make_shared<VoxelGrid>(*hall(6));
  for (int z = 4; z < 6; ++z) beside->grown.set_run(0, 100, 60, z, true);  // at y = 2 m
  flown.tracker.set_map(beside, flown.now_ns());
  const auto status = flown.tracker.status();
  EXPECT_EQ(status.queued, 0);
  EXPECT_EQ(status.lost_trajectory_id, 2U);
  EXPECT_EQ(status.fault.code, ErrorCode::trajectory_blocked);
  EXPECT_THAT(status.fault.message, HasSubstr("trajectory 2 is dropped"));
  flown.until(8.0);
  EXPECT_NEAR(flown.farthest_x_m, 8.0, 1e-9);
}

// Blocked only behind the moment at which the next trajectory leaves it: nothing is lost.
TEST(MapInFlight, OfThePresentTrajectoryOnlyWhatIsFlownCounts) {
  Flown flown;
  flown.tracker.set_map(hall(5), 0);
  ASSERT_TRUE(flown.tracker.accept(eight_metres(1), 0));
  flown.until(2.0);
  Draft stop;
  stop.id = 2;
  const Draft first = straight_line({0, 0, 1}, {8, 0, 1}, 7.5);
  stop.trajectory.pieces = {
      BezierPiece::between(first.trajectory.sample(3.0), {.position = {4.0, 0.0, 1.0}}, 2.0)};
  stop.start_time_ns = in_ns(3.0);
  certify_as_is(stop);
  ASSERT_TRUE(flown.tracker.accept(stop, flown.now_ns()));
  flown.tracker.set_map(hall(6, 7.0), flown.now_ns());
  EXPECT_EQ(flown.tracker.status().fault.code, ErrorCode::ok);
  flown.until(6.0);
  EXPECT_EQ(flown.tracker.status().fault.code, ErrorCode::ok);
  EXPECT_LT(flown.farthest_x_m, 4.01);
}

TEST(MapInFlight, BothThatAreLostByOneObstacleAreLostUnderTheNewestName) {
  Flown flown;
  flown.tracker.set_map(hall(5), 0);
  ASSERT_TRUE(flown.tracker.accept(eight_metres(1), 0));
  flown.until(2.0);
  const auto second = [&] {
    Draft draft;
    draft.id = 2;
    const Draft first = straight_line({0, 0, 1}, {8, 0, 1}, 7.5);
    draft.trajectory.pieces = {
        BezierPiece::between(first.trajectory.sample(5.0), {.position = {8, 1, 1}}, 4.0)};
    draft.start_time_ns = in_ns(5.0);
    certify_as_is(draft);
    return draft;
  }();
  ASSERT_TRUE(flown.tracker.accept(second, flown.now_ns()));
  flown.tracker.set_map(hall(6, 4.0), flown.now_ns());
  EXPECT_EQ(flown.tracker.status().lost_trajectory_id, 2U);
  EXPECT_EQ(flown.tracker.status().queued, 0);
  flown.until(6.0);
  EXPECT_LT(flown.farthest_x_m, 4.0 + 1e-9);
}

// A stop after a stall: with the map, the one that is free and not the shortest.
TEST(MapInFlight, AStopWhereTheVehicleIsKeepsClearOfTheMap) {
  for (const double wall_m : {4.8, 10.0}) {
    Flown flown;
    flown.tracker.set_map(hall(5, wall_m > 9.0 ? std::nullopt : std::optional(9.0)), 0);
    ASSERT_TRUE(flown.tracker.accept(eight_metres(), 0));
    flown.until(3.74);
    const FlatState vehicle = flown.tracker.status().reference;
    auto grid = std::make_shared<VoxelGrid>(*hall(6, 4.8));
    flown.tracker.set_map(wall_m > 9.0 ? hall(6) : grid, flown.now_ns());
    // 0.3 s later, by the vehicle's own momentum.
    RigidBodyState state = state_at(vehicle);
    state.position_map += 0.1 * vehicle.velocity;
    const double stalled_s = flown.time_s + 0.3;
    ASSERT_TRUE(flown.tracker.step(state, in_ns(stalled_s)));
    flown.time_s = stalled_s + 0.01;
    flown.farthest_x_m = flown.hardest_m_s2 = 0.0;
    flown.until(flown.time_s + 3.0);
    EXPECT_EQ(flown.tracker.status().mode, Mode::hold);
    if (wall_m > 9.0) {
      EXPECT_GT(flown.farthest_x_m, 4.9) << "gentle";
    } else {
      EXPECT_LT(flown.farthest_x_m, 4.8 + 1e-9);
    }
  }
}

TEST(MapInFlight, AVetoDropsWhatWaitsAndBrakesForWhatIsFlown) {
  Flown flown;
  flown.tracker.set_map(hall(5), 0);
  ASSERT_TRUE(flown.tracker.accept(eight_metres(1), 0));
  flown.until(3.0);
  flown.tracker.veto(99, "another one", flown.now_ns());
  EXPECT_EQ(flown.tracker.status().fault.code, ErrorCode::ok);
  flown.tracker.veto(1, "touches at (7, 0, 1) m", flown.now_ns());
  const auto status = flown.tracker.status();
  EXPECT_EQ(status.fault.code, ErrorCode::collision);
  EXPECT_EQ(status.lost_trajectory_id, 1U);
  EXPECT_THAT(status.fault.message, HasSubstr("touches at (7, 0, 1) m"));
  flown.until(6.0);
  EXPECT_EQ(flown.tracker.status().mode, Mode::hold);
  EXPECT_LT(flown.farthest_x_m, 4.0);

  Flown other;
  other.tracker.set_map(hall(5), 0);
  ASSERT_TRUE(other.tracker.accept(eight_metres(1), in_ns(1.0), 0));
  other.tracker.veto(1, "touches", 0);
  EXPECT_EQ(other.tracker.status().queued, 0);
  other.until(3.0);
  EXPECT_LT(other.farthest_x_m, 1e-9);
}

}  // namespace
}  // namespace goshawk::tracker
