// The verbs as a process of their own against nodes in this process: real DDS on loopback, in a
// domain that the process id picks.

#include <gmock/gmock.h>

#include <chrono>
#include <nlohmann/json.hpp>
#include <thread>

#include "child.hpp"
#include "goshawk/runtime/node.hpp"
#include "goshawk_msgs.h"
#include "std_msgs.h"

namespace {

using goshawk::runtime::Context;
using goshawk::runtime::ContextOptions;
using goshawk::runtime::Node;
using goshawk::runtime::Qos;
using testing::HasSubstr;
using testing::StartsWith;
using Json = nlohmann::json;
using cli_test::Child;
using cli_test::domain;
using cli_test::find;
using cli_test::Outcome;
using cli_test::run;
using cli_test::seconds_since;
using cli_test::Steady;

/// A domain in which a planner publishes a path every 20 ms, latches a map and a state, and reads a
/// goal.
class Verbs : public testing::Test {
 protected:
  void SetUp() override {
    ContextOptions options;
    options.domain = domain();
    options.node_names = {"/uav1/planner"};
    auto context = Context::create(options);
    ASSERT_TRUE(context) << context.error().message;
    context_ = *std::move(context);
    goshawk::runtime::RosArgs args;
    args.node_namespace = "/uav1";
    node_ = std::make_unique<Node>(*context_, "planner", args);
    path_ = node_->advertise<goshawk_msgs::msg::Path>("path", Qos::reliable_last());
    map_ = node_->advertise<goshawk_msgs::msg::VoxelGrid>("map/voxels", Qos::latched());
    node_->subscribe<std_msgs::msg::String>("goal", Qos::reliable_last(),
                                            [this](const auto& message, const auto&) {
                                              const std::lock_guard lock(mutex_);
                                              goals_.push_back(message.data());
                                            });
    goshawk_msgs::msg::VoxelGrid map;
    map.header().frame_id("map");
    map.grown().assign(100, 7);
    ASSERT_TRUE(map_.publish(map));
    state_ = node_->advertise<goshawk_msgs::msg::NavigatorState>("state", Qos::latched());
    goshawk_msgs::msg::NavigatorState state;
    state.state(goshawk_msgs::msg::NavigatorState_Constants::STATE_ARRIVED);
    ASSERT_TRUE(state_.publish(state));
    node_->every(0.02, [this] {
      goshawk_msgs::msg::Path path;
      const auto now_ns = node_->now_ns();
      path.header().stamp().sec(std::int32_t(now_ns / 1'000'000'000));
      path.header().stamp().nanosec(std::uint32_t(now_ns % 1'000'000'000));
      path.header().frame_id("map");
      path.waypoints().resize(2);
      path.waypoints()[1].x(1.5);
      (void)path_.publish(path);
    });
    thread_ = std::thread([this] { node_->spin(); });
  }
  void TearDown() override {
    if (!thread_.joinable()) return;
    node_->stop();
    thread_.join();
  }
  std::vector<std::string> goals() {
    const std::lock_guard lock(mutex_);
    return goals_;
  }
  /// A writer ends once its messages have arrived, which the node's thread may take later.
  std::vector<std::string> goals(std::size_t wanted) {
    const auto begin = Steady::now();
    while (goals().size() < wanted && seconds_since(begin) < 60.0) {
      std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return goals();
  }

  std::unique_ptr<Context> context_;
  std::unique_ptr<Node> node_;
  goshawk::runtime::Publisher<goshawk_msgs::msg::Path> path_;
  goshawk::runtime::Publisher<goshawk_msgs::msg::VoxelGrid> map_;
  goshawk::runtime::Publisher<goshawk_msgs::msg::NavigatorState> state_;
  std::thread thread_;
  std::mutex mutex_;
  std::vector<std::string> goals_;
};

/// What is not there costs the whole timeout: a short one, and a longer one as long as the machine
/// has not found so much that it can say the sentence.
Outcome miss(const std::vector<std::string>& arguments, const std::string& sentence) {
  Outcome outcome;
  for (const char* timeout_s : {"0.7", "4", "16"}) {
    auto patient = arguments;
    patient.insert(patient.end(), {"--timeout", timeout_s});
    outcome = run(patient);
    if (outcome.err.find(sentence) != std::string::npos) return outcome;
  }
  ADD_FAILURE() << "'" << sentence << "' is not in: " << outcome.err;
  return outcome;
}

/// Lists are what was found when nothing new came for a moment: on a busy machine that may be a
/// part.
/// @return the first that has all of the words, or the last
Outcome list(const std::vector<std::string>& arguments, const std::vector<std::string>& words) {
  Outcome outcome;
  for (int k = 0; k < 10; ++k) {
    outcome = find(arguments);
    const auto has = [&](const std::string& word) {
      return outcome.out.find(word) < outcome.out.size();
    };
    if (std::ranges::all_of(words, has)) break;
  }
  return outcome;
}

const std::vector<std::string> kTopics{"/uav1/goal", "/uav1/map/voxels", "/uav1/path",
                                       "/uav1/state"};

TEST_F(Verbs, ListsTopicsWithTypes) {
  EXPECT_EQ(list({"topic", "list"}, kTopics).out,
            "/uav1/goal\n/uav1/map/voxels\n/uav1/path\n/uav1/state\n");
  const auto typed = list({"topic", "list", "-t"}, kTopics);
  EXPECT_EQ(typed.status, 0) << typed.err;
  EXPECT_THAT(typed.out, HasSubstr("/uav1/path [goshawk_msgs/msg/Path]\n"));
  const Json json = Json::parse(list({"topic", "list", "--json"}, kTopics).out);
  EXPECT_EQ(json["domain"], domain());
  ASSERT_EQ(json["topics"].size(), 4u);
  EXPECT_EQ(json["topics"][2], Json::parse(R"({"name": "/uav1/path", "publishers": 1,
      "subscribers": 0, "types": ["goshawk_msgs/msg/Path"]})"));
}

TEST_F(Verbs, TellsWhoWritesATopic) {
  const Json json = Json::parse(find({"topic", "info", "uav1/map/voxels", "--json"}).out);
  ASSERT_EQ(json["publishers"].size(), 1u);
  EXPECT_EQ(json["publishers"][0]["nodes"], Json({"/uav1/planner"}));
  EXPECT_EQ(json["publishers"][0]["durability"], "transient_local");
  EXPECT_EQ(json["publishers"][0]["reliability"], "reliable");
  EXPECT_THAT(find({"topic", "info", "/uav1/path"}).out,
              HasSubstr("Publishers: 1\n  /uav1/planner  (reliable, volatile)"));
}

TEST_F(Verbs, EchoesTheNamesOfConstantsAsComments) {
  const auto yaml = find({"topic", "echo", "/uav1/state", "--once"});
  EXPECT_THAT(yaml.out, HasSubstr("\nstate: 3  # STATE_ARRIVED\n")) << yaml.err;
  const auto line = find({"topic", "echo", "/uav1/state", "--once", "--json"});
  EXPECT_EQ(Json::parse(line.out)["state"], 3);
}

TEST_F(Verbs, EchoesMessages) {
  const auto yaml = find({"topic", "echo", "/uav1/path", "--once"});
  EXPECT_EQ(yaml.status, 0) << yaml.err;
  EXPECT_THAT(yaml.out, StartsWith("header:\n  stamp:\n    sec: "));
  EXPECT_THAT(yaml.out,
              HasSubstr("\nwaypoints:\n  - x: 0.0\n    y: 0.0\n    z: 0.0\n  - x: 1.5\n"));
  EXPECT_THAT(yaml.out, HasSubstr("\n---\n"));
  const auto lines = find({"topic", "echo", "/uav1/path", "-n", "3", "--json"});
  EXPECT_EQ(std::ranges::count(lines.out, '\n'), 3);
  const Json first = Json::parse(lines.out.substr(0, lines.out.find('\n')));
  EXPECT_EQ(first["waypoints"][1]["x"], 1.5);
}

TEST_F(Verbs, EchoesTheLatchedMapToALateComer) {
  const auto map = find({"topic", "echo", "/uav1/map/voxels", "--once", "--json", "--no-arr"});
  EXPECT_EQ(map.status, 0) << map.err;
  EXPECT_EQ(Json::parse(map.out)["grown"], "<100 elements>");
}

TEST_F(Verbs, EchoesTheNewestOfWhatALatchedTopicKeeps) {
  const auto counts = node_->advertise<std_msgs::msg::String>("count", Qos::latched(5));
  for (const char* text : {"one", "two", "three"}) {
    std_msgs::msg::String message;
    message.data(text);
    ASSERT_TRUE(counts.publish(message));
  }
  // The newest of what came within a moment: on a busy machine it may be asked for again.
  EXPECT_EQ(list({"topic", "echo", "/uav1/count", "--once"}, {"three"}).out,
            "data: \"three\"\n---\n");
  EXPECT_EQ(find({"topic", "echo", "/uav1/count", "-n", "2", "--field", "data"}).out,
            "one\n---\ntwo\n---\n");
}

TEST_F(Verbs, EchoesAPartOfAMessage) {
  const auto echo = [&](std::vector<std::string> more) {
    std::vector<std::string> words{"topic", "echo", "/uav1/path", "--once"};
    words.insert(words.end(), more.begin(), more.end());
    return find(words);
  };
  EXPECT_EQ(echo({"--field", "waypoints[1].x"}).out, "1.5\n---\n");
  EXPECT_EQ(echo({"--field", "header.frame_id"}).out, "map\n---\n");
  EXPECT_EQ(echo({"--field", "waypoints[1]"}).out, "x: 1.5\ny: 0.0\nz: 0.0\n---\n");
  EXPECT_EQ(echo({"--field", "waypoints", "--csv"}).out, "0.0,0.0,0.0,1.5,0.0,0.0\n");
  EXPECT_EQ(echo({"--field", "waypoints[-1]", "--json"}).out, "{\"x\":1.5,\"y\":0.0,\"z\":0.0}\n");
  const auto wrong = find({"topic", "echo", "/uav1/path", "--field", "waypoint"});
  EXPECT_EQ(wrong.status, 2);
  EXPECT_THAT(wrong.err, HasSubstr("did you mean waypoints?"));
}

TEST_F(Verbs, FindsTopicsOfATypeAndTheTypeOfATopic) {
  EXPECT_EQ(find({"topic", "type", "uav1/path"}).out, "goshawk_msgs/msg/Path\n");
  EXPECT_EQ(find({"topic", "find", "goshawk_msgs/Path"}).out, "/uav1/path\n");
  EXPECT_EQ(run({"topic", "find", "goshawk_msgs/msg/Corridor"}).status, 1);
  const auto wrong = run({"topic", "find", "goshawk_msgs/msg/Pat"});
  EXPECT_EQ(wrong.status, 2);
  EXPECT_THAT(wrong.err, HasSubstr("goshawk_msgs/msg/Path"));
  EXPECT_THAT(find({"topic", "info", "/uav1/path", "-v"}).out,
              HasSubstr("\n    goshawk_msgs/msg/Path, of participant "));
}

TEST_F(Verbs, MeasuresRateDelayAndBandwidth) {
  const auto hz = find({"topic", "hz", "/uav1/path", "-n", "20", "--json"});
  EXPECT_EQ(hz.status, 0) << hz.err;
  const Json rate = Json::parse(hz.out.substr(0, hz.out.find('\n')));
  EXPECT_GT(rate["rate_hz"], 0.0);
  EXPECT_LE(rate["min_s"], rate["max_s"]);
  const auto delay = find({"topic", "delay", "/uav1/path", "-n", "5", "--json"});
  EXPECT_EQ(delay.status, 0) << delay.err;
  EXPECT_GE(Json::parse(delay.out.substr(0, delay.out.find('\n')))["min_s"], 0.0);
  const auto bw = find({"topic", "bw", "/uav1/path", "-n", "10", "--json"});
  EXPECT_EQ(bw.status, 0) << bw.err;
  const Json bytes = Json::parse(bw.out.substr(0, bw.out.find('\n')));
  EXPECT_GT(bytes["bytes_per_s"], 0.0);
  EXPECT_EQ(bytes["min_bytes"], bytes["max_bytes"]);
}

TEST_F(Verbs, DelayNeedsAHeader) {
  const auto outcome = find({"topic", "delay", "/uav1/goal"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("has no header"));
}

TEST_F(Verbs, PublishesJsonAndYaml) {
  const auto once =
      find({"topic", "pub", "/uav1/goal", "std_msgs/String", "{\"data\": \"a\"}", "--once"});
  EXPECT_EQ(once.status, 0) << once.err;
  EXPECT_EQ(goals(1), std::vector<std::string>{"a"});
  const auto thrice = find({"topic", "pub", "/uav1/goal", "std_msgs/msg/String", "data: 'b'", "-r",
                            "100", "-n", "3", "--json"});
  EXPECT_EQ(thrice.status, 0) << thrice.err;
  EXPECT_EQ(goals(4), (std::vector<std::string>{"a", "b", "b", "b"}));
  EXPECT_EQ(Json::parse(thrice.out)["published"], 3);
}

TEST_F(Verbs, PublishesAMessageALineFromStandardInput) {
  Child child({"topic", "pub", "/uav1/goal", "std_msgs/String", "-", "--json", "--timeout", "30"},
              domain(), "{\"data\": \"a\"}\n\ndata: b\n{data: 'the last line needs no end'}");
  const auto all = child.finish();
  EXPECT_EQ(all.status, 0) << all.err;
  EXPECT_EQ(goals(3), (std::vector<std::string>{"a", "b", "the last line needs no end"}));
  EXPECT_EQ(std::ranges::count(all.out, '\n'), 3);
  EXPECT_EQ(Json::parse(all.out.substr(all.out.find('\n', all.out.find('\n') + 1)))["published"],
            3);
  Child wrong({"topic", "pub", "/uav1/goal", "std_msgs/String", "-", "--timeout", "30"}, domain(),
              "{data: c}\n{dat: d}\n{data: e}\n");
  const auto refused = wrong.finish();
  EXPECT_EQ(refused.status, 2);
  EXPECT_THAT(refused.err, HasSubstr("did you mean data?"));
  EXPECT_EQ(goals(4).size(), 4u) << "those before the wrong one, and none behind it";
}

TEST_F(Verbs, PublishesNothingUntilSoManyRead) {
  const auto few =
      miss({"topic", "pub", "/uav1/goal", "std_msgs/String", "{data: d}", "--once", "-w", "2"},
           "only 1 of 2 readers of /uav1/goal came");
  EXPECT_EQ(few.status, 1);
  EXPECT_TRUE(goals().empty());
}

TEST_F(Verbs, ListsNodes) {
  const auto names = find({"node", "list"});
  EXPECT_EQ(names.status, 0) << names.err;
  EXPECT_EQ(names.out, "/uav1/planner\n");
  const Json json = Json::parse(find({"node", "list", "--json"}).out);
  EXPECT_EQ(json["nodes"][0]["name"], "/uav1/planner");
  EXPECT_EQ(json["nodes"][0]["process"], "goshawk_" + std::to_string(getpid()));
}

TEST_F(Verbs, TellsWhatANodeWritesAndReads) {
  const auto text = list({"node", "info", "uav1/planner"}, kTopics);
  EXPECT_THAT(text.out,
              HasSubstr("Publishers: 3\n  /uav1/map/voxels  [goshawk_msgs/msg/VoxelGrid]\n"))
      << text.err;
  EXPECT_THAT(text.out, HasSubstr("Subscribers: 1\n  /uav1/goal  [std_msgs/msg/String]\n"));
  const Json json = Json::parse(list({"node", "info", "/uav1/planner", "--json"}, kTopics).out);
  EXPECT_EQ(json["others"], Json::array());
  EXPECT_EQ(json["publishers"].size(), 3U);
  EXPECT_EQ(json["subscribers"][0]["name"], "/uav1/goal");
  const auto wrong = run({"node", "info", "/uav1/planer", "--timeout", "1"});
  EXPECT_EQ(wrong.status, 1);
  EXPECT_THAT(wrong.err, HasSubstr("/uav1/planer"));
}

TEST_F(Verbs, NameTheNearestTopic) {
  for (const char* verb : {"info", "hz"}) {
    EXPECT_EQ(miss({"topic", verb, "/uav1/pth"}, "did you mean /uav1/path?").status, 2) << verb;
  }
  const std::vector<std::string> pub{"topic",           "pub", "/uav1/gaol",
                                     "std_msgs/String", "{}",  "--once"};
  EXPECT_EQ(miss(pub, "did you mean /uav1/goal?").status, 2);
}

TEST_F(Verbs, EndCleanlyOnCtrlC) {
  for (const auto& verb : {std::vector<std::string>{"topic", "echo", "/uav1/path"},
                           std::vector<std::string>{"topic", "hz", "/uav1/path"}}) {
    Child child(verb);
    child.wait_for_output();
    child.interrupt();
    EXPECT_EQ(child.finish().status, 0) << verb[1];
  }
}

TEST_F(Verbs, SayWhenNoMessageComes) {
  const std::vector<std::string> echo{"topic", "echo", "/uav1/goal", "--once"};
  EXPECT_EQ(miss(echo, "no message came on /uav1/goal within").status, 1);
}

}  // namespace
