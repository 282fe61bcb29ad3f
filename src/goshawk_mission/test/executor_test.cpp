#include "goshawk/mission/executor.hpp"

#include <gmock/gmock.h>

#include <numbers>

namespace goshawk::mission {
namespace {

using Does = NavigatorNews::Does;
using testing::HasSubstr;

constexpr std::int64_t kSecond = 1'000'000'000;

Mission mission_of(std::vector<Waypoint> waypoints) {
  return {.id = 1, .client = "test", .name = "test", .waypoints = std::move(waypoints)};
}

/// A mission, and a navigator that says what it is told to.
class Missions : public testing::Test {
 protected:
  Missions() { executor_.on_vehicle(Vec3::Zero(), 0.5, now_ns_); }

  void start(std::vector<Waypoint> waypoints) {
    ASSERT_TRUE(executor_.start(mission_of(std::move(waypoints)), now_ns_));
  }
  void navigator(Does does, const Vec3& goal_map, const std::string& why = "") {
    const Error reason{does == Does::failed ? ErrorCode::no_path : ErrorCode::ok, why};
    executor_.on_navigator({does, goal_map, reason, ++stamp_ns_}, now_ns_);
  }
  /// Takes the goal that was sent, and says that it is pursued. @return the goal
  Goal take() {
    const auto goal = executor_.take_goal();
    if (!goal) throw std::runtime_error("no goal was sent");
    navigator(Does::pursues, goal->position_map);
    return *goal;
  }
  void arrive() { navigator(Does::arrived, take().position_map); }
  void wait(double seconds) {
    now_ns_ += std::int64_t(seconds * 1e9);
    executor_.tick(now_ns_);
  }
  State state() const { return executor_.progress(now_ns_).state; }
  std::size_t waypoint() const { return executor_.progress(now_ns_).waypoint; }
  std::string reason() const { return executor_.progress(now_ns_).reason.message; }

