#include "goshawk/runtime/node.hpp"

#include <gmock/gmock.h>

#include <atomic>
#include <thread>

#include "domain.hpp"
#include "goshawk_msgs.h"
#include "octomap_msgs.h"
#include "std_msgs.h"

namespace goshawk::runtime {
namespace {

using octomap_msgs::msg::Octomap;
using runtime_test::join;
using runtime_test::spin_until;
using std_msgs::msg::String;
using testing::ElementsAre;
using testing::HasSubstr;

String text(const std::string& data) {
  String message;
  message.data(data);
  return message;
}

/// Two participants: what they exchange goes over UDP on loopback.
class Nodes : public testing::Test {
 protected:
  std::unique_ptr<Context> context_a_ = join({"/a"});
  std::unique_ptr<Context> context_b_ = join({"/b"});
  Node a_{*context_a_, "a"};
  Node b_{*context_b_, "b"};

  bool meet(const RawPublisher& publisher) {
    return spin_until(b_, [&] { return publisher.matched() > 0; });
  }
};

TEST_F(Nodes, AClockThatIsSetTellsOtherStampsAndTheSameDurations) {
  const auto clock = std::make_shared<ManualClock>();
  const Node node(*context_a_, "clocked", {}, clock);
  clock->set(100);
  clock->step_wall_clock(-30);
  EXPECT_EQ(node.now_ns(), 70);
  EXPECT_EQ(node.monotonic_ns(), 100);
  clock->advance(5);
  EXPECT_EQ(node.now_ns(), 75);
  EXPECT_EQ(node.monotonic_ns(), 105);
  const std::int64_t before_ns = a_.monotonic_ns();
  EXPECT_GE(b_.monotonic_ns(), before_ns);  // one clock for a whole machine
}

TEST_F(Nodes, DeliverInOrder) {
  const auto publisher = a_.advertise<String>("t", Qos::reliable_last(100));
  std::vector<std::string> got;
  b_.subscribe<String>("t", Qos::reliable_last(100),
                       [&](const String& m, const auto&) { got.push_back(m.data()); });
  ASSERT_TRUE(meet(publisher));
  std::vector<std::string> sent;
  for (int i = 0; i < 100; ++i) {
    sent.push_back(std::to_string(i));
    ASSERT_TRUE(publisher.publish(text(sent.back())));
  }
  spin_until(b_, [&] { return got.size() == 100; });
  EXPECT_EQ(got, sent);
  EXPECT_TRUE(publisher.wait_acknowledged(60.0));
}

TEST_F(Nodes, DoDeferredWorkAfterTheMessagesThatAreThere) {
  const auto publisher = a_.advertise<String>("t", Qos::reliable_last(100));
  const auto other = a_.advertise<String>("u", Qos::reliable_last(100));
  std::vector<std::string> events;
  b_.subscribe<String>("t", Qos::reliable_last(100), [&](const String& m, const auto&) {
    events.push_back(m.data());
    b_.later([&, text = m.data()] { events.push_back("later " + text); });
  });
  b_.subscribe<String>("u", Qos::reliable_last(100),
                       [&](const String& m, const auto&) { events.push_back(m.data()); });
  ASSERT_TRUE(meet(publisher) && meet(other));
  for (const char* data : {"1", "2"}) ASSERT_TRUE(publisher.publish(text(data)));
  ASSERT_TRUE(other.publish(text("3")));
  ASSERT_TRUE(publisher.wait_acknowledged(60.0) && other.wait_acknowledged(60.0));
  spin_until(b_, [&] { return events.size() == 5; });
  EXPECT_THAT(events, ElementsAre("1", "2", "3", "later 1", "later 2"));
}

TEST_F(Nodes, DeliverMessagesOf25Megabytes) {
  const auto publisher = a_.advertise<Octomap>("big", Qos::reliable_last(1));
  Octomap big;
  for (int i = 0; i < 25'000'000; ++i) big.data().push_back(std::int8_t(i * 7));
  int got = 0;
  bool same = true;
  b_.subscribe<Octomap>("big", Qos::reliable_last(1), [&](const Octomap& m, const auto&) {
    ++got;
    same = same && m == big;
  });
  ASSERT_TRUE(meet(publisher));
  for (int i = 1; i <= 2; ++i) {
    ASSERT_TRUE(publisher.publish(big));
    EXPECT_TRUE(spin_until(b_, [&] { return got == i; }));
  }
  EXPECT_TRUE(same);
}

TEST_F(Nodes, GiveALateComerTheNewestLatchedMessages) {
  const auto publisher = a_.advertise<String>("latched", Qos::latched(2));
  for (const char* data : {"1", "2", "3"}) ASSERT_TRUE(publisher.publish(text(data)));
  std::vector<std::string> got;
  b_.subscribe<String>("latched", Qos::latched(10),
                       [&](const String& m, const auto&) { got.push_back(m.data()); });
  spin_until(b_, [&] { return got.size() == 2; });
  EXPECT_THAT(got, ElementsAre("2", "3"));
  bool volatile_got = false;
  b_.subscribe<String>("latched", Qos::reliable_last(),
                       [&](const String&, const auto&) { volatile_got = true; });
  spin_until(
      b_, [] { return false; }, 0.3);
  EXPECT_FALSE(volatile_got) << "who does not ask for old messages gets none";
}

TEST_F(Nodes, DeliverBestEffort) {
  const auto publisher = a_.advertise<String>("fast", Qos::best_effort(10));
  int got = 0;
  b_.subscribe<String>("fast", Qos::best_effort(10), [&](const String&, const auto&) { ++got; });
  bool reliable_got = false;
  b_.subscribe<String>("fast", Qos::reliable_last(),
                       [&](const String&, const auto&) { reliable_got = true; });
  EXPECT_TRUE(spin_until(b_, [&] {
    (void)publisher.publish(text("x"));
    return got >= 3;
  }));
  EXPECT_FALSE(reliable_got) << "a reliable reader must not match a best-effort writer";
}

TEST_F(Nodes, KeepTypesOfOneTopicApart) {
  const auto strings = a_.advertise<String>("mixed", Qos::latched());
  const auto maps = a_.advertise<Octomap>("other", Qos::latched());
  int got = 0;
  b_.subscribe<Octomap>("mixed", Qos::latched(), [&](const Octomap&, const auto&) { ++got; });
  (void)strings.publish(text("not a map"));
  spin_until(
      b_, [] { return false; }, 0.5);
  EXPECT_EQ(got, 0);
  EXPECT_THROW(a_.advertise<Octomap>("mixed", Qos::latched()), StartupFault);
  EXPECT_THROW(a_.subscribe<Octomap>("mixed", Qos::latched(), nullptr), StartupFault);
}

TEST_F(Nodes, ReadOneTopicAsStructsAndAsBytesInOneProcess) {
  const auto publisher = a_.advertise<String>("both", Qos::latched());
  std::string typed;
  std::vector<unsigned char> raw;
  const auto raw_type = raw_message_type(wire_type_name("std_msgs/msg/String"));
  b_.subscribe<String>("both", Qos::latched(),
                       [&](const String& m, const auto&) { typed = m.data(); });
  b_.subscribe_raw("both", raw_type, Qos::latched(), [&](const void* m, const auto&) {
    raw = *static_cast<const std::vector<unsigned char>*>(m);
  });
  ASSERT_TRUE(publisher.publish(text("hello")));
  EXPECT_TRUE(spin_until(b_, [&] { return !typed.empty() && !raw.empty(); }));
  EXPECT_EQ(typed, "hello");
  // RTPS pads payloads to whole words of 4 bytes.
  const auto expected = encode(text("hello"));
  ASSERT_GE(raw.size(), expected.size());
  EXPECT_LT(raw.size(), expected.size() + 4);
  raw.resize(expected.size());
  EXPECT_EQ(raw, expected);
  // And the other way round: bytes out, structs in, beside a typed writer.
  const auto raw_publisher = b_.advertise_raw("both", raw_type, Qos::latched());
  const auto bytes = encode(text("again"));
  ASSERT_TRUE(raw_publisher.publish_raw(&bytes));
  EXPECT_TRUE(spin_until(b_, [&] { return typed == "again"; }));
}

TEST_F(Nodes, ApplyNamespaceAndRemapping) {
  RosArgs args;
  args.node_namespace = "/uav1";
  args.remaps = {{"in", "/shared"}};
  Node named(*context_b_, "named", args);
  EXPECT_EQ(named.full_name(), "/uav1/named");
  const auto shared = a_.advertise<String>("/shared", Qos::latched());
  (void)shared.publish(text("x"));
  int got = 0;
  named.subscribe<String>("in", Qos::latched(), [&](const String&, const auto&) { ++got; });
  EXPECT_TRUE(spin_until(named, [&] { return got == 1; }));
  named.subscribe<String>("out", Qos::latched(), [](const String&, const auto&) {});
  EXPECT_TRUE(spin_until(named, [&] {
    for (const auto& e : context_a_->endpoints()) {
      if (e.topic == "/uav1/out" && !e.writer) return true;
    }
    return false;
  }));
}

TEST_F(Nodes, SeeTheOthersInTheDomain) {
  const auto publisher = a_.advertise<goshawk_msgs::msg::Path>("path", Qos::latched());
  ASSERT_TRUE(spin_until(b_, [&] { return !context_b_->endpoints().empty(); }));
  const auto endpoint = context_b_->endpoints().front();
  EXPECT_EQ(endpoint.topic, "/path");
  EXPECT_EQ(endpoint.type, "goshawk_msgs/msg/Path");
  EXPECT_TRUE(endpoint.writer && endpoint.reliable && endpoint.transient_local);
  EXPECT_TRUE(context_a_->endpoints().empty()) << "its own are not others'";
  ASSERT_EQ(context_b_->participants().size(), 1u);
  EXPECT_EQ(context_b_->participants()[0].guid_prefix, endpoint.participant);
  EXPECT_THAT(context_b_->participants()[0].nodes, ElementsAre("/a"));
}

TEST_F(Nodes, RunTimersEvenWhenOneAddsAnother) {
  int fast = 0, added = 0;
  a_.every(0.005, [&] {
    if (++fast <= 50) a_.every(0.005, [&] { ++added; });
  });
  EXPECT_TRUE(spin_until(a_, [&] { return fast > 60 && added > 100; }));
  EXPECT_THROW(a_.every(0.0, [] {}), std::invalid_argument);
  EXPECT_THROW(a_.every(std::nan(""), [] {}), std::invalid_argument);
}

TEST_F(Nodes, DoNotMakeUpForLateTimerCalls) {
  int calls = 0;
  a_.every(0.01, [&] {
    if (++calls == 1) std::this_thread::sleep_for(std::chrono::milliseconds(200));
  });
  spin_until(a_, [&] { return calls >= 1; });
  const int before = calls;
  a_.spin_some(0.0);
  a_.spin_some(0.0);
  EXPECT_LE(calls - before, 2);
}

TEST_F(Nodes, StopFromAnotherThreadAndForGood) {
  std::thread spinning([&] { a_.spin(); });
  std::this_thread::sleep_for(std::chrono::milliseconds(50));
  a_.stop();
  spinning.join();
  a_.spin();  // returns at once: it was stopped
  b_.stop();
  b_.spin();
}

TEST_F(Nodes, WaitNotForOddTimeouts) {
  for (const double timeout_s : {0.0, -1.0, std::nan("")}) a_.spin_some(timeout_s);
  a_.every(0.01, [] {});
  a_.spin_some(std::numeric_limits<double>::infinity());  // until the timer
}

TEST_F(Nodes, AreNotDelayedByASlowNeighbour) {
  Node slow(*context_b_, "slow");
  const auto publisher = a_.advertise<String>("t", Qos::reliable_last(10));
  std::atomic<bool> release = false, entered = false;
  slow.subscribe<String>("t", Qos::reliable_last(), [&](const String&, const auto&) {
    entered = true;
    while (!release) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  });
  int got = 0;
  b_.subscribe<String>("t", Qos::reliable_last(), [&](const String&, const auto&) { ++got; });
  std::thread slow_thread([&] { slow.spin(); });
  const bool both = spin_until(b_, [&] { return publisher.matched() == 2; });
  for (int i = 0; both && i < 5; ++i) (void)publisher.publish(text("x"));
  // The fast one gets all five while the slow one is stuck in its first.
  EXPECT_TRUE(spin_until(b_, [&] { return got == 5 && entered; }));
  EXPECT_FALSE(release);
  release = true;
  slow.stop();
  slow_thread.join();
}

TEST_F(Nodes, ServeTimersDuringAFlood) {
  const auto publisher = a_.advertise<String>("flood", Qos::best_effort(1000));
  std::atomic<bool> done = false;
  int ticks = 0;
  b_.subscribe<String>("flood", Qos::best_effort(1000), [](const String&, const auto&) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));  // slower than they come
  });
  b_.every(0.01, [&] { ++ticks; });
  std::thread flooding([&] {
    while (!done) {
      for (int i = 0; i < 10; ++i) (void)publisher.publish(text("x"));
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  });
  EXPECT_TRUE(spin_until(b_, [&] { return ticks >= 10; }));
  done = true;
  flooding.join();
}

