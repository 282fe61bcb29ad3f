#include "goshawk/recording_tools/layout.hpp"

#include <gmock/gmock.h>

#include "goshawk/introspection/codec.hpp"
#include "goshawk/recording/writer.hpp"
#include "goshawk/recording_tools/messages.hpp"
#include "goshawk/recording_tools/replay.hpp"
#include "goshawk_msgs.h"
#include "memory_sink.hpp"
#include "nav_msgs.h"

namespace goshawk::recording {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

// As version 1 recorded stage_report: who speaks was a string.
constexpr const char* kOldStageReport = R"(# What a stage has to say.
std_msgs/Header header  # stamp: when published
string stage  # "path_search", "corridor_builder", ...
string implementation  # "jastar", ...
uint64 request_id  # 0: about the stage itself
string code  # "ok", or an error code
string message  # a sentence: what is wrong, how to mend it
int64 wire_ns  # [ns] from the input's stamp to its arrival
int64 compute_ns  # [ns] spent in the core
goshawk_msgs/Counter[] counters  # of the stage's work
================================================================================
MSG: std_msgs/Header
builtin_interfaces/Time stamp  # when what it says was true
string frame_id
================================================================================
MSG: builtin_interfaces/Time
int32 sec
uint32 nanosec
================================================================================
MSG: goshawk_msgs/Counter
string name
float64 value
)";

TEST(Layout, OfADefinitionIsThatOfItsType) {
  for (const auto& type : introspection::all_types()) {
    const std::string ours = layout_of_type(type.name);
    EXPECT_FALSE(ours.empty()) << type.name;
    EXPECT_EQ(layout_of_definition(introspection::ros_msg_definition(type)), ours) << type.name;
  }
}

TEST(Layout, IsPrimitivesArraysAndSequencesInOrder) {
  EXPECT_EQ(layout_of_type("builtin_interfaces/msg/Time"), "int32 uint32");
  EXPECT_EQ(layout_of_type("goshawk_msgs/msg/BezierPiece"),
            "float64 uint32 [6 float64 float64 float64]");
  EXPECT_THAT(layout_of_type("nav_msgs/msg/Path"), HasSubstr("[* int32 uint32 string "));
  EXPECT_EQ(layout_of_type("goshawk_msgs/msg/ThrustAttitude"), "");
}

TEST(Layout, DoesNotDependOnNamesCommentsOrConstants) {
  EXPECT_EQ(layout_of_definition("uint8 STATE_A=0\nuint8 STATE_B=1\nuint8 state  # A = 0\n"),
            layout_of_definition("# a message\nuint8 mode\n"));
  EXPECT_NE(layout_of_definition("uint8 a"), layout_of_definition("int8 a"));
  EXPECT_NE(layout_of_definition("uint8[] a"), layout_of_definition("uint8[3] a"));
}

TEST(Layout, IsEmptyForADefinitionThatIsNotWhole) {
  EXPECT_EQ(layout_of_definition("std_msgs/Header header"), "");
  const std::string itself = "a/B b\n" + std::string(80, '=') + "\nMSG: a/B\na/B b\n";
  EXPECT_EQ(layout_of_definition(itself), "");
}

/// A recording of version 1: reports as they were, odometry as it still is, and a command of a type
/// that is gone.
class OldRecording : public testing::Test {
 protected:
  OldRecording() {
    auto writer = Writer::create(*create_file(file_.path(), true), {}).value();
    const auto add = [&](const char* topic, const char* type, const std::string& definition) {
      const auto schema = writer.add_schema(type, definition.empty() ? "" : "ros2msg", definition);
      return writer.add_channel({.schema_id = schema, .topic = topic, .message_encoding = "cdr"});
    };
    add("/stage_report", "goshawk_msgs/msg/StageReport", kOldStageReport);
    add("/command", "goshawk_msgs/msg/ThrustAttitude", "float64 thrust\n");
    add("/weather", "weather_msgs/msg/Rain", "float64 rate\n");
    add("/unknown", "goshawk_msgs/msg/Path", "");
    const auto odom = add("/odom", "nav_msgs/msg/Odometry",
                          *introspection::ros_msg_definition("nav_msgs/msg/Odometry"));
    nav_msgs::msg::Odometry m;
    m.child_frame_id("base_link");
    const auto bytes = runtime::encode(m);
    EXPECT_TRUE(writer.write({odom, 0, 1, 1, bytes}));
    EXPECT_TRUE(writer.close());
  }

  Reader open() const { return Reader::open(file_.path()).value(); }

  std::set<std::uint16_t> all(const Reader& reader) const {
    std::set<std::uint16_t> ids;
    for (const auto& [id, channel] : reader.channels()) ids.insert(id);
    return ids;
  }

  TemporaryFile file_;
};

TEST_F(OldRecording, IsRefusedWithTheTopicsThatChanged) {
  const Reader reader = open();
  const Status same = check_layout(reader, all(reader));
  ASSERT_EQ(same.code(), ErrorCode::invalid_input);
  EXPECT_THAT(same.error().message,
              AllOf(HasSubstr("another version of Goshawk"),
                    HasSubstr("/stage_report (goshawk_msgs/msg/StageReport)"),
                    HasSubstr("/command (goshawk_msgs/msg/ThrustAttitude)"),
                    HasSubstr("record the flight again"), Not(HasSubstr("/odom")),
                    Not(HasSubstr("/weather")), Not(HasSubstr("/unknown"))));
}

TEST_F(OldRecording, GivesTheMessagesThatDidNotChange) {
  Reader reader = open();
  const auto odometry = messages_of<nav_msgs::msg::Odometry>(reader, "odom");
  ASSERT_TRUE(odometry) << odometry.error().message;
  EXPECT_EQ(odometry->at(0).child_frame_id(), "base_link");
  EXPECT_THAT(messages_of<goshawk_msgs::msg::StageReport>(reader, "stage_report").error().message,
              HasSubstr("another version"));
}

TEST_F(OldRecording, IsPlayedOnlyWithoutTheTopicsThatChanged) {
  const Reader reader = open();
  ReplayOptions options;
  options.file = file_.path();
  const auto say = [](const std::string&) {};
  const auto refused = choose_channels(reader, options, say);
  ASSERT_FALSE(refused);
  EXPECT_THAT(refused.error().message,
              AllOf(HasSubstr(file_.path()), HasSubstr("another version of Goshawk")));
  options.topics = {"/odom"};
  const auto chosen = choose_channels(reader, options, say);
  ASSERT_TRUE(chosen) << chosen.error().message;
  EXPECT_EQ(chosen->size(), 1U);
}

}  // namespace
}  // namespace goshawk::recording
