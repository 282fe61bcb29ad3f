// Which answers are believed: bad ones are waited out, and what the map does not show free is not
// committed.
#include "harness.hpp"

namespace goshawk::navigator {
namespace {

using testing::HasSubstr;

/// What a stranger could send: planned with limits of its own.
Commitment forged(Harness& h) {
  PlanRequest other = h.plans.back();
  other.limits.v_max_m_s *= 2.0;
  return h.solve(other);
}

TEST(Answers, ABadOneDoesNotEndTheRequest) {
  Harness h;
  h.goal(kGoal);
  h.navigator.on_bad_answer(h.plans[0].id, fail(ErrorCode::not_certified, "it leaves polytope 3"));
  h.navigator.on_trajectory(forged(h), 1, h.now);
  h.pass(0.2);
  h.answer();
  h.pass(5.0);
  EXPECT_EQ(h.navigator.state(), State::arrived);
}

TEST(Answers, ManyBadOnesAreSaidAFewTimesAndCounted) {
  Config config;
  config.max_attempts = 1;
  Harness h(config);
  h.goal(kGoal);
  const Commitment bad = forged(h);
  for (int i = 0; i < 500; ++i) h.navigator.on_trajectory(bad, 1, h.now);
  h.pass(1.5);
  EXPECT_EQ(h.complaints.size(), 3u);
  EXPECT_EQ(h.last().state, State::failed);
  EXPECT_THAT(h.last().reason.message, HasSubstr("500 answers were refused"));
  EXPECT_THAT(h.last().reason.message, HasSubstr("other limits"));
}

/// An answer to the request, but for what `change` does to it.
void expect_refused(const std::function<void(PlanRequest&)>& change, const std::string& why) {
  Harness h;
  h.goal(kGoal);
  PlanRequest other = h.plans[0];
  change(other);
  h.navigator.on_trajectory(h.solve(other), 1, h.now);
  h.take();
  EXPECT_TRUE(h.commits.empty());
  ASSERT_EQ(h.complaints.size(), 1u);
  EXPECT_EQ(h.complaints[0].reason.code, ErrorCode::not_certified);
  EXPECT_THAT(h.complaints[0].reason.message, HasSubstr(why));
  h.answer();
  EXPECT_EQ(h.commits.size(), 1u);
}

TEST(Answers, AreHeldAgainstTheRequest) {
  expect_refused([](auto& r) { r.limits.v_max_m_s *= 2.0; }, "other limits");
  expect_refused([](auto& r) { r.start.position.y() += 0.2; }, "from the start");
  expect_refused([](auto& r) { r.start.velocity.y() += 0.01; }, "from the start");
  expect_refused([](auto& r) { r.goal.position.y() += 0.2; }, "from the goal");
}

TEST(Answers, AGoalThatTheSearchMovedIsFlownToAndSaid) {
  Harness h;
  h.goal(kGoal);
  PlanRequest moved = h.plans[0];
  moved.goal.position.y() += 0.2;
  h.navigator.on_report(moved.id, StageRole::path_search, ok(), h.now, {.goal_moved_m = 0.2});
  h.navigator.on_trajectory(h.solve(moved), 1, h.now);
  h.take();
  ASSERT_EQ(h.commits.size(), 1u);
  h.pass(5.0);
  EXPECT_EQ(h.last().state, State::arrived);
  EXPECT_THAT(h.last().reason.message, HasSubstr("0.2 m from the goal"));
}

TEST(Answers, AFailureIsOvercomeByAGoodAnswerThatComesSoonAfter) {
  Harness h;
  h.goal(kGoal);
  h.fails(ErrorCode::no_path, StageRole::path_search, "says a stranger");
  EXPECT_EQ(h.last().state, State::planning) << "not believed yet";
  h.pass(0.06);
  h.answer();
  h.pass(0.5);
  EXPECT_EQ(h.last().state, State::flying);
}

TEST(Answers, FailuresOfStagesThatDoNotPlanAreNoAnswers) {
  Harness h;
  h.goal(kGoal);
  for (const StageRole stage : {StageRole::other, StageRole::map_server, StageRole::vehicle,
                                StageRole::navigator, StageRole::viewer}) {
    h.fails(ErrorCode::no_path, stage);
  }
  h.pass(0.5);
  EXPECT_EQ(h.last().state, State::planning);
}

TEST(Answers, WhatTheMapDoesNotShowFreeIsNotCommitted) {
  Harness h;
  h.map(map_with_wall(2.0, 5));
  h.goal(kGoal);
  h.answer();
  EXPECT_TRUE(h.commits.empty());
  ASSERT_EQ(h.complaints.size(), 1u);
  EXPECT_EQ(h.complaints[0].reason.code, ErrorCode::trajectory_blocked);
}

TEST(Answers, OneThatWasPlannedInAnOlderMapIsAskedForAgain) {
  Harness h;
  h.goal(kGoal);
  h.map(map_with_wall(2.0, 6));
  h.answer();  // planned in map 5
  EXPECT_TRUE(h.commits.empty());
  EXPECT_TRUE(h.complaints.empty()) << "it is nobody's fault";
  h.map(free_map(7));
  h.pass(0.3);
  EXPECT_EQ(h.plans.size(), 2u);
}

TEST(Answers, AMapVersionThatIsNotHereYetIsWaitedFor) {
  Harness h;
  h.map_version = 6;
  h.goal(kGoal);
  h.answer();
  EXPECT_TRUE(h.commits.empty());
  h.pass(0.2);
  h.map(free_map(6));
  EXPECT_EQ(h.commits.size(), 1u);
  EXPECT_EQ(h.last().state, State::flying);
}

TEST(Answers, AndIfItDoesNotComeThePlanIsAskedForAgainWithACode) {
  Config config;
  config.max_attempts = 1;
  Harness h(config);
  h.map_version = 1'000'000;
  h.goal(kGoal);
  h.answer();
  h.pass(0.7);
  EXPECT_TRUE(h.commits.empty());
  EXPECT_EQ(h.last().state, State::failed);
  EXPECT_EQ(h.last().reason.code, ErrorCode::no_map);
  EXPECT_THAT(h.last().reason.message, HasSubstr("map version 1000000"));
}

TEST(Answers, AnAbsurdMapVersionDoesNotKeepAGoodAnswerOut) {
  Harness h;
  h.goal(kGoal);
  h.map_version = 1'000'000;
  h.navigator.on_trajectory(h.solve(h.plans[0]), 1, h.now);
  h.map_version = 5;
  h.navigator.on_trajectory(h.solve(h.plans[0]), 2, h.now);
  h.take();
  EXPECT_EQ(h.commits.size(), 1u);
}

TEST(Answers, WithoutAMapNothingIsCommittedUnlessTheConfigurationSaysSo) {
  for (const bool required : {true, false}) {
    Config config = wide();
    config.require_map = required;
    Navigator navigator(config, 100);
    navigator.on_odometry(at(kHome), kSecond);
    ASSERT_TRUE(navigator.on_goal(kGoal, 0.0, kSecond));
    Harness h;
    h.goal(kGoal);  // the same request
    navigator.on_trajectory(h.solve(h.plans[0]), 1, kSecond);
    const auto orders = navigator.take_orders();
    const bool committed = std::ranges::any_of(
        orders, [](const Order& order) { return std::holds_alternative<Commit>(order); });
    EXPECT_EQ(committed, !required);
  }
}

}  // namespace
}  // namespace goshawk::navigator
