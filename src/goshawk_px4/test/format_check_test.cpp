#include "goshawk/px4/format_check.hpp"

#include <gtest/gtest.h>

#include "goshawk/px4_wire/codec.hpp"
#include "recorder.hpp"

namespace goshawk::px4 {
namespace {

constexpr std::int64_t kSecond_ns = 1'000'000'000;

class Formats : public testing::Test {
 protected:
  /// The next question, answered as PX4 of that release would.
  Status answer(FormatCheck& check, Release release) {
    now_ns += kSecond_ns;
    check.step(now_ns, link);
    MessageFormatResponse response;
    response.topic_name = link.formats.back().topic_name;
    response.success = true;
    const std::string topic = text_of(response.topic_name);
    const std::string_view type = topic == "/fmu/out/vehicle_status"     ? "VehicleStatus"
                                  : topic == "/fmu/out/vehicle_odometry" ? "VehicleOdometry"
                                                                         : "VehicleLocalPosition";
    response.message_hash = definition_of(type, release).layout.hash();
    return check.hear(response);
  }

  Recorder link;
  std::int64_t now_ns = 0;
  Config config;
};

TEST_F(Formats, OneTopicAfterAnotherIsAskedForWithoutItsSuffix) {
  FormatCheck check(config);
  ASSERT_TRUE(answer(check, Release::v1_17));
  ASSERT_TRUE(answer(check, Release::v1_17));
  EXPECT_EQ(text_of(link.formats[0].topic_name), "/fmu/out/vehicle_status");
  EXPECT_EQ(text_of(link.formats[1].topic_name), "/fmu/out/vehicle_odometry");
  EXPECT_FALSE(check.done());
}

TEST_F(Formats, AnotherReleaseIsNamedWithWhatToSet) {
  FormatCheck check(config);
  const auto refused = answer(check, Release::v1_18);
  ASSERT_EQ(refused.code(), ErrorCode::invalid_parameter);
  EXPECT_NE(refused.error().message.find("set px4_release to 1.18"), std::string::npos)
      << refused.error().message;
}

TEST_F(Formats, ALayoutOfNoReleaseIsSaidToBeSo) {
  FormatCheck check(config);
  check.step(0, link);
  MessageFormatResponse response;
  response.topic_name = link.formats.back().topic_name;
  response.success = true;
  response.message_hash = 1;
  EXPECT_NE(check.hear(response).error().message.find("no release"), std::string::npos);
  response.success = false;
  EXPECT_NE(check.hear(response).error().message.find("dds_topics.yaml"), std::string::npos);
}

TEST_F(Formats, AQuestionIsRepeatedAndAnswersToOthersDoNotCount) {
  FormatCheck check(config);
  for (int i = 0; i < 100; ++i) check.step(i * kSecond_ns / 50, link);
  EXPECT_GE(link.formats.size(), 5u);
  EXPECT_LE(link.formats.size(), 8u);
  EXPECT_TRUE(check.unanswered());
  MessageFormatResponse other;
  other.topic_name = characters_of<50>("/fmu/out/battery_status");
  EXPECT_TRUE(check.hear(other));
  EXPECT_EQ(check.topic(), "fmu/out/vehicle_status");
}

}  // namespace
}  // namespace goshawk::px4
