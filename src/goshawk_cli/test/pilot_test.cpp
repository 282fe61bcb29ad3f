// Verbs for a flight that runs, as processes of their own against stages of this test: real DDS on
// loopback.

#include <gmock/gmock.h>

#include <atomic>
#include <fstream>
#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>

#include "child.hpp"
#include "geometry_msgs.h"
#include "goshawk/conversions/geometry.hpp"
#include "goshawk/conversions/grid.hpp"
#include "goshawk/runtime/node.hpp"
#include "goshawk_msgs.h"
#include "nav_msgs.h"

namespace {

using goshawk::runtime::Context;
using goshawk::runtime::ContextOptions;
using goshawk::runtime::Node;
using goshawk::runtime::Qos;
using goshawk_msgs::msg::Mission;
using goshawk_msgs::msg::MissionState;
using goshawk_msgs::msg::NavigatorState;
using goshawk_msgs::msg::OperatorAnswer;
using goshawk_msgs::msg::OperatorCommand;
using goshawk_msgs::msg::VoxelGrid;
namespace mission_state = goshawk_msgs::msg::MissionState_Constants;
namespace verb = goshawk_msgs::msg::OperatorCommand_Constants;
namespace state = goshawk_msgs::msg::NavigatorState_Constants;
using Json = nlohmann::json;
using testing::HasSubstr;

/// A vehicle that is at (1, 2, 3), and at its goal as soon as the navigator says so. The navigator
/// arrived somewhere before; it flies for some messages, then arrives, or refuses what has x
/// above 50.
class Flight : public testing::Test {
 protected:
  void SetUp() override {
    ContextOptions options;
    options.domain = cli_test::domain();
    options.node_names = {"/uav1/navigator"};
    auto context = Context::create(options);
    ASSERT_TRUE(context) << context.error().message;
    context_ = *std::move(context);
    goshawk::runtime::RosArgs args;
    args.node_namespace = "/uav1";
    node_ = std::make_unique<Node>(*context_, "navigator", args);
    odometry_ = node_->advertise<nav_msgs::msg::Odometry>("odom", Qos::best_effort());
    states_ = node_->advertise<NavigatorState>("navigator_state", Qos::latched(20));
    say(state::STATE_ARRIVED, "ok", "");
    node_->subscribe<geometry_msgs::msg::PoseStamped>("goal_pose", Qos::reliable_last(),
                                                      [this](const auto& goal, const auto&) {
                                                        const std::lock_guard lock(mutex_);
                                                        goals_.push_back(goal);
                                                        steps_ = 0;
                                                      });
    answers_ = node_->advertise<OperatorAnswer>("operator_answer", Qos::reliable_last());
    missions_ = node_->advertise<MissionState>("mission_state", Qos::latched());
    maps_ = node_->advertise<VoxelGrid>("map/voxels", Qos::latched());
    tell_map();
    node_->subscribe<OperatorCommand>("operator_command", Qos::reliable_last(),
                                      [this](const auto& m, const auto&) { on_command(m); });
    node_->subscribe<Mission>("mission", Qos::reliable_last(),
                              [this](const auto& m, const auto&) { on_mission(m); });
    node_->every(0.02, [this] { step(); });
    thread_ = std::thread([this] { node_->spin(); });
  }
  void TearDown() override {
    if (!thread_.joinable()) return;
    node_->stop();
    thread_.join();
  }
  std::vector<geometry_msgs::msg::PoseStamped> goals() {
    const std::lock_guard lock(mutex_);
    return goals_;
  }
  /// Whether the navigator has said how the newest goal ended.
  bool has_answered() {
    const std::lock_guard lock(mutex_);
    return steps_ > 10;
  }

  /// What was commanded last.
  OperatorCommand command() {
    const std::lock_guard lock(mutex_);
    return command_;
  }
  /// What the guard alone writes.
  auto guard() {
    return node_->advertise<goshawk_msgs::msg::GuardVerdict>("guard_verdict", Qos::reliable_last());
  }
  void mission_is(std::uint8_t state, const char* code = "ok", const char* message = "") {
    const std::lock_guard lock(mutex_);
    mission_.state(state);
    mission_.code(code);
    mission_.message(message);
    EXPECT_TRUE(missions_.publish(mission_));
  }
  std::uint8_t mission_end_ = mission_state::STATE_DONE;  // of every mission

