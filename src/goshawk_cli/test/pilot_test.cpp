// goto and hold as processes of their own against a navigator of this test: real DDS on loopback.

#include <gmock/gmock.h>

#include <mutex>
#include <nlohmann/json.hpp>
#include <thread>

#include "child.hpp"
#include "geometry_msgs.h"
#include "goshawk/runtime/node.hpp"
#include "goshawk_msgs.h"
#include "nav_msgs.h"

namespace {

using goshawk::runtime::Context;
using goshawk::runtime::ContextOptions;
using goshawk::runtime::Node;
using goshawk::runtime::Qos;
using goshawk_msgs::msg::NavigatorState;
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

 private:
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

TEST_F(Flight, HoldMakesThePlaceOfTheVehicleItsGoal) {
  const auto outcome = pilot({"hold"});
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("holds at (1.000, 2.000, 3.000)"));
  ASSERT_EQ(goals().size(), 1U);
  EXPECT_EQ(goals()[0].pose().position().z(), 3.0);
}

TEST(PilotAlone, SaysThatNoFlightRuns) {
  const auto outcome = cli_test::run({"goto", "1,2,3", "--ready", "0.3"},
                                     goshawk::runtime::hold_private_domain().value());
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.err, HasSubstr("no stage reads /goal_pose"));
}

}  // namespace
