// Calls that are wrong, or find nothing: the verbs as processes of their own in a domain without
// nodes.

#include <gmock/gmock.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "child.hpp"

namespace {

using cli_test::run;
using testing::HasSubstr;
using Json = nlohmann::json;

// Nobody is in this domain.
int empty_domain() {
  static const int held = goshawk::runtime::hold_private_domain().value();
  return held;
}

TEST(VerbsAlone, NeverHangWhereNothingIs) {
  for (const auto& verb : {std::vector<std::string>{"topic", "list"},
                           {"topic", "info", "/a"},
                           {"topic", "echo", "/a"},
                           {"topic", "hz", "/a"},
                           {"node", "list"},
                           {"topic", "pub", "/a", "std_msgs/msg/String", "{}", "--once"}}) {
    auto arguments = verb;
    arguments.insert(arguments.end(), {"--timeout", "0.3"});
    const auto outcome = run(arguments, empty_domain());
    EXPECT_EQ(outcome.status, 1) << verb[1] << outcome.err;
    EXPECT_FALSE(outcome.err.empty());
  }
}

TEST(VerbsAlone, NameWhatIsWrongInACall) {
  const auto expect = [](std::vector<std::string> arguments, const char* sentence) {
    const auto outcome = run(arguments, empty_domain());
    EXPECT_EQ(outcome.status, 2) << arguments[1];
    EXPECT_THAT(outcome.err, HasSubstr(sentence));
    EXPECT_THAT(outcome.out, testing::IsEmpty());
  };
  expect({"topic", "ecko", "/a"}, "did you mean echo?");
  expect({"topic"}, "a verb is missing: goshawk topic list | info | type | find | echo");
  expect({"topic", "echo"}, "topic is required");
  expect({"topic", "echo", "/a b"}, "is not a valid name");
  expect({"topic", "echo", "/a", "-n", "0"}, "-n");
  expect({"topic", "list", "--timeout", "-1"}, "--timeout");
  expect({"topic", "pub", "/a", "std_msgs/msg/Strin", "{}"}, "did you mean std_msgs/msg/String?");
  expect({"topic", "pub", "/a", "std_msgs/msg/String", "{dat: 1}"}, "did you mean data?");
  expect({"topic", "pub", "/a", "std_msgs/msg/String", "{data: 1}"}, "quote it");
  expect({"topic", "pub", "/a", "std_msgs/msg/String", "{data: [}"}, "neither JSON nor YAML");
  expect({"node", "lst"}, "did you mean list?");
  expect({"param", "describe", "no_such_component"}, "no component 'no_such_component'");
}

TEST(VerbsAlone, FailAsJsonWhereThatIsAskedFor) {
  for (const auto& [arguments, status] : {std::pair{std::vector<std::string>{"topic", "list"}, 1},
                                          {{"topic", "echo", "/a", "--once"}, 1},
                                          {{"topic", "echo", "/a b"}, 2},
                                          {{"topic", "hz"}, 2},
                                          {{"node", "list"}, 1},
                                          {{"node", "lst"}, 2},
                                          {{"param", "get", "/a"}, 1},
                                          {{"param", "describe", "no_such_component"}, 2}}) {
    auto call = arguments;
    call.emplace_back("--json");
    if (status == 1) call.insert(call.end(), {"--timeout", "0.3"});
    const auto outcome = run(call, empty_domain());
    EXPECT_EQ(outcome.status, status) << outcome.out;
    const Json json = Json::parse(outcome.out);
    EXPECT_EQ(json["ok"], false);
    EXPECT_FALSE(json["code"].get<std::string>().empty());
    EXPECT_FALSE(json["message"].get<std::string>().empty());
    EXPECT_THAT(outcome.err, testing::IsEmpty());
  }
}

TEST(VerbsAlone, RefuseADomainThatIsNone) {
  const auto outcome = run({"topic", "list"}, 233);
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("from 0 to 232"));
}

TEST(VerbsAlone, HelpIsNoFault) {
  const auto outcome = run({"topic", "echo", "--help"}, empty_domain());
  EXPECT_EQ(outcome.status, 0);
  EXPECT_THAT(outcome.out, HasSubstr("--no-arr"));
}

}  // namespace
