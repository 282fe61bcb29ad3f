// What the navigator does in a world that it sees as it flies.
#include <algorithm>

#include "harness.hpp"

namespace goshawk::navigator {
namespace {

using testing::HasSubstr;

const Vec3 kFar(12, 0, 1);

/// Free, in voxels of a metre, and seen only below x = seen_m; the body takes a voxel more.
VoxelGrid seen_below(int seen_m, std::uint64_t version) {
  VoxelGrid grid = free_map(version);
  grid.known = BitGrid(grid.geometry.size, false);
  for (int z = 0; z < 200; ++z) {
    for (int y = 0; y < 200; ++y) grid.known.set_run(0, 100 + seen_m, y, z, true);
  }
  grid.unknown_is_occupied = false;
  grid.inflation_m = 0.2;
  return grid;
}

/// On the way to kFar, which is not seen yet.
Harness approaching(int seen_m = 7, const Config& config = {}) {
  Harness h(config);
  h.map(seen_below(seen_m, 6));
  h.map_version = 6;
  h.goal(kFar);
  h.answer(12.0);
  return h;
}

/// Until the navigator has asked for another plan.
void await_request(Harness& h) {
  const std::size_t asked = h.plans.size();
  for (int i = 0; i < 100 && h.plans.size() == asked; ++i) h.pass(0.02);
  ASSERT_GT(h.plans.size(), asked);
}

double rest_x(const CommittedTrajectory& committed) {
  return committed.flown().sample(committed.flown().duration_s()).position.x();
}

TEST(Replanning, WhatLeadsIntoUnseenSpaceStopsBeforeItAndNamesTheMap) {
  const Harness h = approaching();
  ASSERT_EQ(h.commits.size(), 1u);
  ASSERT_TRUE(h.commits[0].stop());
  EXPECT_GT(rest_x(h.commits[0]), 5.5);
  EXPECT_LT(rest_x(h.commits[0]), 6.0 + 1e-6);
  EXPECT_EQ(h.commits[0].map_version(), 6u);
  EXPECT_EQ(h.last().state, State::flying);
}

TEST(Replanning, InSeenSpaceNothingIsAddedAndNothingAskedFor) {
  Harness h = approaching(50);
  EXPECT_FALSE(h.commits.at(0).stop());
  h.pass(3.0);
  EXPECT_EQ(h.plans.size(), 1u);
}

TEST(Replanning, IfUnseenSpaceMayBeFlownThroughThereIsNoStop) {
  Config config;
  config.fly_unknown = true;
  const Harness h = approaching(7, config);
  ASSERT_EQ(h.commits.size(), 1u);
  EXPECT_FALSE(h.commits[0].stop());
}

TEST(Replanning, WhatIsSeenMovesTheStopOfTheSamePlan) {
  Harness h = approaching();
  h.pass(1.0);
  h.map(seen_below(9, 7));
  ASSERT_EQ(h.commits.size(), 2u);
  const CommittedTrajectory &before = h.commits[0], &after = h.commits[1];
  EXPECT_NE(after.id(), before.id());
  EXPECT_EQ(after.start_time_ns(), before.start_time_ns());
  EXPECT_GT(after.stop()->after_s, before.stop()->after_s + 0.5);
  EXPECT_LT(rest_x(after), 8.0 + 1e-6);
  EXPECT_EQ(after.map_version(), 7u);
  EXPECT_LT(largest_difference(after.flown().sample(1.0), before.flown().sample(1.0)), 1e-9);
  h.map(seen_below(99, 8));
  EXPECT_FALSE(h.commits.back().stop()) << "seen to the goal";
  h.pass(14.0);
  EXPECT_EQ(h.last().state, State::arrived);
}

TEST(Replanning, AMapThatShowsNoMoreOfTheWayChangesNothing) {
  Harness h = approaching();
  h.pass(1.0);
  h.map(seen_below(7, 7));
  EXPECT_EQ(h.commits.size(), 1u);
}

TEST(Replanning, TheTrackersRefusalOfALaterStopLeavesTheEarlierOne) {
  Harness h = approaching();
  h.tracker_says(h.commits[0].id(), ok());
  h.pass(1.0);
  h.map(seen_below(9, 7));
  ASSERT_EQ(h.commits.size(), 2u);
  h.pass(0.1);
  h.tracker_says(h.commits[1].id(), {ErrorCode::no_map, "map 7 has not come"});
  ASSERT_EQ(h.navigator.memory().legs.size(), 1u);
  EXPECT_EQ(h.navigator.memory().legs[0].id(), h.commits[0].id());
  EXPECT_EQ(h.last().state, State::flying);
}

TEST(Replanning, ALaterStopThatGaveWayToAnEvenLaterOneIsForgottenAlone) {
  Harness h = approaching();
  h.tracker_says(h.commits[0].id(), ok());
  h.pass(1.0);
  h.map(seen_below(9, 7));
  h.map(seen_below(10, 8));
  ASSERT_EQ(h.commits.size(), 3u);
  h.tracker_says(h.commits[1].id(), {ErrorCode::cancelled, "a newer one has come"});
  h.tracker_says(h.commits[2].id(), ok());
  h.pass(0.1);
  const auto legs = h.navigator.memory().legs;
  ASSERT_EQ(legs.size(), 1u);
  EXPECT_EQ(legs[0].id(), h.commits[2].id());
  EXPECT_EQ(h.last().state, State::flying);
}

TEST(Replanning, IfNothingComesTheVehicleRestsBeforeTheUnseenAndPlansAgainFromThere) {
  Harness h = approaching();
  h.pass(9.5);
  EXPECT_LT(h.vehicle().velocity.norm(), 1e-6);
  EXPECT_LT(h.vehicle().position.x(), 6.0 + 1e-6);
  EXPECT_NE(h.last().state, State::arrived);
  const PlanRequest& newest = h.plans.back();
  EXPECT_FALSE(newest.start_time_ns) << "from rest";
  EXPECT_EQ(newest.goal.position, kFar);
  h.map(seen_below(99, 7));
  h.map_version = 7;
  h.answer(8.0);
  h.pass(9.0);
  EXPECT_EQ(h.last().state, State::arrived);
}

TEST(Replanning, BetterPlansAreAskedForTwentyTimesASecondTheNewestReplacesTheOneBefore) {
  Harness h = approaching();
  const std::size_t before = h.plans.size();
  h.pass(1.0);  // nobody answers
  EXPECT_GE(h.plans.size(), before + 3);
  EXPECT_EQ(h.plans.back().supersedes, h.plans[h.plans.size() - 2].id);
  for (int i = 0; i < 40; ++i) {
    h.answer(12.0 - double(h.now - h.commits[0].start_time_ns()) * 1e-9);
    h.pass(0.02);
  }
  const std::size_t answered = h.plans.size();
  for (int i = 0; i < 50; ++i) {
    h.answer(12.0 - double(h.now - h.commits[0].start_time_ns()) * 1e-9);
    h.pass(0.02);
  }
  EXPECT_GE(h.plans.size(), answered + 16) << "in one second";
  EXPECT_TRUE(h.plans.back().start_time_ns);
}

TEST(Replanning, APlanThatIsHardlyBetterReplacesNothingOneThatArrivesSoonerDoes) {
  Harness h = approaching();
  h.pass(2.0);
  const auto left_s = [&] {
    const auto end_ns = h.commits[0].start_time_ns() + std::int64_t(12.0 * 1e9);
    return double(end_ns - *h.plans.back().start_time_ns) * 1e-9;
  };
  await_request(h);
  h.answer(left_s() - 0.1);
  EXPECT_EQ(h.commits.size(), 1u);
  await_request(h);
  h.answer(left_s() - 2.0);
  ASSERT_EQ(h.commits.size(), 2u);
  EXPECT_EQ(h.commits[1].id(), h.plans.back().id);
  // It begins on what was flown.
  const double from_s = double(h.commits[1].start_time_ns() - h.commits[0].start_time_ns()) * 1e-9;
  EXPECT_LT(
      largest_difference(h.commits[1].flown().sample(0.0), h.commits[0].flown().sample(from_s)),
      1e-6);
}

TEST(Replanning, APlanThatTurnsOutBlockedIsReplacedByAnyOther) {
  Harness h = approaching();
  h.pass(2.0);
  VoxelGrid grid = seen_below(7, 7);
  for (int y = 99; y <= 100; ++y) {
    for (int z = 100; z <= 101; ++z) grid.grown.set({109, y, z}, true);  // beyond the stop
  }
  h.map(std::move(grid));
  EXPECT_EQ(h.commits.size(), 1u) << "what is flown is free";
  await_request(h);
  // Around it, at leisure.
  const PlanRequest request = h.plans.back();
  Trajectory around{
      {BezierPiece::between(request.start, {.position = Vec3(8, 5, 1), .velocity = Vec3(1, 1, 0)},
                            8.0),
       BezierPiece::between({.position = Vec3(8, 5, 1), .velocity = Vec3(1, 1, 0)}, request.goal,
                            9.0)}};
  const std::vector room{Polytope::box(Vec3::Constant(-99), Vec3::Constant(99))};
  h.navigator.on_trajectory(
      {.id = request.id,
       .nominal =
           certify(std::move(around), room, request.limits, request.start, request.goal).value(),
       .map_version = 7},
      99, h.now);
  h.take();
  ASSERT_EQ(h.commits.size(), 2u);
  EXPECT_TRUE(h.commits[1].stop());
}

TEST(Replanning, AnObstacleFoundOnTheWayMovesTheStopSoonerAndAPlanIsAskedForAtOnce) {
  Harness h = approaching();
  h.pass(1.0);
  const auto id = h.plans.back().id;
  VoxelGrid grid = seen_below(7, 7);
  for (int y = 98; y <= 102; ++y) {
    for (int z = 98; z <= 103; ++z) grid.grown.set({104, y, z}, true);  // before the stop
  }
  h.map(std::move(grid));
  ASSERT_EQ(h.commits.size(), 2u);
  const CommittedTrajectory &before = h.commits[0], &after = h.commits[1];
  ASSERT_TRUE(after.stop());
  EXPECT_LT(rest_x(after), 4.0 + 1e-6);
  EXPECT_GT(after.stop()->after_s, 1.2) << "not at once";
  EXPECT_LT(largest_difference(after.flown().sample(1.2), before.flown().sample(1.2)), 1e-9);
  EXPECT_EQ(h.last().state, State::flying);
  h.pass(0.1);
  EXPECT_GT(h.plans.back().id, id);
  EXPECT_TRUE(h.plans.back().start_time_ns) << "in flight";
}

TEST(Replanning, ANewMapSupersedesThePlanThatIsAwaitedButNotTwiceInARow) {
  Harness h = approaching();
  await_request(h);
  const PlanRequest before = h.plans.back();
  h.map(seen_below(7, 7));
  const PlanRequest asked = h.plans.back();
  EXPECT_EQ(asked.supersedes, before.id) << "at once";
  h.map(seen_below(7, 8));
  EXPECT_EQ(h.plans.back().id, asked.id) << "it is waited for";
  h.fails(ErrorCode::no_path, StageRole::path_search);
  h.pass(0.2);
  h.map(seen_below(7, 9));
  EXPECT_EQ(h.plans.back().stamp_ns, h.now);
}

/// Commits a plan whose path goes on for 8 m beyond its end.
Harness within_its_horizon() {
  Harness h;
  h.map(seen_below(50, 6));
  h.map_version = 6;
  h.goal(kFar);
  h.answer_up_to(Vec3(4, 0, 1), 8.0, 5.0);
  return h;
}

TEST(Replanning, APlanThatEndsAtItsHorizonIsPlannedOnBeforeItBrakes) {
  Harness h = within_its_horizon();
  ASSERT_EQ(h.commits.size(), 1u);
  EXPECT_FALSE(h.commits[0].stop());
  h.pass(0.5);
  ASSERT_GE(h.plans.size(), 2u);
  EXPECT_EQ(h.plans.back().goal.position, kFar) << "the request is for the goal itself";
  ASSERT_TRUE(h.plans.back().start_time_ns);
  h.answer(4.4);
  ASSERT_EQ(h.commits.size(), 2u);
  h.pass(6.0);
  EXPECT_EQ(h.last().state, State::arrived);
  EXPECT_LT((h.vehicle().position - kFar).norm(), 1e-6);
}

TEST(Replanning, IfNoPlanFollowsTheVehicleRestsAtItsHorizonAndHasNotArrived) {
  Harness h = within_its_horizon();
  h.pass(7.0);
  EXPECT_LT((h.vehicle().position - Vec3(4, 0, 1)).norm(), 1e-6);
  EXPECT_NE(h.last().state, State::arrived);
  EXPECT_FALSE(h.plans.back().start_time_ns) << "from rest";
  EXPECT_EQ(h.plans.back().goal.position, kFar);
}

TEST(Replanning, APlanThatEndsBeforeTheGoalWithoutSayingSoIsRefused) {
  Harness h;
  h.map(seen_below(50, 6));
  h.map_version = 6;
  h.goal(kFar);
  h.answer_up_to(Vec3(4, 0, 1), 7.0, 5.0);  // it is 8 m to the goal
  EXPECT_TRUE(h.commits.empty());
  ASSERT_EQ(h.complaints.size(), 1u);
  EXPECT_THAT(h.complaints[0].reason.message, HasSubstr("from the goal"));
}

TEST(Replanning, AnAnswerThatComesTooLateOrFailsChangesNothing) {
  Harness h = approaching();
  h.pass(1.0);
  const std::size_t states = h.states.size();
  const PlanRequest request = h.plans.back();
  h.fails(ErrorCode::no_path, StageRole::path_search);
  h.pass(0.5);
  h.navigator.on_trajectory(h.solve(request, 9.0), 50, h.now);
  h.take();
  EXPECT_EQ(h.commits.size(), 1u);
  EXPECT_EQ(h.states.size(), states);
  EXPECT_GT(h.plans.back().id, request.id) << "asked again";
}

TEST(Replanning, AGoalThatTurnsOutOccupiedIsApproachedThenRefusedWithItsReason) {
  Harness h = approaching();
  h.pass(9.5);
  EXPECT_GT(h.vehicle().position.x(), 5.5);
  h.fails(ErrorCode::goal_occupied, StageRole::path_search, "the goal is in an obstacle");
  h.pass(0.3);
  EXPECT_EQ(h.last().state, State::failed);
  EXPECT_EQ(h.last().reason.code, ErrorCode::goal_occupied);
}

TEST(Replanning, FromRestNothingBeginsThatLeadsAtOnceIntoUnseenSpaceUntilAMapShowsMore) {
  Harness h;
  h.map(seen_below(1, 6));
  h.map_version = 6;
  h.goal(kFar);
  for (int i = 0; i < 10 && h.last().state != State::failed; ++i) {
    h.answer(12.0);
    h.pass(0.25);
  }
  EXPECT_TRUE(h.commits.empty());
  EXPECT_EQ(h.last().state, State::failed);
  EXPECT_EQ(h.last().reason.code, ErrorCode::trajectory_blocked);
  h.map(seen_below(9, 7));
  h.map_version = 7;
  h.pass(0.3);
  h.answer(12.0);
  EXPECT_EQ(h.commits.size(), 1u);
}

TEST(Replanning, FromRestTheVehicleLooksWhereTheWayLeadsIntoUnseenSpaceAndThenPlansAgain) {
  Harness h;
  h.yaw_rad = 2.0;
  h.pass(0.1);
  h.map(seen_below(1, 6));
  h.map_version = 6;
  h.goal(kFar);
  h.answer(12.0);
  ASSERT_EQ(h.commits.size(), 1u) << "a turn";
  const CommittedTrajectory turn = h.commits[0];
  EXPECT_NEAR(turn.yaw_at(0.0), 0.0, 1e-9);
  EXPECT_LT((turn.flown().sample(turn.flown().duration_s()).position - kHome).norm(), 1e-9);
  EXPECT_EQ(h.last().state, State::flying);
  EXPECT_EQ(h.plans.size(), 1u);
  h.tracker_says(turn.id(), ok());
  h.yaw_rad = 0.0;
  h.map(seen_below(9, 7));
  h.map_version = 7;
  h.pass(turn.flown().duration_s() + 0.2);
  ASSERT_EQ(h.plans.size(), 2u);
  h.answer(12.0);
  ASSERT_EQ(h.commits.size(), 2u);
  EXPECT_GT(rest_x(h.commits[1]), 5.0);
}

TEST(Replanning, WhatIsForgottenIsNotFlownInto) {
  Harness h = approaching(9);
  h.pass(3.0);
  h.map(seen_below(7, 7));
  ASSERT_GE(h.commits.size(), 2u);
  h.pass(10.0);
  EXPECT_LT(h.vehicle().position.x(), 6.0 + 1e-6);
}

TEST(Replanning, ANavigatorThatIsStartedAgainGoesOnToRestAndToTheGoal) {
  Harness h = approaching();
  h.pass(2.0);
  Memory memory = h.navigator.memory();
  Harness again;
  again.now = h.now;
  again.flown = h.flown;
  again.map(seen_below(7, 6));
  again.map_version = 6;
  again.navigator.resume(std::move(memory), again.now);
  again.take();
  again.pass(9.0);
  EXPECT_LT(again.vehicle().position.x(), 6.0 + 1e-6);
  EXPECT_EQ(again.plans.back().goal.position, kFar);
}

}  // namespace
}  // namespace goshawk::navigator
