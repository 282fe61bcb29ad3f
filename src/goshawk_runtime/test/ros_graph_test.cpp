// What ROS 2 is told of nodes, read by a participant of Fast DDS alone.

#include <gmock/gmock.h>

#include <chrono>
#include <thread>

#include "domain.hpp"
#include "goshawk/runtime/message_type.hpp"
#include "rmw_dds_common.h"
#include "ros_peer.hpp"
#include "std_msgs.h"

namespace goshawk::runtime {
namespace {

using runtime_test::decode;
using runtime_test::Gid16;
using runtime_test::RosPeer;
using std_msgs::msg::String;
using testing::Contains;
using testing::ElementsAre;
using testing::IsEmpty;

constexpr int kHumble = 24;  // [byte] of a gid
constexpr int kIron = 16;

template <typename Done>
bool until(const Done& done) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (!done() && std::chrono::steady_clock::now() < end) {
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return done();
}

std::unique_ptr<Context> join_as(RosGraphLayout layout) {
  ContextOptions options;
  options.domain = runtime_test::domain();
  options.node_names = {"/uav1/planner"};
  options.ros_graph = layout;
  auto context = Context::create(options);
  if (!context) throw std::runtime_error(context.error().message);
  return *std::move(context);
}

RosArgs in_uav1() {
  RosArgs args;
  args.node_namespace = "/uav1";
  return args;
}

/// A node that writes `out` and reads `in`, and a peer that reads of it.
class RosGraphOfANode : public testing::Test {
 protected:
  void begin(RosGraphLayout layout, bool typehash) {
    publisher_ = {};
    node_.reset();
    context_ = join_as(layout);
    node_ = std::make_unique<Node>(*context_, "planner", in_uav1());
    publisher_ = node_->advertise<String>("out", Qos::reliable_last());
    node_->subscribe<String>("in", Qos::reliable_last(), [](const auto&, const auto&) {});
    peer_ = std::make_unique<RosPeer>(runtime_test::domain(), typehash);
  }

  /// Waits for a message in which done() holds for the planner (nullptr: is not in it).
  template <typename Done>
  bool told(int gid_bytes, const Done& done) {
    return until([&] {
      try {
        if (peer_->newest().empty()) return false;
        told_ = decode(peer_->newest(), gid_bytes);
        return bool(done(told_.node("planner")));
      } catch (const std::exception&) {
        return false;  // the other layout: a newer message may come
      }
    });
  }
  bool told_whole(int gid_bytes) {
    return told(gid_bytes, [&](const auto* n) {
      return n != nullptr && n->readers == std::vector{peer_->found("rt/uav1/in", false)} &&
             n->writers == std::vector{peer_->found("rt/uav1/out", true)};
    });
  }

