#include <gtest/gtest.h>

#include <thread>

#include "domain.hpp"
#include "goshawk/conversions/geometry.hpp"
#include "rosgraph_msgs.h"
#include "sensor_msgs.h"
#include "std_msgs.h"

namespace goshawk::runtime {
namespace {

using rosgraph_msgs::msg::Clock;
using runtime_test::join;
using runtime_test::spin_until;
using StringMessage = std_msgs::msg::String;

constexpr std::int64_t kSecond = 1'000'000'000;

Clock clock_at(std::int64_t now_ns) {
  Clock m;
  m.clock(conversions::to_stamp(now_ns));
  return m;
}

TEST(SimulatedTime, NowAndTimersFollowTheClockTopicAloneAndItsRestart) {
  const auto here = join(), there = join();
  Node node(*here, "follower"), source(*there, "source");
  node.use_simulated_time();
  const auto clock = source.advertise<Clock>("/clock", Qos::best_effort());  // as ROS 2's may be
  int calls = 0;
  node.every(0.1, [&] { ++calls; });
  ASSERT_TRUE(spin_until(source, [&] { return clock.matched() > 0; }));
  // Again and again: one may be lost.
  const auto tell = [&](std::int64_t now_ns) {
    return spin_until(node, [&] {
      EXPECT_TRUE(clock.publish(clock_at(now_ns)));
      return node.now_ns() == now_ns;
    });
  };
  EXPECT_EQ(node.now_ns(), 0);
  node.spin_some(0.3);
  EXPECT_EQ(calls, 0);  // the machine's time passes, the simulation's does not
  ASSERT_TRUE(tell(5 * kSecond));
  EXPECT_EQ(node.monotonic_ns(), 5 * kSecond);  // durations are simulated as well
  ASSERT_TRUE(tell(5 * kSecond + 50'000'000));
  EXPECT_EQ(calls, 0);
  ASSERT_TRUE(tell(5 * kSecond + 150'000'000));
  EXPECT_EQ(calls, 1);
  ASSERT_TRUE(tell(1 * kSecond));  // begun anew
  EXPECT_EQ(calls, 1);
  ASSERT_TRUE(tell(1 * kSecond + 100'000'000));
  EXPECT_EQ(calls, 2);
}

/// A node with a thread of its own.
class Running {
 public:
  explicit Running(Node& node) : node_(node), thread_([&node] { node.spin(); }) {}
  ~Running() {
    node_.stop();
    thread_.join();
  }

 private:
  Node& node_;
  std::thread thread_;
};

// The first tells of every step; the second hears it, and answers; the leader hears the answer. By
// turns, all of that falls into the same step, and none is missed, though nobody is told to wait.
TEST(LockStep, WhatOneSaysInItsTurnTheNextHearsInTheSameStep) {
  const auto a = join({"/first"}), b = join({"/second"}), c = join({"/leader"});
  Node first(*a, "first"), second(*b, "second"), leader(*c, "leader");
  std::vector<std::string> heard, answered;
  first.run_in_lock_step();
  const auto tells = first.advertise<StringMessage>("tells", Qos::best_effort());
  first.every(0.01, [&] {
    StringMessage m;
    m.data(std::to_string(first.now_ns()));
    EXPECT_TRUE(tells.publish(m));
  });
  second.run_in_lock_step();
  const auto answers = second.advertise<StringMessage>("answers", Qos::best_effort());
  second.subscribe<StringMessage>("tells", Qos::best_effort(),
                                  [&](const StringMessage& m, const MessageInfo& info) {
                                    heard.push_back(m.data());
                                    EXPECT_EQ(m.data(), std::to_string(info.received_ns));
                                    EXPECT_TRUE(answers.publish(m));
                                  });
  leader.subscribe<StringMessage>("answers", Qos::best_effort(),
                                  [&](const StringMessage& m, const MessageInfo& info) {
                                    EXPECT_EQ(m.data(), std::to_string(info.received_ns));
                                    answered.push_back(m.data());
                                  });
  leader.lead_lock_step({.followers = {"first", "second"}, .step_s = 0.01});
  EXPECT_EQ(leader.now_ns(), kFirst_ns);
  {
    const Running of_first(first), of_second(second);
    while (answered.size() < 200) leader.spin_some(0.1);
  }
  ASSERT_EQ(heard.size(), 200U);
  for (std::size_t k = 0; k < heard.size(); ++k) {
    EXPECT_EQ(heard[k], std::to_string(kFirst_ns + std::int64_t(k + 1) * 10'000'000));
  }
  EXPECT_EQ(heard, answered);
}

// Clouds and maps have a port of their own elsewhere, which a busy machine may serve later.
TEST(LockStep, MegabytesAreHeardInTheStepInWhichTheyWereSent) {
  const auto a = join({"/leader"}), b = join({"/follower"});
  Node leader(*a, "leader"), follower(*b, "follower");
  leader.lead_lock_step({.followers = {"follower"}, .step_s = 0.01});
  follower.run_in_lock_step();
  const auto clouds =
      follower.advertise<sensor_msgs::msg::PointCloud2>("clouds", Qos::best_effort());
  follower.every(0.01, [&] {
    sensor_msgs::msg::PointCloud2 cloud;
    cloud.header().stamp(conversions::to_stamp(follower.now_ns()));
    cloud.data().resize(40'000);
    EXPECT_TRUE(clouds.publish(cloud));
  });
  std::vector<std::int64_t> stamps_ns;
  leader.subscribe<sensor_msgs::msg::PointCloud2>(
      "clouds", Qos::best_effort(), [&](const auto& m, const MessageInfo& info) {
        stamps_ns.push_back(conversions::to_ns(m.header().stamp()));
        EXPECT_EQ(stamps_ns.back(), info.received_ns);
      });
  const Running of_follower(follower);
  while (stamps_ns.size() < 200) leader.spin_some(0.1);
  for (std::size_t k = 0; k < stamps_ns.size(); ++k) {
    EXPECT_EQ(stamps_ns[k], kFirst_ns + std::int64_t(k + 1) * 10'000'000);
  }
}

TEST(LockStep, ComesBeforeSubscriptionsWithAPortOfTheirOwn) {
  const auto context = join({"/n"});
  Node leader(*context, "leader"), follower(*context, "follower");
  for (Node* node : {&leader, &follower}) {
    node->subscribe<sensor_msgs::msg::PointCloud2>("clouds", Qos::best_effort(),
                                                   [](const auto&, const MessageInfo&) {});
  }
  EXPECT_THROW(leader.lead_lock_step({.followers = {"x"}}), std::logic_error);
  EXPECT_THROW(follower.run_in_lock_step(), std::logic_error);
}

TEST(LockStep, TimeStandsStillUntilEveryFollowerIsThere) {
  const auto a = join({"/late"}), b = join({"/leader"});
  Node leader(*b, "leader");
  int steps = 0;
  leader.lead_lock_step({.followers = {"late"}, .step_s = 0.01});
  leader.every(0.01, [&] { ++steps; });
  const Running of_leader(leader);
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  EXPECT_EQ(steps, 0);
  Node late(*a, "late");
  late.run_in_lock_step();
  int turns = 0;
  late.every(0.01, [&] { ++turns; });
  EXPECT_TRUE(spin_until(late, [&] { return turns >= 50; }));
}

TEST(LockStep, ListsOfNamesMayHoldBlanks) {
  EXPECT_EQ(split_names(" navigator, tracker,,x"),
            (std::vector<std::string>{"navigator", "tracker", "x"}));
  EXPECT_TRUE(split_names("").empty());
}

}  // namespace
}  // namespace goshawk::runtime
