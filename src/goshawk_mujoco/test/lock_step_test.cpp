// Plant, tracker and navigator, each a process of its own, in lock step with this test, which is
// their pilot and their planner. What is proven is that a flight repeats, bit for bit.

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>

#include "geometry_msgs.h"
#include "goshawk/conversions/plan.hpp"
#include "goshawk/conversions/status.hpp"
#include "goshawk/conversions/vehicle.hpp"
#include "goshawk/runtime/node.hpp"
#include "goshawk/runtime/private_domain.hpp"
#include "goshawk_msgs.h"
#include "nav_msgs.h"
#include "stage_process.hpp"

namespace goshawk {
namespace {

using goshawk_msgs::msg::BezierTrajectory;
using goshawk_msgs::msg::NavigatorState;
using goshawk_msgs::msg::PlanRequest;
using runtime::MessageInfo;
using runtime::Qos;

constexpr std::int64_t kGoal_ns = 1'500'000'000;
constexpr std::int64_t kEnd_ns = 8'000'000'000;

/// Sends the goal, answers the plan request with a straight line, keeps what odometry says.
class Pilot {
 public:
  explicit Pilot(runtime::Context& context) : node_(context, "pilot") {
    node_.run_in_lock_step();
    goals_ = node_.advertise<geometry_msgs::msg::PoseStamped>("goal_pose", Qos::reliable_last());
    plans_ = node_.advertise<BezierTrajectory>("trajectory", Qos::reliable_last());
    node_.subscribe<PlanRequest>("plan_request", Qos::reliable_last(),
                                 [this](const PlanRequest& m, const MessageInfo&) { plan(m); });
    node_.subscribe<NavigatorState>(
        "navigator_state", Qos::latched(20), [this](const NavigatorState& m, const MessageInfo&) {
          said += std::string(conversions::navigator_state_word(m.state())) + " ";
        });
    node_.subscribe<nav_msgs::msg::Odometry>(
        "odom", Qos::best_effort(), [this](const nav_msgs::msg::Odometry& m, const MessageInfo&) {
          // One spin may take more than one turn.
          if (node_.now_ns() <= kEnd_ns) odometry.push_back(m);
        });
    node_.every(0.05, [this] { send_goal(); });
  }

  /// @return whether simulated time came to its end within most_s of the machine's
  bool fly(double most_s) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(most_s);
    while (node_.now_ns() < kEnd_ns && std::chrono::steady_clock::now() < end) node_.spin_some(0.1);
    return node_.now_ns() >= kEnd_ns;
  }

  std::vector<nav_msgs::msg::Odometry> odometry;
  std::string said;

 private:
  void send_goal() {
    if (sent_ || node_.now_ns() < kGoal_ns) return;
    sent_ = true;
    geometry_msgs::msg::PoseStamped goal;
    goal.header(conversions::make_header(node_.now_ns()));
    goal.pose().position(conversions::to_point({2.5, 1.8, 1.3}));
    goal.pose().orientation().w(1.0);
    EXPECT_TRUE(goals_.publish(goal));
  }

  void plan(const PlanRequest& m) {
    const auto request = conversions::from_msg(m);
    ASSERT_TRUE(request) << request.error().message;
    Trajectory line;
    line.pieces = {BezierPiece::between(request->start, request->goal, 5.0)};
    const std::vector<Polytope> box{Polytope::box(Vec3::Constant(-20.0), Vec3::Constant(20.0))};
    BezierTrajectory answer;
    answer.header(conversions::make_header(node_.now_ns()));
    answer.request(m);
    answer.pieces(conversions::to_msg(line));
    answer.polytopes(conversions::to_msg(box));
    answer.certificate(
        conversions::to_msg(measure(line, box, request->limits, request->start, request->goal)));
    EXPECT_TRUE(plans_.publish(answer));
  }

