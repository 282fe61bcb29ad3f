// `goshawk why` as a process of its own, on recordings that this test writes.

#include <gmock/gmock.h>

#include <nlohmann/json.hpp>

#include "child.hpp"
#include "goshawk/recording/writer.hpp"
#include "goshawk/runtime/message_type.hpp"
#include "goshawk_msgs.h"

namespace {

using goshawk_msgs::msg::NavigatorState;
using testing::HasSubstr;

/// A recording of navigators: the one in a namespace is heard after so many seconds.
std::string recording_of(const std::vector<std::pair<std::string, double>>& heard) {
  namespace recording = goshawk::recording;
  std::string path = testing::TempDir() + "cli_why_" + std::to_string(getpid()) + ".mcap";
  auto writer = recording::Writer::create(recording::create_file(path, true).value()).value();
  for (const auto& [space, at_s] : heard) {
    const auto channel =
        writer.add_channel({.topic = space + "/navigator_state", .message_encoding = "cdr"});
    const auto bytes = goshawk::runtime::encode(NavigatorState());
    const auto at_ns = 1'000'000'000U + std::uint64_t(at_s * 1e9);
    EXPECT_TRUE(writer.write({.channel_id = channel,
                              .log_time_ns = at_ns,
                              .publish_time_ns = at_ns,
                              .data = {bytes.data(), bytes.size()}}));
  }
  EXPECT_TRUE(writer.close());
  return path;
}

std::string binds(std::vector<std::string> words) {
  words.insert(words.begin(), "why");
  words.emplace_back("--json");
  const auto outcome = cli_test::run(std::move(words));
  EXPECT_EQ(outcome.status, 0) << outcome.out;
  return nlohmann::json::parse(outcome.out).value("binds", "");
}

TEST(WhyVerb, OfARecordingLooksAtTheOnlyVehicle) {
  EXPECT_EQ(binds({recording_of({{"/uav1", 0.0}})}), "no_odometry");
  EXPECT_EQ(binds({recording_of({{"", 0.0}})}), "no_odometry");
}

TEST(WhyVerb, OfARecordingWithSeveralVehiclesLooksAtTheOneThatIsNamed) {
  const std::string path = recording_of({{"/uav1", 0.0}, {"/uav2", 5.0}});
  EXPECT_EQ(binds({path, "--namespace", "/uav1"}), "no_navigator");  // silent for 5 s
  EXPECT_EQ(binds({path, "--namespace", "/uav2"}), "no_odometry");
  EXPECT_EQ(binds({path, "--namespace", "/uav1", "--at", "0.5"}), "no_odometry");
  const auto outcome = cli_test::run({"why", path});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("name one with --namespace (/uav1, /uav2)"));
}

TEST(WhyVerb, RefusesAMomentAfterTheEnd) {
  const auto outcome = cli_test::run({"why", recording_of({{"", 0.0}, {"", 2.0}}), "--at", "3"});
  EXPECT_EQ(outcome.status, 2);
  EXPECT_THAT(outcome.err, HasSubstr("--at 3: the recording lasts 2.00 s"));
}

}  // namespace
