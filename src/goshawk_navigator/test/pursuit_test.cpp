// The newest goal is pursued from other starts, then from rest, and the revoked one is not flown
// to.
#include "harness.hpp"

namespace goshawk::navigator {
namespace {

using testing::HasSubstr;
const Vec3 kAside(2, 3, 1);

/// In flight at 1.9 m/s towards kGoal, with a newer goal.
Harness with_goal_in_flight(double lead_s = 0.3) {
  Config config;
  config.replan_lead_s = lead_s;
  Harness h(config);
  h.goal(kGoal);
  h.answer();
  h.tracker_says(h.commits[0].id(), ok());
  h.pass(1.8);
  h.goal(kAside);
  return h;
}

TEST(Pursuit, AStartThatDoesNotDoIsFollowedByALaterOneAtOnce) {
  Harness h = with_goal_in_flight();
  h.fails(ErrorCode::start_infeasible);
  ASSERT_EQ(h.plans.size(), 3u);
  EXPECT_EQ(*h.plans[2].start_time_ns, h.now + kSecond * 6 / 10);
  EXPECT_EQ(h.plans[2].goal.position, kAside);
  EXPECT_EQ(h.last().state, State::flying);
  EXPECT_EQ(h.commits.size(), 1u) << "nothing is braked for yet";
  h.answer();
  h.pass(6.0);
  EXPECT_EQ(h.navigator.state(), State::arrived);
}

TEST(Pursuit, ThenTheVehicleBrakesAndAPlanBeginsOnTheWayToRest) {
  Harness h = with_goal_in_flight(0.1);
  h.fails(ErrorCode::start_infeasible);
  h.fails(ErrorCode::start_infeasible);
  ASSERT_EQ(h.commits.size(), 2u);
  const CommittedTrajectory& brake = h.commits[1];
  EXPECT_EQ(brake.start_time_ns(), h.now + kSecond / 20);
  EXPECT_TRUE(brake.nominal().ends_at_rest());
  EXPECT_LT(brake.flown().sample(brake.flown().duration_s()).position.x(), 3.5) << "not at kGoal";
  ASSERT_EQ(h.plans.size(), 4u);
  EXPECT_LT(h.plans[3].start.velocity.norm(), 1.5);
  EXPECT_GT(h.plans[3].start.velocity.norm(), 0.2);
  h.answer();
  h.pass(6.0);
  EXPECT_EQ(h.navigator.state(), State::arrived);
  EXPECT_EQ(h.vehicle().position, kAside);
}

TEST(Pursuit, AndAtLastFromWhereItWillRest) {
  Harness h = with_goal_in_flight();
  for (int i = 0; i < 3; ++i) h.fails(ErrorCode::start_infeasible);
  ASSERT_EQ(h.plans.size(), 5u);
  const CommittedTrajectory& brake = h.commits.back();
  const double rests_s = brake.flown().duration_s();
  EXPECT_EQ(h.plans[4].start.velocity, Vec3::Zero());
  EXPECT_EQ(h.plans[4].start.position, brake.flown().sample(rests_s).position);
  EXPECT_NEAR(double(*h.plans[4].start_time_ns - brake.start_time_ns()) * 1e-9, rests_s, 1e-6);
  h.answer();
  h.pass(8.0);
  EXPECT_EQ(h.navigator.state(), State::arrived);
}

TEST(Pursuit, OfARevokedGoalNothingIsFlownForLongThoughNobodyAnswers) {
  Harness h = with_goal_in_flight();
  h.pass(1.3);
  ASSERT_GE(h.commits.size(), 2u) << "a way to rest";
  h.pass(4.0);
  EXPECT_LT(h.vehicle().position.x(), kGoal.x() - 0.2);
  EXPECT_EQ(h.vehicle().velocity, Vec3::Zero());
  EXPECT_EQ(h.navigator.state(), State::planning);
  h.answer();
  h.pass(6.0);
  EXPECT_EQ(h.navigator.state(), State::arrived) << "and the newest goal is not dropped";
}

TEST(Pursuit, ATrueAnswerThatNoStartCanHelpIsFinal) {
  Harness h = with_goal_in_flight();
  h.fails(ErrorCode::goal_occupied, StageRole::path_search, "an obstacle");
  h.pass(0.2);
  EXPECT_EQ(h.last().state, State::failed);
  EXPECT_EQ(h.last().reason.code, ErrorCode::goal_occupied);
  h.pass(6.0);
  EXPECT_EQ(h.commits.size(), 1u);
  EXPECT_EQ(h.vehicle().position, kGoal) << "what is refused revokes nothing";
}

TEST(Pursuit, GoalsEveryTenthOfASecondAreEachPlannedFromWhatWillBeFlown) {
  Harness h;
  h.goal(kGoal);
  h.answer();
  for (int i = 0; i < 30; ++i) {
    h.pass(0.1);
    h.goal(i % 2 == 0 ? kAside : kGoal);
    const PlanRequest& request = h.plans.back();
    const auto& [trajectory, start_ns] = h.flown.back();
    const double t_s = double(*request.start_time_ns - start_ns) * 1e-9;
    EXPECT_LT(largest_difference(request.start, trajectory.sample(t_s)), 1e-9) << i;
    h.answer(6.0);
  }
  h.pass(8.0);
  EXPECT_EQ(h.navigator.state(), State::arrived);
  EXPECT_EQ(h.vehicle().position, kGoal);
}

TEST(Pursuit, ATrajectoryThatTheTrackerRefusesInFlightLeavesTheOneBefore) {
  Harness h = with_goal_in_flight();
  h.answer();
  h.flown.pop_back();
  h.tracker_says(h.commits.back().id(), {ErrorCode::not_at_start, "0.1 m away"});
  EXPECT_EQ(h.last().state, State::flying);
  h.pass(0.3);
  ASSERT_EQ(h.plans.size(), 3u);
  const auto& [trajectory, start_ns] = h.flown[0];
  const double t_s = double(*h.plans[2].start_time_ns - start_ns) * 1e-9;
  EXPECT_LT(largest_difference(h.plans[2].start, trajectory.sample(t_s)), 1e-9);
  h.answer();
  h.pass(6.0);
  EXPECT_EQ(h.navigator.state(), State::arrived);
}

// As after a restart of the navigator beside others: its first commits may not be heard.
TEST(Pursuit, WhatTheTrackerNeverAnsweredIsNotPlannedFrom) {
  Harness h;
  h.goal(kGoal);
  h.answer();
  h.flown.clear();  // not heard: the vehicle stays where it is
  h.pass(0.5);
  h.goal(Vec3(0, 4, 1));
  EXPECT_TRUE(h.plans.back().start_time_ns.has_value());
  h.answer();
  h.flown.clear();
  h.tracker_says(h.commits.back().id(), {ErrorCode::not_at_start, "2.7 m away"});
  h.pass(0.5);
  ASSERT_EQ(h.plans.size(), 3u);
  EXPECT_FALSE(h.plans[2].start_time_ns.has_value());
  EXPECT_EQ(h.plans[2].start.position, kHome);
  h.answer();
  h.pass(6.0);
  EXPECT_EQ(h.navigator.state(), State::arrived);
}

TEST(Pursuit, ATrajectoryThatTheTrackerLosesIsPlannedForAgainFromRest) {
  Harness h;
  h.goal(kGoal);
  h.answer();
  h.tracker_says(h.commits[0].id(), ok());
  h.pass(2.0);
  h.tracker_says(h.commits[0].id(), {ErrorCode::tracking_lost, "0.2 m away"});
  EXPECT_EQ(h.last().flown_id, 0u);
  h.pass(0.3);
  EXPECT_EQ(h.plans.size(), 1u) << "it still moves";
  h.flown = {{Trajectory{{BezierPiece::between({.position = Vec3(2, 0, 1)},
                                               {.position = Vec3(2, 0, 1)}, 1.0)}},
              h.now - kSecond}};
  h.pass(0.3);
  ASSERT_EQ(h.plans.size(), 2u);
  EXPECT_EQ(h.plans[1].start.position, Vec3(2, 0, 1));
  EXPECT_EQ(h.plans[1].goal.position, kGoal);
}

TEST(Pursuit, SaysWhatIsFlownFromTheMomentThatItIs) {
  Harness h = with_goal_in_flight();
  const std::uint64_t first = h.plans[0].id, second = h.plans[1].id;
  h.answer();
  EXPECT_EQ(h.last().id, second);
  EXPECT_EQ(h.last().flown_id, first) << "the switch is still to come";
  h.pass(0.28);
  EXPECT_EQ(h.last().flown_id, first);
  h.pass(0.04);
  EXPECT_EQ(h.last().flown_id, second);
}

TEST(Pursuit, WhatTheTrackerFollowsIsBelievedMoreThanWhatWasCommitted) {
  Harness h;
  h.goal(kGoal);
  h.answer();
  h.pass(0.2);
  EXPECT_EQ(h.last().flown_id, h.plans[0].id);
  h.navigator.on_tracking(0, false, h.now);  // a tracker that has just been started
  h.take();
  EXPECT_EQ(h.last().flown_id, 0u);
  h.navigator.on_tracking(h.plans[0].id, true, h.now);
  h.take();
  EXPECT_EQ(h.last().flown_id, h.plans[0].id);
  EXPECT_EQ(h.last().state, State::flying);
}

TEST(Pursuit, ATrajectoryThatTheTrackerRefusesAndThenFollowsIsFlown) {
  Harness h;
  h.goal(kGoal);
  h.answer();
  const std::uint64_t id = h.commits[0].id();
  h.pass(1.0);
  h.tracker_says(id, {ErrorCode::not_at_start, "no odometry yet"});
  h.navigator.on_tracking(id, true, h.now);  // said before
  h.take();
  EXPECT_NE(h.last().reason.code, ErrorCode::ok);
  h.pass(0.2);
  h.navigator.on_tracking(id, true, h.now);
  h.take();
  EXPECT_EQ(h.last().state, State::flying);
  EXPECT_EQ(h.last().flown_id, id);
  h.pass(4.0);
  EXPECT_EQ(h.last().state, State::arrived);
}

// A long flight through a world that unfolds may lose many trajectories, each for a new reason.
TEST(Pursuit, LossesThatLieApartAreNotAddedUpThoseOfOneMomentAre) {
  Config config = wide();
  config.max_attempts = 3;
  Harness h(config);
  h.goal(kGoal);
  for (int k = 0; k < 6; ++k) {
    h.answer();
    h.tracker_says(h.commits.back().id(), ok());
    h.pass(0.5);
    h.tracker_says(h.commits.back().id(), {ErrorCode::tracking_lost, "0.06 m away"});
    h.pass(k == 0 ? 4.0 : 0.8);  // at first until it rests at the goal, where it stays
    ASSERT_EQ(h.last().state, State::planning) << k;
  }
  for (int k = 0; k < 3 && h.last().state == State::planning; ++k) {
    h.answer();
    h.tracker_says(h.commits.back().id(), {ErrorCode::not_at_start, "0.1 m away"});
    h.pass(1.0);  // the next attempt
  }
  EXPECT_EQ(h.last().state, State::failed);
}

}  // namespace
}  // namespace goshawk::navigator