  runtime::Node node_;
  runtime::Publisher<geometry_msgs::msg::PoseStamped> goals_;
  runtime::Publisher<BezierTrajectory> plans_;
  bool sent_ = false;
};

struct Flown {
  std::vector<nav_msgs::msg::Odometry> odometry;
  std::string said;
  double wall_s = 0.0;
};

Flown fly(const std::string& plant, const std::vector<std::string>& parameters) {
  runtime::ContextOptions options;
  static const int domain = runtime::hold_private_domain().value();
  options.domain = domain;
  setenv("ROS_DOMAIN_ID", std::to_string(options.domain).c_str(), 1);
  std::vector<std::string> plant_call{plant + ":simulator",
                                      "--ros-args",
                                      "-p",
                                      "lock_step_nodes:=navigator,tracker,pilot",
                                      "-p",
                                      "speed:=0"};
  for (const auto& p : parameters) plant_call.insert(plant_call.end(), {"-p", p});
  const auto context = runtime::Context::create(options).value();
  Pilot pilot(*context);
  // The pilot plans without a map.
  const std::vector<std::string> without_map{"--ros-args", "-p", "lock_step:=true", "-p",
                                             "require_map:=false"};
  const auto call = [&](std::vector<std::string> stage) {
    stage.insert(stage.end(), without_map.begin(), without_map.end());
    return stage;
  };
  const Stage navigator(call({"navigator"}));
  const Stage tracker(call({"tracker"}));
  const Stage simulator(plant_call);
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_TRUE(pilot.fly(120.0));
  const std::chrono::duration<double> wall = std::chrono::steady_clock::now() - begin;
  return {std::move(pilot.odometry), pilot.said, wall.count()};
}

void expect_same_bytes(const Flown& a, const Flown& b) {
  EXPECT_EQ(a.said, b.said);
  ASSERT_EQ(a.odometry.size(), b.odometry.size());
  for (std::size_t i = 0; i < a.odometry.size(); ++i) {
    ASSERT_EQ(runtime::encode(a.odometry[i]), runtime::encode(b.odometry[i])) << "message " << i;
  }
}

Vec3 place(const nav_msgs::msg::Odometry& m) {
  return conversions::from_msg(m.pose().pose().position());
}

void expect_arrived(const Flown& flown) {
  ASSERT_FALSE(flown.odometry.empty());
  EXPECT_NE(flown.said.find("arrived"), std::string::npos) << flown.said;
  EXPECT_LT((place(flown.odometry.back()) - Vec3(2.5, 1.8, 1.3)).norm(), 0.05);
}

TEST(LockStep, TwoFlightsInGustsWithNoiseGiveTheSameOdometryToTheLastBit) {
  const std::vector<std::string> weather{"gust_deviation_m_s:=0.5", "position_noise_m:=0.002",
                                         "odometry_delay_s:=0.008"};
  const Flown first = fly("simulator", weather), second = fly("simulator", weather);
  expect_arrived(first);
  EXPECT_EQ(first.odometry.size(), std::size_t((kEnd_ns - runtime::kFirst_ns) / 4'000'000));
  expect_same_bytes(first, second);
  RecordProperty("wall_s", std::to_string(first.wall_s));
  // Another seed is another flight: the comparison above can fail.
  auto other = weather;
  other.emplace_back("gust_seed:=2");
  EXPECT_NE(fly("simulator", other).odometry.back(), first.odometry.back());
}

TEST(LockStep, MujocoAsThePlantRepeatsToTheLastBitAndFliesTheSameFlight) {
  const Flown first = fly("mujoco", {}), second = fly("mujoco", {}), ours = fly("simulator", {});
  expect_arrived(first);
  expect_same_bytes(first, second);
  ASSERT_EQ(ours.odometry.size(), first.odometry.size());
  double largest_m = 0.0;
  for (std::size_t i = 0; i < first.odometry.size(); ++i) {
    largest_m = std::max(largest_m, (place(first.odometry[i]) - place(ours.odometry[i])).norm());
  }
  EXPECT_GT(largest_m, 0.0);
  EXPECT_LT(largest_m, 5e-4);
  RecordProperty("largest_difference_m", std::to_string(largest_m));
}

}  // namespace
}  // namespace goshawk
