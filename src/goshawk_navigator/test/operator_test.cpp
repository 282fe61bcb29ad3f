#include <cmath>

#include "harness.hpp"

namespace goshawk::navigator {
namespace {

using testing::HasSubstr;

/// In flight to kGoal, at its fastest.
Harness in_fast_flight() {
  Harness h;
  h.goal(kGoal);
  h.answer();
  h.pass(2.0);
  return h;
}

TEST(Operator, HoldBrakesOnThePathThatIsFlownAndTellsSo) {
  Harness h = in_fast_flight();
  const double speed_m_s = h.vehicle().velocity.norm();
  ASSERT_GT(speed_m_s, 1.0);
  h.navigator.hold(h.now);
  h.take();
  ASSERT_EQ(h.commits.size(), 2u);
  EXPECT_EQ(h.last().state, State::held);
  EXPECT_THAT(h.last().reason.message, HasSubstr("operator"));
  h.pass(5.0);
  EXPECT_LT(h.vehicle().velocity.norm(), 1e-6);
  EXPECT_LT(h.vehicle().position.x(), kGoal.x() - 0.5);
  EXPECT_NEAR(h.vehicle().position.y(), 0.0, 1e-6);  // on the line
  EXPECT_EQ(h.last().state, State::held);
  EXPECT_EQ(h.plans.size(), 1u);
}

TEST(Operator, HoldNeedsNoStageThatPlansAndDropsAnOpenRequest) {
  Harness h = in_fast_flight();
  h.goal({0, 9, 1});  // nobody answers
  h.navigator.hold(h.now);
  h.take();
  EXPECT_EQ(h.last().state, State::held);
  h.answer();  // too late: it was given up
  h.pass(5.0);
  EXPECT_EQ(h.last().state, State::held);
  EXPECT_LT(h.vehicle().velocity.norm(), 1e-6);
  EXPECT_NEAR(h.vehicle().position.y(), 0.0, 1e-6);
}

TEST(Operator, HoldAtRestKeepsAPlanFromBeginning) {
  Harness h;
  h.goal(kGoal);
  h.navigator.hold(h.now);
  h.take();
  h.answer();
  h.pass(1.0);
  EXPECT_TRUE(h.commits.empty());
  EXPECT_EQ(h.last().state, State::held);
}

TEST(Operator, AHeldVehicleStaysHeldWhateverTheMapAndTheTrackerSay) {
  Harness h = in_fast_flight();
  h.navigator.hold(h.now);
  h.take();
  h.map(map_with_wall(50.0, 6));
  h.tracker_says(h.commits.back().id(), {ErrorCode::tracking_lost, "a gust"});
  h.pass(8.0);
  EXPECT_EQ(h.last().state, State::held);
  EXPECT_EQ(h.plans.size(), 1u);
}

TEST(Operator, BeforeANewObstacleAHeldVehicleStillBrakes) {
  Harness h = in_fast_flight();
  const double wall_x_m = 3.0;
  h.navigator.hold(h.now);
  h.take();
  h.map(map_with_wall(wall_x_m, 6));
  h.pass(6.0);
  EXPECT_EQ(h.last().state, State::held);
  EXPECT_LT(h.vehicle().position.x(), wall_x_m);
}

TEST(Operator, ResumePursuesTheHeldGoalAndNothingElse) {
  Harness h = in_fast_flight();
  EXPECT_THAT(h.navigator.resume_held(h.now).error().message, HasSubstr("is flying"));
  h.navigator.hold(h.now);
  h.pass(5.0);
  ASSERT_TRUE(h.navigator.resume_held(h.now));
  h.take();
  ASSERT_EQ(h.plans.size(), 2u);
  EXPECT_EQ(h.plans[1].goal.position, kGoal);
  h.answer();
  h.pass(5.0);
  EXPECT_EQ(h.last().state, State::arrived);
  EXPECT_FALSE(h.navigator.resume_held(h.now));
}

TEST(Operator, ANewGoalEndsAHold) {
  Harness h = in_fast_flight();
  h.navigator.hold(h.now);
  h.goal(kHome);
  EXPECT_EQ(h.last().state, State::flying);
  EXPECT_EQ(h.plans.back().goal.position, kHome);
}

TEST(Operator, HoldWithoutAGoalChangesNothing) {
  Harness h;
  h.navigator.hold(h.now);
  h.take();
  EXPECT_TRUE(h.states.empty());
  EXPECT_EQ(h.navigator.state(), State::idle);
}

TEST(Operator, ARestartedNavigatorKeepsHolding) {
  Harness h = in_fast_flight();
  h.navigator.hold(h.now);
  h.take();
  Harness other;
  other.navigator.resume(h.navigator.memory(), h.now);
  other.now = h.now;
  other.take();
  EXPECT_EQ(other.last().state, State::held);
  EXPECT_TRUE(other.navigator.resume_held(other.now));
  other.take();
  EXPECT_EQ(other.plans.back().goal.position, kGoal);
}

/// The map of the harness with a floor: occupied up to z around the origin.
VoxelGrid map_with_floor(double z_m) {
  VoxelGrid grid = free_map(7);
  for (int z = 0; z < int(z_m) + 100; ++z) {
    for (int y = 80; y < 120; ++y) {
      for (int x = 80; x < 120; ++x) grid.grown.set({x, y, z}, true);
    }
  }
  return grid;
}

TEST(Operator, LandingGoesAsFarDownAsTheMapShowsFreeAndSlowly) {
  Harness h;
  h.map(map_with_floor(-3.0));
  const auto descent = h.navigator.land(h.now);
  ASSERT_TRUE(descent) << descent.error().message;
  EXPECT_EQ(descent->end_map, Vec3(0, 0, -2.5));  // the middle of the lowest free voxel
  EXPECT_EQ(descent->below, Descent::Below::obstacle);
  h.take();
  EXPECT_EQ(h.plans.back().goal.position, descent->end_map);
  EXPECT_EQ(h.plans.back().limits.v_max_m_s, Config{}.operator_speed_m_s);
}

TEST(Operator, LandingEndsBeforeWhatWasNeverSeenAndAtTheMapsFloor) {
  Harness h;
  const auto floor = h.navigator.land(h.now);
  ASSERT_TRUE(floor);
  EXPECT_EQ(floor->below, Descent::Below::map_floor);
  EXPECT_EQ(floor->end_map.z(), -99.5);

  VoxelGrid grid = free_map(8);
  grid.known = BitGrid(grid.geometry.size, true);
  for (int z = 0; z < 200; ++z) {
    for (int y = 0; y < 200; ++y) {
      for (int x = 0; x < 200; ++x) grid.known.set({x, y, z}, z >= 98);
    }
  }
  grid.unknown_is_occupied = false;
  h.map(std::move(grid));
  const auto unseen = h.navigator.land(h.now);
  ASSERT_TRUE(unseen) << unseen.error().message;
  EXPECT_EQ(unseen->below, Descent::Below::unknown);
  EXPECT_EQ(unseen->end_map.z(), -1.5);
}

TEST(Operator, LandingKeepsTheBodyInsideTheMap) {
  Harness h;
  VoxelGrid grid = free_map(9);
  grid.inflation_m = 1.6;
  h.map(std::move(grid));
  const auto descent = h.navigator.land(h.now);
  ASSERT_TRUE(descent);
  EXPECT_EQ(descent->end_map.z(), -97.5);  // -98.5 would be nearer to the floor than 1.6 m
  EXPECT_EQ(descent->below, Descent::Below::map_floor);
}

TEST(Operator, LandingInFlightGoesDownWhereTheVehicleComesToRest) {
  Harness h = in_fast_flight();
  h.map(map_with_floor(-3.0));
  const auto descent = h.navigator.land(h.now);
  ASSERT_TRUE(descent);
  h.take();
  ASSERT_EQ(h.commits.size(), 2u);
  const Trajectory& braked = h.commits[1].flown();
  const Vec3 end = braked.sample(braked.duration_s()).position;
  EXPECT_EQ(descent->end_map.x(), end.x());
  EXPECT_LT(end.x(), kGoal.x() - 0.5);
}

TEST(Operator, LandingNeedsAMapOdometryAndAPlaceThatIsFree) {
  Navigator blind(wide(), 1);
  EXPECT_EQ(blind.land(kSecond).code(), ErrorCode::tracking_lost);
  blind.on_odometry(at(kHome), kSecond);
  EXPECT_EQ(blind.land(kSecond).code(), ErrorCode::no_map);
  Harness h;
  h.map(map_with_floor(5.0));
  EXPECT_EQ(h.navigator.land(h.now).code(), ErrorCode::start_occupied);
  EXPECT_EQ(h.navigator.state(), State::idle);
}

// Where it would come to rest the map is occupied or unseen for planning, not for flying.
TEST(Operator, ALandingThatIsRefusedInFlightChangesNothing) {
  Harness h = in_fast_flight();
  VoxelGrid grid = free_map(6);
  grid.raw = BitGrid(grid.geometry.size, true, false);
  grid.grown.set({102, 100, 101}, true);  // in the reserve of plans: 2 m < x < 3 m
  grid.unknown_is_occupied = false;
  grid.known = BitGrid(grid.geometry.size, false, true);
  h.map(std::move(grid));
  ASSERT_EQ(h.commits.size(), 1u);
  EXPECT_EQ(h.navigator.land(h.now).code(), ErrorCode::start_occupied);
  h.take();
  EXPECT_EQ(h.commits.size(), 1u);
  EXPECT_EQ(h.last().state, State::flying);
  h.pass(4.0);
  EXPECT_EQ(h.last().state, State::arrived);
  EXPECT_LT((h.vehicle().position - kGoal).norm(), 1e-6);
}

TEST(Operator, TakeoffClimbsStraightUpByAHeight) {
  Harness h;
  const auto place = h.navigator.take_off(1.5, h.now);
  ASSERT_TRUE(place);
  EXPECT_EQ(*place, kHome + Vec3(0, 0, 1.5));
  h.take();
  EXPECT_EQ(h.plans.back().goal.position, *place);
  EXPECT_EQ(h.plans.back().limits.v_max_m_s, Config{}.operator_speed_m_s);
  for (const double bad : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    EXPECT_EQ(h.navigator.take_off(bad, h.now).code(), ErrorCode::invalid_input);
  }
}

TEST(Operator, AGoalsOwnSpeedLimitHoldsForItAloneAndNeverRaisesTheParameters) {
  Harness h;
  const auto asked = [&](double v_max_m_s) {
    EXPECT_TRUE(h.navigator.on_goal(Goal{kGoal, 0.0, v_max_m_s}, h.now));
    h.take();
    return h.plans.back().limits.v_max_m_s;
  };
  EXPECT_EQ(asked(0.8), 0.8);
  EXPECT_EQ(asked(1000.0), wide().v_max_m_s);
  EXPECT_EQ(asked(0.0), wide().v_max_m_s);
  for (const double bad : {-1.0, std::nan("")}) {
    EXPECT_EQ(h.navigator.on_goal(Goal{kGoal, 0.0, bad}, h.now).code(), ErrorCode::invalid_input);
  }
}

}  // namespace
}  // namespace goshawk::navigator
