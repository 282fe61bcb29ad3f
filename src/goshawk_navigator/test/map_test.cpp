// What the navigator does when the map changes.
#include "harness.hpp"

namespace goshawk::navigator {
namespace {

using testing::HasSubstr;

/// Halfway to kGoal at 1.9 m/s.
Harness in_flight() {
  Harness h;
  h.goal(Vec3(8, 0, 1));
  h.answer(8.0);
  h.pass(3.0);
  return h;
}

TEST(Map, AnObstacleOnTheWayIsBrakedForAndPlannedAroundAtOnce) {
  Harness h = in_flight();
  h.map(map_with_wall(7.0, 6));
  ASSERT_EQ(h.commits.size(), 2u);
  const Trajectory& brake = h.commits[1].flown();
  EXPECT_LT(brake.sample(brake.duration_s()).position.x(), 7.0);
  EXPECT_EQ(h.plans.size(), 2u) << "in the same moment";
  EXPECT_EQ(h.plans[1].goal.position, Vec3(8, 0, 1));
  EXPECT_EQ(h.last().state, State::flying);
  h.pass(6.0);
  EXPECT_LT(h.vehicle().position.x(), 7.0);
  EXPECT_EQ(h.vehicle().velocity, Vec3::Zero());
}

TEST(Map, WhatDoesNotMeetTheRestOfTheWayChangesNothing) {
  Harness h = in_flight();
  h.map(map_with_wall(-3.0, 6));  // behind
  h.map(map_with_wall(20.0, 7));  // beyond
  EXPECT_EQ(h.commits.size(), 1u);
  EXPECT_EQ(h.plans.size(), 1u);
  h.pass(7.0);
  EXPECT_EQ(h.navigator.state(), State::arrived);
}

TEST(Map, AnObstacleInTheWayOfWhatIsCommittedForLaterCounts) {
  Harness h = in_flight();
  h.goal(Vec3(5, 6, 1));
  h.answer(5.0);
  ASSERT_EQ(h.commits.size(), 2u);
  VoxelGrid grid = free_map(6);
  for (int x = 0; x < 200; ++x) {
    for (int z = 0; z < 200; ++z) grid.grown.set({x, 104, z}, true);
  }
  h.map(std::move(grid));
  EXPECT_EQ(h.commits.size(), 3u);
  EXPECT_EQ(h.plans.back().goal.position, Vec3(5, 6, 1));
}

TEST(Map, ThatBlocksEverythingForAMomentEndsNoGoal) {
  Harness h;
  h.map(map_with_wall(2.0, 6));
  h.pass(3.0);
  h.goal(kGoal);
  h.fails(ErrorCode::no_path, StageRole::path_search, "the goal is cut off");
  h.pass(0.3);
  EXPECT_EQ(h.last().state, State::failed);
  const std::size_t asked = h.plans.size();
  h.pass(1.0);
  h.map(free_map(7));
  h.pass(0.3);
  ASSERT_EQ(h.plans.size(), asked + 1);
  EXPECT_EQ(h.last().state, State::planning);
  h.map_version = 7;
  h.answer();
  h.pass(5.0);
  EXPECT_EQ(h.navigator.state(), State::arrived);
}

TEST(Map, ThatBlocksTheStartForAWhileEndsNoGoal) {
  Harness h;
  h.map(map_with_wall(2.0, 6));
  h.pass(3.0);
  h.goal(kGoal);
  for (int k = 0; k < 100 && h.last().state == State::planning; ++k) {
    h.fails(ErrorCode::start_occupied, StageRole::path_search, "the vehicle is inside the wall");
    h.pass(0.3);
  }
  ASSERT_EQ(h.last().state, State::failed);
  EXPECT_EQ(h.last().reason.code, ErrorCode::start_occupied);
  const std::size_t asked = h.plans.size();
  h.map(free_map(7));
  h.pass(0.3);
  ASSERT_EQ(h.plans.size(), asked + 1);
  h.map_version = 7;
  h.answer();
  h.pass(5.0);
  EXPECT_EQ(h.navigator.state(), State::arrived);
}

TEST(Map, ThatChangesWhileThePlanIsMadeIsReasonEnoughToAskAgain) {
  Harness h;
  h.pass(3.0);
  h.goal(kGoal);
  h.map(free_map(6));  // the search had an older one
  h.fails(ErrorCode::goal_occupied, StageRole::path_search);
  h.pass(0.5);
  EXPECT_EQ(h.plans.size(), 2u);
}

TEST(Map, ThatChangesLongAfterAGoalFailedIsNoReasonToFlyThere) {
  Harness h;
  h.pass(3.0);
  h.goal(kGoal);
  h.fails(ErrorCode::no_path, StageRole::path_search);
  h.pass(6.0);
  h.map(free_map(6));
  h.pass(1.0);
  EXPECT_EQ(h.plans.size(), 1u);
  EXPECT_EQ(h.last().state, State::failed);
}

TEST(Map, ThatGoesOnChangingAsksAtMostFiveTimesASecondAndOnlyForItsTime) {
  Harness h;
  h.pass(3.0);
  h.goal(kGoal);
  for (std::uint64_t version = 6; version < 600; ++version) {
    if (h.last().state == State::planning) h.fails(ErrorCode::no_path, StageRole::path_search);
    h.map(free_map(version));
    h.pass(0.02);
  }
  EXPECT_GT(h.plans.size(), 5u);
  EXPECT_LE(h.plans.size(), 27u);
  EXPECT_EQ(h.last().state, State::failed);
}

}  // namespace
}  // namespace goshawk::navigator
