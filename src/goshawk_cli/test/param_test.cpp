// `goshawk param` as a process of its own against a node in this process.

#include <gmock/gmock.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <thread>

#include "child.hpp"
#include "goshawk/core/parameter.hpp"
#include "goshawk/runtime/node.hpp"

namespace cli_test {

struct LimitsConfig {
  double v_max_m_s = 2.0;
  double a_max_m_s2 = 2.0;
  std::string shape = "round";
  std::string note = "a: 'b'";
  int count = 3;
};

template <typename Self, typename Visitor>
requires std::same_as<std::remove_const_t<Self>, LimitsConfig>
void describe(Self& c, Visitor&& visit) {
  using goshawk::AtRunTime;
  visit("v_max_m_s", c.v_max_m_s, "m/s", "speed limit", AtRunTime{goshawk::Range{0.1, 10.0}});
  visit("a_max_m_s2", c.a_max_m_s2, "m/s^2", "limit", AtRunTime{goshawk::Range::positive(9.0)});
  visit("shape", c.shape, "", "of all", AtRunTime{goshawk::OneOf{{"round", "square"}}});
  visit("note", c.note, "", "free text", AtRunTime{goshawk::Anything{}});
  visit("count", c.count, "", "how many", goshawk::Range{1, 10});
}

namespace {

using namespace goshawk::runtime;
using testing::AllOf;
using testing::HasSubstr;
using Json = nlohmann::json;

Outcome param(std::vector<std::string> arguments, const std::string& timeout_s = "30") {
  arguments.insert(arguments.begin(), "param");
  arguments.insert(arguments.end(), {"--timeout", timeout_s});
  return run(std::move(arguments));
}

/// The node /uav1/pilot with a thread of its own.
class Param : public testing::Test {
 protected:
  Param() {
    ContextOptions options;
    options.domain = domain();
    options.node_names = {"/uav1/pilot"};
    context_ = *Context::create(options);
    RosArgs args;
    args.node_namespace = "/uav1";
    node_ = std::make_unique<Node>(*context_, "pilot", args);
    (void)node_->parameters<LimitsConfig>([](const LimitsConfig& c) -> goshawk::Status {
      if (c.a_max_m_s2 <= c.v_max_m_s) return goshawk::success();
      return goshawk::fail(goshawk::ErrorCode::invalid_parameter, "a_max is above v_max");
    });
    thread_ = std::thread([this] { node_->spin(); });
  }
  ~Param() override {
    node_->stop();
    thread_.join();
  }

  std::unique_ptr<Context> context_;
  std::unique_ptr<Node> node_;
  std::thread thread_;
};

TEST_F(Param, SetsGetsListsAndDumps) {
  const auto set = param({"set", "uav1/pilot", "v_max_m_s", "3.5", "shape", "square"});
  EXPECT_EQ(set.status, 0) << set.err;
  EXPECT_THAT(set.out, AllOf(HasSubstr("v_max_m_s: 2 -> 3.5 m/s\n"),
                             HasSubstr("shape: 'round' -> 'square'\n")));
  EXPECT_EQ(param({"get", "/uav1/pilot", "v_max_m_s"}).out, "3.5\n");
  const auto json = Json::parse(param({"get", "/uav1/pilot", "--json"}).out);
  EXPECT_EQ(json["ok"], true);
  EXPECT_EQ(json["node"], "/uav1/pilot");
  ASSERT_EQ(json["parameters"].size(), 5U);
  EXPECT_EQ(json["parameters"][0]["value"], "3.5");
  EXPECT_EQ(json["parameters"][0]["default"], "2");
  EXPECT_EQ(json["parameters"][0]["at_run_time"], true);
  EXPECT_EQ(json["parameters"][4]["at_run_time"], false);
  EXPECT_THAT(param({"list", "/uav1/pilot"}).out,
              AllOf(HasSubstr("v_max_m_s   3.5 m/s"), HasSubstr("at start only")));
  EXPECT_THAT(param({"describe", "/uav1/pilot", "shape"}).out,
              AllOf(HasSubstr("range: one of round, square"), HasSubstr("now: 'square'")));

  // What is dumped, a node takes at its start.
  const auto path = std::filesystem::temp_directory_path() /
                    ("goshawk_dump_" + std::to_string(getpid()) + ".yaml");
  std::ofstream(path) << param({"dump", "/uav1/pilot"}).out;
  ParameterSource source;
  ASSERT_TRUE(source.add_file(path.string(), "pilot", "/uav1"));
  std::filesystem::remove(path);
  const auto config = read_parameters<LimitsConfig>(source, "pilot");
  ASSERT_TRUE(config) << config.error().message;
  EXPECT_EQ(config->v_max_m_s, 3.5);
  EXPECT_EQ(config->shape, "square");
  EXPECT_EQ(config->note, "a: 'b'");
}

TEST_F(Param, ARefusalIsASentenceAndStatus2) {
  const auto refused = [](std::vector<std::string> arguments, const char* sentence) {
    const auto outcome = param(std::move(arguments));
    EXPECT_EQ(outcome.status, 2) << sentence << outcome.err;
    EXPECT_THAT(outcome.err, HasSubstr(sentence));
  };
  refused({"set", "uav1/pilot", "v_max_m_s", "0"}, "at least 0.1 and at most 10");
  refused({"set", "uav1/pilot", "v_max_m_s", "-1"}, "at least 0.1 and at most 10");
  refused({"set", "uav1/pilot", "v_max", "3"}, "did you mean v_max_m_s?");
  refused({"set", "uav1/pilot", "v_max_m_s", "fast"}, "is not a number");
  refused({"set", "uav1/pilot", "count", "4"}, "takes effect at start only");
  refused({"set", "uav1/pilot", "a_max_m_s2", "8"}, "a_max is above v_max");
  refused({"set", "uav1/pilot", "v_max_m_s", "3", "shape"}, "shape has no value");
  refused({"get", "uav1/pilot", "counts"}, "did you mean count?");
  const auto json = param({"set", "uav1/pilot", "v_max_m_s", "0", "--json"});
  EXPECT_EQ(Json::parse(json.out)["code"], "invalid_parameter");
  EXPECT_EQ(param({"get", "uav1/pilot", "v_max_m_s"}).out, "2\n");
}

TEST_F(Param, ANodeThatIsNotThereIsASentenceAndStatus1) {
  const auto outcome = param({"set", "uav1/pilt", "v_max_m_s", "3"}, "1.5");
  EXPECT_EQ(outcome.status, 1);
  EXPECT_THAT(outcome.err, HasSubstr("there is no node /uav1/pilt"));
  EXPECT_EQ(param({"get", "a b"}, "1").status, 2);
}

}  // namespace
}  // namespace cli_test
