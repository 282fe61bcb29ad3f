#include "foxglove_times.hpp"

#include <gmock/gmock.h>

namespace goshawk::viewer_bridge {
namespace {

using Json = nlohmann::ordered_json;

Json renamed(const char* text) {
  Json value = Json::parse(text);
  rename_nanoseconds(value);
  return value;
}

TEST(FoxgloveTimes, BecomeThoseOfRos2WhereverTheyAre) {
  EXPECT_EQ(renamed(R"({"sec": 5, "nsec": 7})"), Json::parse(R"({"sec": 5, "nanosec": 7})"));
  EXPECT_EQ(renamed(R"({"header": {"stamp": {"nsec": 7, "sec": 5}, "frame_id": "map"}})"),
            Json::parse(R"({"header": {"stamp": {"sec": 5, "nanosec": 7}, "frame_id": "map"}})"));
  EXPECT_EQ(renamed(R"({"poses": [{"stamp": {"sec": 1, "nsec": 2}}, {"stamp": 3}]})"),
            Json::parse(R"({"poses": [{"stamp": {"sec": 1, "nanosec": 2}}, {"stamp": 3}]})"));
}

TEST(FoxgloveTimes, AllElseStaysAsItIs) {
  for (const char* text :
       {R"({"sec": 5, "nanosec": 7})", R"({"sec": 5, "nsec": 7, "more": 1})", R"({"nsec": 7})",
        R"([1, "sec", "nsec", null])", R"("nsec")", "{}", "null"}) {
    EXPECT_EQ(renamed(text), Json::parse(text)) << text;
  }
}

TEST(FoxgloveTimes, WhatIsNestedWithoutEndIsLeftAlone) {
  Json value = Json::parse(R"({"sec": 5, "nsec": 7})");
  for (int k = 0; k < 100; ++k) value = Json::array({std::move(value)});
  const Json before = value;
  rename_nanoseconds(value);
  EXPECT_EQ(value, before);
}

}  // namespace
}  // namespace goshawk::viewer_bridge
