// What becomes of a goal when stages, tracker, vehicle or odometry fail.
#include "harness.hpp"

namespace goshawk::navigator {
namespace {

using testing::HasSubstr;

TEST(Navigator, AFailedReplanLeavesTheVehicleOnItsTrajectory) {
  Harness h;
  h.goal(kGoal);
  h.answer();
  h.pass(1.0);
  h.goal(Vec3(90, 0, 1));
  h.fails(ErrorCode::goal_outside, StageRole::path_search, "goal is outside the map");
  h.pass(0.2);
  EXPECT_EQ(h.last().state, State::failed);
  EXPECT_EQ(h.last().reason.code, ErrorCode::goal_outside);
  EXPECT_THAT(h.last().reason.message, HasSubstr("path_search: goal is outside"));
  h.pass(10.0);
  EXPECT_EQ(h.commits.size(), 1u);
  EXPECT_EQ(h.navigator.state(), State::failed) << "it rests at the earlier goal, not at this one";
  h.goal(kHome);
  EXPECT_EQ(h.plans.back().start.position, kGoal);
}

TEST(Navigator, NamesTheStageThatIsSilentAndGivesUpInTheEnd) {
  Config config;
  config.max_attempts = 3;
  Harness h(config);
  h.goal(kGoal);
  h.navigator.on_report(h.plans.back().id, StageRole::path_search, ok(), h.now);
  h.pass(1.5);
  EXPECT_EQ(h.plans.size(), 2u) << "asked again";
  h.navigator.on_report(h.plans.back().id, StageRole::path_search, ok(), h.now);
  h.pass(1.2);
  h.navigator.on_report(h.plans.back().id, StageRole::path_search, ok(), h.now);
  h.pass(5.0);
  EXPECT_EQ(h.plans.size(), 3u);
  EXPECT_EQ(h.last().state, State::failed);
  EXPECT_EQ(h.last().reason.code, ErrorCode::stage_silent);
  EXPECT_THAT(h.last().reason.message, HasSubstr("corridor_builder did not answer"));
}

TEST(Navigator, FliesWhenARestartedStageAnswersALaterAttempt) {
  Harness h;
  h.goal(kGoal);
  h.pass(2.5);
  ASSERT_GE(h.plans.size(), 2u);
  h.navigator.on_trajectory(h.solve(h.plans[0]), 7, h.now);
  h.take();
  EXPECT_TRUE(h.commits.empty()) << "an answer to a request that was given up is ignored";
  h.answer();
  EXPECT_EQ(h.navigator.state(), State::flying);
}

TEST(Navigator, AsksAgainIfTheMapHasNotComeYetButNotIfThereIsNoPath) {
  Harness h;
  h.pass(2.0);  // the map has not changed for a while
  h.goal(kGoal);
  h.fails(ErrorCode::no_map, StageRole::path_search);
  h.pass(0.5);
  EXPECT_EQ(h.plans.size(), 2u);
  h.fails(ErrorCode::no_path, StageRole::path_search);
  h.pass(3.0);
  EXPECT_EQ(h.plans.size(), 2u);
  EXPECT_EQ(h.last().reason.code, ErrorCode::no_path);
}

TEST(Navigator, DropsAPlanThatCameTooLateAndAsksWithMoreLead) {
  Harness h;
  h.goal(kGoal);
  h.answer(8.0);
  h.pass(2.0);
  h.goal(Vec3(2, 3, 1));
  h.now += kSecond * 4 / 10;  // the moment of the switch has passed
  h.answer();
  EXPECT_EQ(h.commits.size(), 1u) << "a trajectory that begins in the past is not committed";
  ASSERT_EQ(h.plans.size(), 3u) << "asked again at once";
  EXPECT_EQ(*h.plans[2].start_time_ns, h.now + kSecond * 6 / 10);
  h.pass(0.4);  // too late for 0.3 s, early enough for 0.6 s
  h.answer();
  EXPECT_EQ(h.commits.size(), 2u);
}

TEST(Navigator, DoesNotCommitATrajectoryThatDoesNotEndAtRest) {
  Harness h;
  h.goal(kGoal);
  PlanRequest through = h.plans[0];
  through.goal.velocity = Vec3(1, 0, 0);
  h.navigator.on_trajectory(h.solve(through), 1, h.now);
  h.take();
  EXPECT_TRUE(h.commits.empty());
  ASSERT_EQ(h.complaints.size(), 1u);
  EXPECT_EQ(h.complaints[0].id, h.plans[0].id);
  EXPECT_EQ(h.complaints[0].reason.code, ErrorCode::not_certified);
  EXPECT_THAT(h.complaints[0].reason.message, HasSubstr("does not end at rest"));
  h.answer();
  EXPECT_EQ(h.commits.size(), 1u) << "a good answer still counts";
}

TEST(Navigator, PlansAgainFromRestIfTheTrackerRefuses) {
  Harness h;
  h.goal(kGoal);
  h.answer();
  const std::uint64_t refused = h.commits[0].id();
  h.flown.clear();  // the vehicle stays where it is
  h.tracker_says(refused, {ErrorCode::not_at_start, "0.9 m away"});
  EXPECT_EQ(h.last().state, State::planning);
  EXPECT_THAT(h.last().reason.message, HasSubstr("0.9 m away"));
  h.pass(0.5);
  ASSERT_EQ(h.plans.size(), 2u);
  EXPECT_EQ(h.plans[1].goal.position, kGoal);
  h.answer();
  h.pass(5.0);
  EXPECT_EQ(h.navigator.state(), State::arrived);
}

// A tracker that does not know yet that the navigator's clock was set.
TEST(Navigator, OutlivesATrackerThatRefusesEverythingForSomeSeconds) {
  Harness h;
  h.goal(kGoal);
  const std::int64_t refuses_until = h.now + 4 * kSecond;
  for (std::size_t answered = 0; h.now < refuses_until; h.pass(0.02)) {
    if (h.plans.size() == answered) continue;
    answered = h.plans.size();
    h.answer();
    h.flown.clear();
    h.tracker_says(h.commits.back().id(), {ErrorCode::deadline_exceeded, "begins in the past"});
  }
  ASSERT_EQ(h.last().state, State::planning);
  const std::size_t refused = h.plans.size();
  for (int i = 0; i < 200 && h.plans.size() == refused; ++i) h.pass(0.02);
  h.answer();
  h.tracker_says(h.commits.back().id(), ok());
  h.pass(7.0);
  EXPECT_EQ(h.last().state, State::arrived);
}

// Over a network that loses packets a trajectory may come when its start has passed.
TEST(Navigator, APlanFromRestBeginsLaterAfterEachThatTheTrackerRefused) {
  Harness h;
  h.goal(kGoal);
  double lead_s = 0.0;
  for (int attempt = 0; attempt < 4; ++attempt) {
    const std::size_t asked = h.plans.size();
    h.answer();
    const double longer_s = double(h.commits.back().start_time_ns() - h.now) * 1e-9;
    EXPECT_GT(longer_s, lead_s + (attempt > 0 ? 0.2 : 0.0)) << attempt;
    lead_s = longer_s;
    h.flown.clear();
    h.tracker_says(h.commits.back().id(), {ErrorCode::not_at_start, "it began 0.5 s ago"});
    for (int i = 0; i < 200 && h.plans.size() == asked; ++i) h.pass(0.02);
  }
}

TEST(Navigator, GivesUpIfTheTrackerRefusesEveryAttempt) {
  Harness h;
  h.goal(kGoal);
  for (std::size_t answered = 0; h.last().state != State::failed; h.pass(0.02)) {
    if (h.plans.size() == answered) continue;
    answered = h.plans.size();
    h.answer();
    h.flown.clear();
    h.tracker_says(h.commits.back().id(), {ErrorCode::not_at_start, "0.9 m away"});
    ASSERT_LE(h.plans.size(), std::size_t(Config{}.max_attempts));
  }
  EXPECT_EQ(h.plans.size(), std::size_t(Config{}.max_attempts));
  EXPECT_EQ(h.last().reason.code, ErrorCode::not_at_start);
}

TEST(Navigator, WithoutOdometryNamesWhatIsMissing) {
  Harness h;
  h.odometry_comes = false;
  h.pass(1.0);
  h.goal(kGoal);
  h.pass(6.0);
  EXPECT_TRUE(h.plans.empty());
  EXPECT_EQ(h.last().state, State::failed);
  EXPECT_EQ(h.last().reason.code, ErrorCode::tracking_lost);
  EXPECT_THAT(h.last().reason.message, HasSubstr("odometry"));
}

TEST(Navigator, WaitsForOdometryThatComesALittleAfterTheGoal) {
  Harness h;
  h.odometry_comes = false;
  h.pass(1.0);
  h.goal(kGoal);
  h.pass(1.0);
  EXPECT_TRUE(h.plans.empty());
  h.odometry_comes = true;
  h.pass(0.1);
  EXPECT_EQ(h.plans.size(), 1u);
}

TEST(Navigator, DoesNotPlanFromRestWhileTheVehicleMovesByItself) {
  Harness h;
  h.navigator.on_odometry(at(kHome, Vec3(1, 0, 0)), h.now);
  h.goal(kGoal);
  EXPECT_TRUE(h.plans.empty());
  h.pass(0.1);  // the harness' vehicle is at rest
  EXPECT_EQ(h.plans.size(), 1u);
}

// Its failsafe lands it meanwhile, for longer than it would take to settle.
TEST(Navigator, WhileTheTrackerIsStartedAgainAGoalWaitsForTheVehicleToRest) {
  Harness h;
  h.navigator.on_tracking(0, false, h.now);
  h.drift = Vec3(0, 0, -0.3);
  h.pass(1.0);  // nothing more of the tracker
  h.goal(kGoal);
  h.pass(20.0);
  EXPECT_EQ(h.navigator.state(), State::planning);
  h.navigator.on_tracking(0, false, h.now);  // it is back
  h.drift.setZero();
  h.pass(0.1);
  ASSERT_EQ(h.plans.size(), 1u);
  h.answer();
  h.pass(5.0);
  EXPECT_EQ(h.navigator.state(), State::arrived);
}

TEST(Navigator, AVehicleThatMovesBesideALivingTrackerIsNotWaitedForForLong) {
  Harness h;
  h.drift = Vec3(0, 0, -0.3);
  h.goal(kGoal);
  for (int i = 0; i < 60; ++i) {
    h.navigator.on_tracking(0, false, h.now);
    h.pass(0.1);
  }
  EXPECT_EQ(h.navigator.state(), State::failed);
  EXPECT_EQ(h.last().reason.code, ErrorCode::tracking_lost);
}

TEST(Navigator, ATrackerThatNeverComesBackIsNamed) {
  Harness h;
  h.navigator.on_tracking(0, false, h.now);
  h.drift = Vec3(0, 0, -0.3);
  h.goal(kGoal);
  h.pass(70.0);
  EXPECT_EQ(h.navigator.state(), State::failed);
  EXPECT_EQ(h.last().reason.code, ErrorCode::stage_silent);
  EXPECT_THAT(h.last().reason.message, HasSubstr("the tracker is silent"));
}

TEST(Navigator, AVehicleThatEndsElsewhereHasNotArrivedAndIsSentAgain) {
  Config config;
  config.max_attempts = 2;
  Harness h(config);
  h.goal(kGoal);
  h.answer();
  h.offset = Vec3(0, 0.5, 0);
  h.pass(10.0);
  ASSERT_EQ(h.plans.size(), 2u);
  EXPECT_EQ(h.plans[1].start.position, kGoal + h.offset) << "from where it is";
  h.answer();
  h.offset = Vec3(0, 0.7, 0);  // and off again
  h.pass(12.0);
  EXPECT_EQ(h.navigator.state(), State::failed);
  EXPECT_EQ(h.last().reason.code, ErrorCode::tracking_lost);
}

/// Another navigator with the memory of this one, in the same flight.
void die_and_come_back(Harness& h) {
  Memory memory = h.navigator.memory();
  h.navigator = Navigator(wide(), 1'000);
  h.navigator.on_map(std::make_shared<const VoxelGrid>(free_map()), h.now);
  h.commits.clear();
  h.navigator.resume(std::move(memory), h.now);
  h.take();
}

TEST(Navigator, AfterItsDeathGoesOnWithWhatIsFlown) {
  Harness h;
  h.goal(kGoal);
  h.answer();
  h.pass(1.5);
  die_and_come_back(h);
  EXPECT_EQ(h.last().state, State::flying);
  EXPECT_EQ(h.last().id, h.plans[0].id);
  EXPECT_EQ(h.last().flown_id, h.plans[0].id);
  ASSERT_EQ(h.commits.size(), 1u) << "again, for a tracker that has not had it";
  EXPECT_EQ(h.commits[0].id(), h.plans[0].id);
  h.pass(4.0);
  EXPECT_EQ(h.last().state, State::arrived);
  EXPECT_EQ(h.plans.size(), 1u);
}

TEST(Navigator, AfterItsDeathPlansForTheGoalThatNothingLedToYet) {
  Harness h;
  h.goal(kGoal);
  h.answer();
  h.pass(1.5);
  h.goal(Vec3(2, 3, 1));
  die_and_come_back(h);
  EXPECT_EQ(h.plans.size(), 2u) << "not before it knows where the vehicle is";
  h.pass(0.1);
  ASSERT_EQ(h.plans.size(), 3u);
  EXPECT_GE(h.plans[2].id, 1'000u);
  EXPECT_EQ(h.plans[2].goal.position, Vec3(2, 3, 1));
  EXPECT_GT(h.plans[2].start.velocity.norm(), 0.5);
  h.answer();
  h.pass(6.0);
  EXPECT_EQ(h.last().state, State::arrived);
}

TEST(Navigator, AfterItsDeathAtTheGoalItIsStillThere) {
  Harness h;
  h.goal(kGoal);
  h.answer();
  h.pass(6.0);
  die_and_come_back(h);
  EXPECT_EQ(h.last().state, State::arrived);
  EXPECT_TRUE(h.commits.empty()) << "it has ended";
  h.pass(1.0);
  EXPECT_EQ(h.last().state, State::arrived);
  EXPECT_EQ(h.plans.size(), 1u);
}

}  // namespace
}  // namespace goshawk::navigator