  std::unique_ptr<Context> context_;
  std::unique_ptr<Node> node_;
  Publisher<String> publisher_;
  std::unique_ptr<RosPeer> peer_;
  runtime_test::ToldParticipant told_;
};

TEST_F(RosGraphOfANode, NamesItsReadersAndWritersByTheGuidsOfDiscovery) {
  begin(RosGraphLayout::automatic, false);
  ASSERT_TRUE(told_whole(kHumble));
  EXPECT_EQ(told_.node("planner")->node_namespace, "/uav1");
  EXPECT_EQ(told_.nodes.size(), 1u);
  const Gid16 writer = peer_->found("rt/uav1/out", true);
  Gid16 participant = {0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 1, 0xc1};
  std::copy_n(writer.begin(), 12, participant.begin());
  EXPECT_EQ(told_.gid, participant);
}

TEST_F(RosGraphOfANode, FollowsWhatComesAndGoes) {
  begin(RosGraphLayout::automatic, false);
  ASSERT_TRUE(told_whole(kHumble));
  publisher_ = {};
  EXPECT_TRUE(told(kHumble, [](const auto* n) { return n && n->writers.empty(); }));
  const auto later = node_->advertise<String>("later", Qos::latched());
  EXPECT_TRUE(told(kHumble, [&](const auto* n) {
    return n && n->writers == std::vector{peer_->found("rt/uav1/later", true)};
  }));
  {
    const auto beside = node_->beside();
    beside->subscribe<String>("more", Qos::reliable_last(), [](const auto&, const auto&) {});
    EXPECT_TRUE(told(kHumble, [](const auto* n) { return n && n->readers.size() == 2; }));
  }
  EXPECT_TRUE(told(kHumble, [](const auto* n) { return n && n->readers.size() == 1; }));
  node_.reset();
  EXPECT_TRUE(told(kHumble, [](const auto* n) { return n == nullptr; }));
  EXPECT_THAT(told_.nodes, IsEmpty());
}

TEST_F(RosGraphOfANode, HasShorterGidsOnceAPeerTellsATypehash) {
  begin(RosGraphLayout::automatic, true);
  EXPECT_TRUE(told_whole(kIron));
}

TEST_F(RosGraphOfANode, KeepsTheLayoutThatWasChosen) {
  begin(RosGraphLayout::humble, true);
  EXPECT_TRUE(told_whole(kHumble));
  publisher_ = {};  // what is told after the peer was met
  EXPECT_TRUE(told(kHumble, [](const auto* n) { return n && n->writers.empty(); }));
  begin(RosGraphLayout::iron, false);
  EXPECT_TRUE(told_whole(kIron));
}

TEST_F(RosGraphOfANode, IsNotToldIfSwitchedOff) {
  begin(RosGraphLayout::off, false);
  ASSERT_TRUE(until([&] { return peer_->found("rt/uav1/out", true) != Gid16{}; }));
  ASSERT_TRUE(until([&] { return peer_->found("rt/uav1/in", false) != Gid16{}; }));
  // Its writer would have been announced before the node's.
  const Gid16 told = peer_->found("ros_discovery_info", true);
  const Gid16 out = peer_->found("rt/uav1/out", true);
  EXPECT_FALSE(std::equal(told.begin(), told.begin() + 12, out.begin()));
}

TEST_F(RosGraphOfANode, HidesAToolAsRosHidesItsOwn) {
  begin(RosGraphLayout::automatic, false);
  const Node tool(*context_, "cli", in_uav1());
  EXPECT_TRUE(told(kHumble, [&](const auto*) { return told_.node("_cli") != nullptr; }));
  EXPECT_EQ(told_.node("cli"), nullptr);
}

runtime_test::Bytes message_of(const Gid16& gid, const std::vector<std::string>& names) {
  rmw_dds_common::msg::ParticipantEntitiesInfo message;
  std::ranges::copy(gid, message.gid().data().begin());
  for (const auto& name : names) {
    message.node_entities_info_seq().emplace_back().node_namespace("/ros");
    message.node_entities_info_seq().back().node_name(name);
  }
  return encode(message);
}

std::vector<std::string> nodes_of_ros(const Context& context) {
  for (const auto& p : context.participants()) {
    if (p.is_ros) return p.nodes;
  }
  return {};
}

TEST(RosNodes, AreListedForWhoWatches) {
  const auto context = join_as(RosGraphLayout::automatic);
  const auto goshawk = runtime_test::join({"/stage"});
  ASSERT_TRUE(context->watch_ros_nodes());
  {
    RosPeer peer(runtime_test::domain(), false);
    peer.say(message_of(peer.gid(), {"probe", "_hidden", "talker"}));
    EXPECT_TRUE(until([&] { return !nodes_of_ros(*context).empty(); }));
    EXPECT_THAT(nodes_of_ros(*context), ElementsAre("/ros/probe", "/ros/talker"));
    // Each participant speaks for itself alone, and a malformed message changes nothing.
    Gid16 other = peer.gid();
    other[11] ^= 1;
    peer.say(message_of(other, {"false"}));
    peer.say({0, 1, 0, 0, 7});
    EXPECT_TRUE(until([&] { return peer.found("ros_discovery_info", false) != Gid16{}; }));
    peer.say(message_of(peer.gid(), {"probe"}));
    EXPECT_TRUE(until([&] { return nodes_of_ros(*context).size() == 1; }));
    EXPECT_THAT(nodes_of_ros(*context), ElementsAre("/ros/probe"));
    EXPECT_TRUE(until([&] { return context->participants().size() == 2; }));
    EXPECT_THAT(context->participants(),
                Contains(testing::Field(&ParticipantInfo::nodes, ElementsAre("/stage"))));
  }
  EXPECT_TRUE(until([&] { return context->participants().size() == 1; }));
}

}  // namespace
}  // namespace goshawk::runtime