 private:
  void answer(std::uint64_t id, const std::string& client) {
    OperatorAnswer m;
    m.id(id);
    m.client(client);
    m.code(refuses_ ? "no_map" : "ok");
    m.message(refuses_ ? "no map has come" : "does it");
    EXPECT_TRUE(answers_.publish(m));
  }
  /// 20 x 20 x 20 m, free but for a wall from x = 8 m on.
  void tell_map() {
    const goshawk::Index3 size{20, 20, 20};
    goshawk::VoxelGrid grid{.geometry = {.resolution_m = 1.0, .size = size},
                            .grown = goshawk::BitGrid(size, true),
                            .known = goshawk::BitGrid(size, false, true),
                            .raw = goshawk::BitGrid(size, true)};
    for (int x = 8; x < size.x; ++x) {
      for (int y = 0; y < size.y; ++y) {
        for (int z = 0; z < size.z; ++z) grid.grown.set({x, y, z}, true);
      }
    }
    VoxelGrid m;
    m.header(goshawk::conversions::make_header(node_->now_ns()));
    goshawk::conversions::fill_msg(grid, m);
    EXPECT_TRUE(maps_.publish(m));
  }
  // As the stages do: more is said than what was asked for, before the answer and after it.
  void on_command(const OperatorCommand& m) {
    const std::lock_guard lock(mutex_);
    if (is_silent_) return;
    for (int k = 0; k < 5; ++k) EXPECT_TRUE(missions_.publish(mission_));
    answer(m.id(), m.client());
    if (std::exchange(command_, m).id() == m.id()) return;
    if (m.verb() == verb::VERB_TAKEOFF) say(state::STATE_ARRIVED, "ok", "");
  }
  void on_mission(const Mission& m) {
    for (int k = 0; k < 5; ++k) tell_map();
    ++missions_sent_;
    answer(m.id(), m.client());
    mission_.id(m.id());
    mission_.name(m.name());
    mission_.waypoints(std::uint32_t(m.waypoints().size()));
    mission_.waypoint(1);
    mission_is(mission_state::STATE_FLYING);
    mission_.waypoint(2);
    const bool done = mission_end_ == mission_state::STATE_DONE;
    mission_is(mission_end_, done ? "ok" : "no_path", done ? "" : "waypoint 2 of 2: a wall");
  }
  void say(std::uint8_t what, const char* code, const char* message) {
    NavigatorState m;
    const auto now_ns = node_->now_ns();
    m.header().stamp().sec(std::int32_t(now_ns / 1'000'000'000));
    m.header().stamp().nanosec(std::uint32_t(now_ns % 1'000'000'000));
    m.state(what);
    m.code(code);
    m.message(message);
    EXPECT_TRUE(states_.publish(m));
  }
  void step() {
    const std::lock_guard lock(mutex_);
    nav_msgs::msg::Odometry m;
    m.header().frame_id("map");
    m.child_frame_id("base_link");
    m.pose().pose().position() = position_;
    m.pose().pose().orientation().w(1.0);
    (void)odometry_.publish(m);
    if (goals_.empty() || steps_ > 10) return;
    const auto& goal = goals_.back().pose().position();
    if (++steps_ == 1) say(state::STATE_FLYING, "ok", "");
    if (steps_ < 10) return;
    steps_ = 11;
    if (goal.x() > 50.0) return say(state::STATE_FAILED, "goal_outside", "goal is outside the map");
    position_ = goal;
    say(state::STATE_ARRIVED, "ok", "");
  }

  std::unique_ptr<Context> context_;
  std::unique_ptr<Node> node_;
  goshawk::runtime::Publisher<nav_msgs::msg::Odometry> odometry_;
  goshawk::runtime::Publisher<NavigatorState> states_;
  goshawk::runtime::Publisher<OperatorAnswer> answers_;
  goshawk::runtime::Publisher<MissionState> missions_;
  goshawk::runtime::Publisher<VoxelGrid> maps_;
  OperatorCommand command_;
  MissionState mission_;
  geometry_msgs::msg::Point position_ = [] {
    geometry_msgs::msg::Point p;
    p.x(1.0);
    p.y(2.0);
    p.z(3.0);
    return p;
  }();
  std::thread thread_;
  std::mutex mutex_;
  std::vector<geometry_msgs::msg::PoseStamped> goals_;

 protected:
  std::atomic<bool> refuses_ = false;    // every command
  std::atomic<bool> is_silent_ = false;  // no command is answered
  std::atomic<int> missions_sent_ = 0;

 private:
  int steps_ = 0;  // since the newest goal
};

cli_test::Outcome pilot(std::vector<std::string> words) {
  words.insert(words.end(), {"--namespace", "/uav1", "--ready", "30"});
  return cli_test::run(std::move(words));
}

TEST_F(Flight, GotoSendsTheGoalAndWaitsForTheVehicle) {
  const auto outcome = pilot({"goto", "4,5,6", "--yaw", "90", "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  const Json json = Json::parse(outcome.out);
  EXPECT_EQ(json["goal"], Json::parse("[4.0, 5.0, 6.0]"));
  EXPECT_GT(json["time_s"], 0.0);
  EXPECT_TRUE(has_answered()) << "the arrival at an earlier goal is not an answer";
  ASSERT_EQ(goals().size(), 1U);
  const auto& pose = goals()[0].pose();
  EXPECT_EQ(goals()[0].header().frame_id(), "map");
  EXPECT_EQ(pose.position().y(), 5.0);
  EXPECT_NEAR(pose.orientation().z(), std::sqrt(0.5), 1e-12);
  EXPECT_NEAR(pose.orientation().w(), std::sqrt(0.5), 1e-12);
}

TEST_F(Flight, GotoSaysWhyAGoalWasGivenUp) {
  const auto outcome = pilot({"goto", "100,0,1"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.err, HasSubstr("goal_outside: goal is outside the map"));
}

TEST_F(Flight, HoldCommandsTheNavigatorAndWaitsForRest) {
  const auto outcome = pilot({"hold"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("holds at (1.000, 2.000, 3.000)"));
  EXPECT_EQ(command().verb(), verb::VERB_HOLD);
  EXPECT_TRUE(goals().empty());
}

TEST_F(Flight, TakeoffSaysHowHighAndWaitsForTheNavigator) {
  const auto outcome = pilot({"takeoff", "--height", "2.5", "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(command().verb(), verb::VERB_TAKEOFF);
  EXPECT_EQ(command().height(), 2.5);
  EXPECT_EQ(Json::parse(outcome.out)["position"], Json::parse("[1.0, 2.0, 3.0]"));
}

TEST_F(Flight, LandSaysWhyItWasRefused) {
  refuses_ = true;
  const auto outcome = pilot({"land"});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.err, HasSubstr("no_map: no map has come"));
  EXPECT_EQ(command().verb(), verb::VERB_LAND);
}

TEST_F(Flight, ResumeIsForTheMissionIfOneWaitsForIt) {
  mission_is(mission_state::STATE_FLYING);
  EXPECT_EQ(pilot({"resume"}).status, 0);
  EXPECT_EQ(command().verb(), verb::VERB_RESUME);
  mission_is(mission_state::STATE_PAUSED);
  EXPECT_EQ(pilot({"resume"}).status, 0);
  EXPECT_EQ(command().verb(), verb::VERB_RESUME_MISSION);
}

/// A file with two waypoints.
std::string mission_file(const char* second = "4,5,6") {
  std::string path = testing::TempDir() + "cli_mission_" + std::to_string(getpid()) + ".csv";
  std::ofstream(path) << "x_m,y_m,z_m\n1,2,3\n" << second << "\n";
  return path;
}

TEST_F(Flight, MissionIsSentOnceAndWaitedFor) {
  const auto outcome = pilot({"mission", mission_file(), "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(Json::parse(outcome.out)["waypoints"], 2);
}

TEST_F(Flight, MissionThatFailsSaysWhere) {
  mission_end_ = mission_state::STATE_FAILED;
  const auto outcome = pilot({"mission", mission_file()});
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.err, HasSubstr("no_path: waypoint 2 of 2: a wall"));
}

TEST_F(Flight, MissionWithAWaypointInAnObstacleIsNotSentUnlessThatIsAskedFor) {
  const std::vector<std::string> call{"mission", mission_file("9,5,6")};
  const auto outcome = pilot(call);
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.err, HasSubstr(".csv, line 3: waypoint 2: "));
  EXPECT_EQ(missions_sent_, 0);
  EXPECT_EQ(pilot({call[0], call[1], "--unchecked"}).status, 0);
  EXPECT_EQ(missions_sent_, 1);
}

TEST_F(Flight, MissionThatIsOnlyWatchedHasNoTimeOfItsOwn) {
  mission_is(mission_state::STATE_DONE);
  const auto outcome = pilot({"mission", "--json"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(Json::parse(outcome.out).at("time_s").is_null()) << outcome.out;
}

/// What a call that gets no answer says, once the machine has found the guard.
std::string told_of_guard(std::vector<std::string> words) {
  words.insert(words.end(), {"--namespace", "/uav1", "--ready", ""});
  std::string said;
  for (const char* ready_s : {"1", "4", "16", "60"}) {
    words.back() = ready_s;
    said = cli_test::run(words).err;
    if (said.find("the guard flies the vehicle") != std::string::npos) break;
  }
  return said;
}

TEST_F(Flight, ByTheGuardIsToldApartFromNoFlight) {
  const auto verdicts = guard();
  is_silent_ = true;
  for (const char* word : {"hold", "land"}) {
    EXPECT_THAT(told_of_guard({word}), HasSubstr("command the planner that it guards"));
  }
}

TEST(MissionAlone, IsRefusedBeforeAnythingIsSent) {
  const auto outcome = cli_test::run({"mission", mission_file("4,5")},
                                     goshawk::runtime::hold_private_domain().value());
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.err, HasSubstr(".csv, line 3: it has 2 values, but there are 3 columns"));
}

TEST(PilotAlone, SaysThatNoFlightRuns) {
  const auto outcome = cli_test::run({"goto", "1,2,3", "--ready", "0.3"},
                                     goshawk::runtime::hold_private_domain().value());
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.err, HasSubstr("no stage reads /goal_pose"));
}

}  // namespace
