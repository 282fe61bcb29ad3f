#include "goshawk/introspection/schema.hpp"

#include <gmock/gmock.h>

#include <set>

namespace goshawk::introspection {
namespace {

using testing::HasSubstr;

TEST(Schema, FindsTypesByLongAndShortName) {
  ASSERT_TRUE(find_type("goshawk_msgs/msg/Path"));
  EXPECT_EQ((*find_type("goshawk_msgs/Path"))->name, "goshawk_msgs/msg/Path");
  EXPECT_EQ((*find_type("nav_msgs/msg/Path"))->name, "nav_msgs/msg/Path");
}

TEST(Schema, NamesTheNearestTypeForAnUnknownOne) {
  const auto type = find_type("goshawk_msgs/msg/Pathh");
  ASSERT_FALSE(type);
  EXPECT_EQ(type.code(), ErrorCode::invalid_input);
  EXPECT_THAT(type.error().message, HasSubstr("did you mean goshawk_msgs/msg/Path?"));
  EXPECT_FALSE(find_type(""));
  EXPECT_FALSE(find_type("/"));
}

TEST(Schema, HoldsInnerTypesBeforeOuterOnes) {
  std::set<std::string_view> names;
  for (std::size_t i = 0; i < all_types().size(); ++i) {
    const auto& type = all_types()[i];
    EXPECT_TRUE(names.insert(type.name).second) << type.name;
    ASSERT_FALSE(type.fields.empty()) << type.name;
    for (const auto& field : type.fields) {
      EXPECT_EQ(field.type >= 0, field.kind == Kind::structure);
      EXPECT_LT(field.type, int(i)) << type.name << "." << field.name;
    }
  }
  EXPECT_GT(names.size(), 30u);
}

TEST(Schema, KeepsFieldsAsTheIdlHasThem) {
  const Type& piece = **find_type("goshawk_msgs/msg/BezierPiece");
  ASSERT_EQ(piece.fields.size(), 3u);
  EXPECT_EQ(piece.fields[0].name, "duration");
  EXPECT_EQ(piece.fields[0].kind, Kind::float64);
  EXPECT_EQ(piece.fields[0].comment, "[s] above 0");
  EXPECT_EQ(piece.fields[1].kind, Kind::uint32);
  EXPECT_EQ(piece.fields[2].arity, Arity::array);
  EXPECT_EQ(piece.fields[2].size, 6u);
  EXPECT_EQ(all_types()[std::size_t(piece.fields[2].type)].name, "geometry_msgs/msg/Point");
  EXPECT_EQ(piece.least_size, 8u + 4u + 6u * 24u);
  EXPECT_THAT(std::string(piece.comment), HasSubstr("quintic Bezier curve"));
}

TEST(Schema, GivesConstantsToTheFieldThatTheyName) {
  const Type& state = **find_type("goshawk_msgs/msg/NavigatorState");
  for (const auto& field : state.fields) {
    EXPECT_EQ(field.constants.empty(), field.name != "state") << field.name;
  }
  const auto constants = state.fields[1].constants;
  ASSERT_EQ(constants.size(), 6u);
  EXPECT_EQ(constants[3].name, "STATE_ARRIVED");
  EXPECT_EQ(constants[3].value, 3u);
  EXPECT_THAT(
      ros_msg_definition(state),
      HasSubstr(
          "uint8 STATE_ARRIVED=3\nuint8 STATE_FAILED=4\nuint8 STATE_HELD=5\nuint8 state  # "));
}

TEST(Schema, CommentsEveryFieldWithUnitOrMeaning) {
  for (const auto& type : all_types()) {
    for (const auto& field : type.fields) {
      EXPECT_FALSE(field.comment.empty()) << type.name << "." << field.name;
    }
  }
}

TEST(Schema, WritesMsgTextThatRecordersStore) {
  const auto text = ros_msg_definition("nav_msgs/msg/Path");
  ASSERT_TRUE(text);
  const std::string bar(80, '=');
  EXPECT_TRUE(text->starts_with(
      "std_msgs/Header header  # frame \"map\"\ngeometry_msgs/PoseStamped[] poses  # [m]\n" + bar +
      "\nMSG: std_msgs/Header\nbuiltin_interfaces/Time stamp  #"))
      << *text;
  for (const char* inner :
       {"std_msgs/Header", "geometry_msgs/PoseStamped", "geometry_msgs/Pose", "geometry_msgs/Point",
        "geometry_msgs/Quaternion", "builtin_interfaces/Time"}) {
    const std::string head = bar + "\nMSG: " + inner + "\n";
    EXPECT_THAT(*text, HasSubstr(head));
    EXPECT_EQ(text->find(head), text->rfind(head)) << inner << " stands there twice";
  }
  EXPECT_THAT(*ros_msg_definition("nav_msgs/msg/Odometry"), HasSubstr("float64[36] covariance"));
  EXPECT_THAT(*ros_msg_definition("sensor_msgs/msg/PointCloud2"), HasSubstr("uint8[] data"));
  EXPECT_FALSE(ros_msg_definition("no/such/Type"));
}

}  // namespace
}  // namespace goshawk::introspection
