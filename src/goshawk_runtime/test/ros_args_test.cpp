#include "goshawk/runtime/ros_args.hpp"

#include <gmock/gmock.h>

namespace goshawk::runtime {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using Words = std::vector<std::string>;

TEST(RosArgs, TakesOnlyItsOwnPart) {
  Words words{"a", "--ros-args", "-r", "x:=y", "--", "b", "--ros-args", "-p", "k:=v"};
  const auto args = RosArgs::extract(words);
  ASSERT_TRUE(args);
  EXPECT_THAT(words, ElementsAre("a", "b"));
  EXPECT_EQ(args->remaps.size(), 1u);
  EXPECT_EQ(args->overrides.size(), 1u);
  Words none{"a"};
  EXPECT_TRUE(RosArgs::extract(none));
  EXPECT_THAT(none, ElementsAre("a"));
}

RosArgs parse(Words words) {
  words.insert(words.begin(), "--ros-args");
  auto args = RosArgs::extract(words);
  if (!args) throw std::runtime_error(args.error().message);
  return *args;
}

TEST(RosArgs, PutsTopicsUnderTheNamespace) {
  EXPECT_EQ(RosArgs{}.resolve_topic("path"), "/path");
  const auto args = parse({"-r", "__ns:=/uav1"});
  EXPECT_EQ(args.resolve_topic("map/voxels"), "/uav1/map/voxels");
  EXPECT_EQ(args.resolve_topic("/tf"), "/tf");
  EXPECT_EQ(parse({"-r", "__ns:=uav1"}).resolve_topic("path"), "/uav1/path");
}

TEST(RosArgs, RemapsTopics) {
  const auto args = parse(
      {"-r", "__ns:=/uav1", "-r", "path:=other", "-r", "/tf:=/tf2", "-r", "/uav1/map:=/world"});
  EXPECT_EQ(args.resolve_topic("path"), "/uav1/other");
  EXPECT_EQ(args.resolve_topic("/uav1/path"), "/uav1/other");
  EXPECT_EQ(args.resolve_topic("/path"), "/path");
  EXPECT_EQ(args.resolve_topic("/tf"), "/tf2");
  EXPECT_EQ(args.resolve_topic("map"), "/world");
}

TEST(RosArgs, RemapsTopicsOfOneNodeOfSeveral) {
  const auto args = parse({"-r", "a:path:=other", "-r", "path:=common"});
  EXPECT_EQ(args.resolve_topic("path", "a"), "/other");
  EXPECT_EQ(args.resolve_topic("path", "b"), "/common");
  EXPECT_EQ(args.resolve_topic("map", "a"), "/map");
}

TEST(RosArgs, NamesTheNode) {
  EXPECT_EQ(parse({"-r", "__node:=me"}).node_name, "me");
  EXPECT_EQ(parse({"--log-level", "debug"}).log_level, "debug");
}

std::string fault_of(Words words) {
  words.insert(words.begin(), "--ros-args");
  const auto args = RosArgs::extract(words);
  EXPECT_EQ(args.code(), ErrorCode::invalid_input);
  return args ? "no fault" : args.error().message;
}

TEST(RosArgs, NamesTheArgumentThatIsWrong) {
  EXPECT_THAT(fault_of({"-x", "1"}), HasSubstr("has no option '-x'"));
  EXPECT_THAT(fault_of({"-r"}), HasSubstr("'-r' needs a value"));
  EXPECT_THAT(fault_of({"-r", "a=b"}), HasSubstr("'a=b' is not of the form name:=value"));
  EXPECT_THAT(fault_of({"-p", ":=1"}), HasSubstr("name:=value"));
  EXPECT_THAT(fault_of({"-r", "a:=b c"}), HasSubstr("'b c' is not a valid name"));
  EXPECT_THAT(fault_of({"-r", "__ns:=/a//b"}), HasSubstr("is not a valid name"));
  EXPECT_THAT(fault_of({"-r", "__node:=a/b"}), HasSubstr("__ns"));
  EXPECT_THAT(fault_of({"--log-level", "loud"}), HasSubstr("'loud'"));
}

TEST(TopicNames, FollowTheRulesOfRos) {
  for (const char* good : {"path", "/path", "map/voxels", "/a_1/b", "/"}) {
    EXPECT_TRUE(check_topic_name(good)) << good;
  }
  for (const char* bad : {"", "a b", "a-b", "a//b", "a/", "\xc3\xa4", "a:b", "~/a"}) {
    EXPECT_FALSE(check_topic_name(bad)) << bad;
  }
}

}  // namespace
}  // namespace goshawk::runtime