  std::int64_t now_ns_ = 5 * kSecond;
  std::int64_t stamp_ns_ = 100;
  Executor executor_{Config{}};
};

const Vec3 kA{1, 0, 1}, kB{1, 2, 1}, kC{-1, 2, 1};

TEST_F(Missions, AreFlownInTheirOrderAndEndOnce) {
  start({{.position_map = kA}, {.position_map = kB, .v_max_m_s = 0.5}, {.position_map = kC}});
  for (const Vec3& p : {kA, kB, kC}) {
    EXPECT_EQ(state(), State::flying);
    const Goal goal = take();
    EXPECT_EQ(goal.position_map, p);
    EXPECT_EQ(goal.v_max_m_s, p == kB ? 0.5 : 0.0);
    navigator(Does::arrived, p);
  }
  EXPECT_EQ(state(), State::done);
  EXPECT_EQ(waypoint(), 3U);
  EXPECT_FALSE(executor_.take_goal());
  navigator(Does::pursues, {9, 9, 9});
  EXPECT_EQ(state(), State::done);
}

TEST_F(Missions, LookWhereTheyFlyUnlessTheWaypointSaysOtherwise) {
  start({{.position_map = kB}, {.position_map = {1, 2, 5}}, {.position_map = kA, .yaw_rad = 2.0}});
  EXPECT_DOUBLE_EQ(take().yaw_rad, std::atan2(2.0, 1.0));
  executor_.on_vehicle(kB, 0.7, now_ns_);
  navigator(Does::arrived, kB);
  EXPECT_DOUBLE_EQ(take().yaw_rad, 0.7);  // straight up
  navigator(Does::arrived, {1, 2, 5});
  EXPECT_DOUBLE_EQ(take().yaw_rad, 2.0);
}

TEST_F(Missions, WaitAtAWaypointForItsHold) {
  start({{.position_map = kA, .hold_s = 2.0}, {.position_map = kB}});
  arrive();
  EXPECT_EQ(state(), State::waiting);
  wait(1.9);
  EXPECT_EQ(state(), State::waiting);
  EXPECT_NEAR(executor_.progress(now_ns_).hold_left_s, 0.1, 1e-9);
  EXPECT_FALSE(executor_.take_goal());
  wait(0.2);
  EXPECT_EQ(take().position_map, kB);
}

TEST_F(Missions, PassAWaypointInFlightAsSoonAsTheVehicleIsWithinItsRadius) {
  start({{.position_map = kA, .pass_radius_m = 0.5}, {.position_map = kB}});
  take();
  executor_.on_vehicle({0.49, 0.0, 1.0}, 0.0, now_ns_);
  EXPECT_FALSE(executor_.take_goal());
  executor_.on_vehicle({0.51, 0.0, 1.0}, 0.0, now_ns_);
  EXPECT_EQ(take().position_map, kB);
  EXPECT_EQ(waypoint(), 2U);
}

TEST_F(Missions, SendAGoalAgainUntilTheNavigatorHasTakenIt) {
  start({{.position_map = kA}});
  EXPECT_TRUE(executor_.take_goal());
  navigator(Does::arrived, kB);  // still of the goal before
  wait(0.9);
  EXPECT_FALSE(executor_.take_goal());
  wait(0.2);
  EXPECT_TRUE(executor_.take_goal());
  EXPECT_EQ(reason(), "");
  wait(4.0);
  EXPECT_THAT(reason(), HasSubstr("has not taken waypoint 1 of 1"));
  EXPECT_EQ(state(), State::flying);
  arrive();
  EXPECT_EQ(state(), State::done);
  EXPECT_EQ(reason(), "");
}

TEST_F(Missions, HearNothingThatWasSaidBeforeTheGoalWasSent) {
  navigator(Does::arrived, kA);
  start({{.position_map = kA}, {.position_map = kB}});
  executor_.on_navigator({Does::arrived, kA, {ErrorCode::ok, ""}, stamp_ns_}, now_ns_);
  EXPECT_EQ(waypoint(), 1U);
  arrive();
  EXPECT_EQ(waypoint(), 2U);
}

TEST_F(Missions, FailWithTheWaypointAndTheReasonAndCanBeResumed) {
  start({{.position_map = kA}, {.position_map = kB}});
  arrive();
  navigator(Does::failed, take().position_map, "a wall");
  EXPECT_EQ(state(), State::failed);
  EXPECT_EQ(executor_.progress(now_ns_).reason.code, ErrorCode::no_path);
  EXPECT_EQ(reason(), "waypoint 2 of 2 at (1.000, 2.000, 1.000): a wall");
  ASSERT_TRUE(executor_.resume(now_ns_));
  arrive();
  EXPECT_EQ(state(), State::done);
}

TEST_F(Missions, GoOnIfTheNavigatorTakesAFailedWaypointUpByItself) {
  start({{.position_map = kA}});
  navigator(Does::failed, take().position_map, "a wall");
  navigator(Does::pursues, kA);
  EXPECT_EQ(state(), State::flying);
  navigator(Does::arrived, kA);
  EXPECT_EQ(state(), State::done);
}

TEST_F(Missions, ArePausedByAHoldAndLeaveTheVehicleAlone) {
  start({{.position_map = kA}});
  take();
  navigator(Does::held, kA);
  EXPECT_EQ(state(), State::paused);
  EXPECT_THAT(reason(), HasSubstr("operator holds"));
  wait(60.0);
  EXPECT_FALSE(executor_.take_goal());
  ASSERT_TRUE(executor_.resume(now_ns_));
  EXPECT_EQ(take().position_map, kA);
  EXPECT_EQ(state(), State::flying);
}

TEST_F(Missions, GoOnIfTheNavigatorResumesWhatWasHeld) {
  start({{.position_map = kA}});
  take();
  navigator(Does::held, kA);
  navigator(Does::pursues, kA);
  EXPECT_EQ(state(), State::flying);
}

TEST_F(Missions, ArePausedByAnotherGoalInFlightAndWhileWaiting) {
  for (const bool waiting : {false, true}) {
    start({{.position_map = kA, .hold_s = 9.0}, {.position_map = kB}});
    take();
    if (waiting) navigator(Does::arrived, kA);
    navigator(Does::pursues, kC);
    EXPECT_EQ(state(), State::paused);
    EXPECT_THAT(reason(), HasSubstr("another goal, (-1.000, 2.000, 1.000)"));
    navigator(Does::arrived, kC);
    wait(20.0);
    EXPECT_FALSE(executor_.take_goal());
    ASSERT_TRUE(executor_.resume(now_ns_));
    EXPECT_EQ(take().position_map, kA);
  }
}

TEST_F(Missions, SendTheGoalAgainToANavigatorThatWasStartedAnew) {
  start({{.position_map = kA}});
  take();
  navigator(Does::idle, Vec3::Zero());
  EXPECT_EQ(take().position_map, kA);
  EXPECT_EQ(state(), State::flying);
}

TEST_F(Missions, AreCancelledForGood) {
  EXPECT_FALSE(executor_.cancel());
  start({{.position_map = kA}});
  take();
  ASSERT_TRUE(executor_.cancel());
  EXPECT_EQ(state(), State::cancelled);
  navigator(Does::arrived, kA);
  EXPECT_EQ(state(), State::cancelled);
  EXPECT_FALSE(executor_.resume(now_ns_));
  EXPECT_FALSE(executor_.cancel());
}

TEST_F(Missions, ThatHaveFailedCanBeCancelledSoThatNothingTakesThemUpAgain) {
  start({{.position_map = kA}});
  navigator(Does::failed, take().position_map, "a wall");
  ASSERT_TRUE(executor_.cancel());
  navigator(Does::pursues, kA);
  EXPECT_EQ(state(), State::cancelled);
  EXPECT_FALSE(executor_.resume(now_ns_));
}

TEST_F(Missions, AreReplacedByANewerOne) {
  start({{.position_map = kA}});
  take();
  start({{.position_map = kB}});
  EXPECT_EQ(take().position_map, kB);
  EXPECT_EQ(waypoint(), 1U);
}

TEST_F(Missions, WaitForTheVehicleBeforeTheFirstGoal) {
  Executor executor{Config{}};
  ASSERT_TRUE(executor.start(mission_of({{.position_map = kA}}), now_ns_));
  executor.tick(now_ns_ + 10 * kSecond);
  EXPECT_FALSE(executor.take_goal());
  executor.on_vehicle(kB, 0.0, now_ns_);
  EXPECT_TRUE(executor.take_goal());
}

TEST_F(Missions, GoOnInAnotherExecutorWhereTheyEnded) {
  start({{.position_map = kA}, {.position_map = kB, .hold_s = 3.0}, {.position_map = kC}});
  arrive();
  take();
  const auto restarted = [&] {
    const Memory memory = executor_.memory();
    executor_ = Executor{Config{}};
    executor_.restore(memory, now_ns_);
    executor_.on_vehicle(kA, 0.0, now_ns_);
    wait(0.0);
  };
  restarted();  // in flight: the navigator has the goal
  EXPECT_EQ(waypoint(), 2U);
  EXPECT_FALSE(executor_.take_goal());
  navigator(Does::arrived, kB);
  EXPECT_EQ(state(), State::waiting);
  restarted();  // its hold begins anew
  wait(2.9);
  EXPECT_EQ(state(), State::waiting);
  wait(0.2);
  restarted();  // before the goal was sent
  EXPECT_EQ(take().position_map, kC);
  navigator(Does::held, kC);
  restarted();
  EXPECT_EQ(state(), State::paused);
  EXPECT_FALSE(executor_.take_goal());
}

TEST_F(Missions, TellHowFarItIsAlongStraightLines) {
  start({{.position_map = kA}, {.position_map = kB}, {.position_map = kC}});
  EXPECT_NEAR(executor_.progress(now_ns_).left_m, std::sqrt(2.0) + 2.0 + 2.0, 1e-12);
  arrive();
  executor_.on_vehicle(kA, 0.0, now_ns_);
  EXPECT_NEAR(executor_.progress(now_ns_).left_m, 4.0, 1e-12);
}

TEST_F(Missions, ThatCannotBeFlownAreRefusedAndChangeNothing) {
  start({{.position_map = kA}});
  take();
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::pair<std::vector<Waypoint>, std::string>> bad{
      {{}, "no waypoints"},
      {{{.position_map = {nan, 0, 0}}}, "waypoint 1: its position"},
      {{{.position_map = kA}, {.position_map = kB, .yaw_rad = nan}}, "waypoint 2: its yaw"},
      {{{.position_map = kA, .hold_s = -1.0}}, "hold of -1 s"},
      {{{.position_map = kA, .v_max_m_s = -1.0}}, "speed limit of -1 m/s"},
      {{{.position_map = kA, .pass_radius_m = nan}}, "pass radius"},
      {{{.position_map = kA, .hold_s = 1.0, .pass_radius_m = 1.0}, {.position_map = kB}},
       "give one of them"},
      {{{.position_map = kA, .pass_radius_m = 1.0}}, "the last one, is passed"},
      {std::vector<Waypoint>(kMostWaypoints + 1, Waypoint{}), "more than 10000"}};
  for (const auto& [waypoints, words] : bad) {
    const auto status = executor_.start(mission_of(waypoints), now_ns_);
    ASSERT_FALSE(status) << words;
    EXPECT_EQ(status.code(), ErrorCode::invalid_input);
    EXPECT_THAT(status.error().message, HasSubstr(words));
  }
  EXPECT_EQ(state(), State::flying);
  EXPECT_EQ(executor_.mission().waypoints.front().position_map, kA);
}

}  // namespace
}  // namespace goshawk::mission
