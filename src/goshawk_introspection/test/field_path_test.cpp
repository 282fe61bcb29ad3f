#include "goshawk/introspection/field_path.hpp"

#include <gmock/gmock.h>

namespace goshawk::introspection {
namespace {

using Json = nlohmann::ordered_json;
using ::testing::HasSubstr;

const Type& type_named(const char* name) {
  return *find_type(name).value();
}

Result<FieldPath> path_in(const char* name, const char* text) {
  return FieldPath::parse(type_named(name), text);
}

const Json kPath = Json::parse(R"({
  "header": {"stamp": {"sec": 3, "nanosec": 4}, "frame_id": "map"},
  "waypoints": [{"x": 1.5, "y": 2.0, "z": 3.0}, {"x": 4.0, "y": 5.0, "z": 6.0}]})");

TEST(FieldPath, LeadsThroughStructuresAndLists) {
  const auto at = [](const char* text) {
    const auto found = path_in("goshawk_msgs/msg/Path", text);
    EXPECT_TRUE(found) << found.error().message;
    const Json* part = found->find(kPath);
    return part == nullptr ? Json("too short") : *part;
  };
  EXPECT_EQ(at(""), kPath);
  EXPECT_EQ(at("header.stamp.sec"), 3);
  EXPECT_EQ(at("waypoints"), kPath["waypoints"]);
  EXPECT_EQ(at("waypoints[1].y"), 5.0);
  EXPECT_EQ(at("waypoints[-1].x"), 4.0);
  EXPECT_EQ(at("waypoints[2]"), "too short");
  EXPECT_EQ(at("waypoints[-3].x"), "too short");
}

TEST(FieldPath, KnowsTheTypeOfWhatItLeadsTo) {
  EXPECT_EQ(path_in("goshawk_msgs/msg/Path", "")->type()->name, "goshawk_msgs/msg/Path");
  EXPECT_EQ(path_in("goshawk_msgs/msg/Path", "header")->type()->name, "std_msgs/msg/Header");
  EXPECT_EQ(path_in("goshawk_msgs/msg/Path", "waypoints[0]")->type()->name,
            "geometry_msgs/msg/Point");
  EXPECT_EQ(path_in("goshawk_msgs/msg/Path", "waypoints")->type(), nullptr);
  EXPECT_EQ(path_in("goshawk_msgs/msg/Path", "header.frame_id")->type(), nullptr);
}

TEST(FieldPath, RefusesWhatTheTypeDoesNotHave) {
  const auto why = [](const char* text) {
    const auto refused = path_in("goshawk_msgs/msg/Path", text);
    EXPECT_EQ(refused.code(), ErrorCode::invalid_parameter) << text;
    return refused ? std::string("read") : refused.error().message;
  };
  EXPECT_THAT(why("waypoint"), HasSubstr("did you mean waypoints?"));
  EXPECT_THAT(why("header."), HasSubstr("no field ''"));
  EXPECT_THAT(why("header[0]"), HasSubstr("'header' is not a list"));
  EXPECT_THAT(why("waypoints.x"), HasSubstr("points[0]"));
  EXPECT_THAT(why("header.frame_id.x"), HasSubstr("below a value"));
  for (const char* text :
       {"waypoints[", "waypoints[]", "waypoints[a]", "waypoints[1]x", "waypoints[99999999999]"}) {
    EXPECT_THAT(why(text), HasSubstr("not a field")) << text;
  }
}

TEST(Csv, HasEveryValueInOrder) {
  EXPECT_EQ(to_csv(kPath), "3,4,map,1.5,2.0,3.0,4.0,5.0,6.0");
  EXPECT_EQ(to_csv(Json::parse(R"(["", 1, "a,b", "say \"x\"", true])")),
            ",1,\"a,b\",\"say \"\"x\"\"\",true");
  EXPECT_EQ(to_csv(Json::array()), "");
}

}  // namespace
}  // namespace goshawk::introspection