TEST_F(Nodes, LetABugInACallbackOut) {
  a_.every(0.001, [] { throw std::logic_error("bug"); });
  EXPECT_THROW(spin_until(
                   a_, [] { return false; }, 5.0),
               std::logic_error);
}

TEST(Contexts, RefuseDomainsThatAreNone) {
  for (const char* text : {"233", "-1", "abc", "1x", " 1", "99999999999"}) {
    setenv("ROS_DOMAIN_ID", text, 1);
    const auto options = ContextOptions::from_environment();
    EXPECT_EQ(options.code(), ErrorCode::invalid_parameter) << text;
    EXPECT_THAT(options.error().message, HasSubstr("from 0 to 232"));
  }
  for (const char* text : {"", "0", "232"}) {
    setenv("ROS_DOMAIN_ID", text, 1);
    EXPECT_TRUE(ContextOptions::from_environment()) << text;
  }
  unsetenv("ROS_DOMAIN_ID");
  for (const int domain : {-1, 233, 1'000'000}) {
    ContextOptions options;
    options.domain = domain;
    EXPECT_EQ(Context::create(options).code(), ErrorCode::invalid_parameter) << domain;
  }
}

TEST(Contexts, RefuseInterfacesThatAreNone) {
  ContextOptions options;
  options.domain = runtime_test::domain();
  for (const char* interfaces : {"", "eth0", "256.1.1.1", "10.255.255.254"}) {
    options.interfaces = interfaces;
    EXPECT_FALSE(Context::create(options)) << interfaces;
  }
}

}  // namespace
}  // namespace goshawk::runtime
