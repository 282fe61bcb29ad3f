#include "goshawk/mission/mission_file.hpp"

#include <gmock/gmock.h>

#include <numbers>

namespace goshawk::mission {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

constexpr const char* kYaml =
    "name: survey\n"
    "waypoints:\n"
    "  - position: [3, 8.5, +2]\n"
    "    yaw_deg: 90\n"
    "    hold_s: 1.5\n"
    "  - {position: [1, 1, 1], v_max_m_s: 0.8, pass_within_m: 0.5}\n"
    "  - position: [-1, 0, 1e0]\n";

constexpr const char* kCsv =
    "# a comment\n"
    "x_m, y_m, z_m, hold_s, yaw_deg, v_max_m_s, pass_within_m\r\n"
    "3, 8.5, +2, 1.5, 90,,\r\n"
    "\n"
    "1, 1, 1, , , 0.8, 0.5  # on the way\n"
    "-1, 0, 1e0,,,,\n";

void expect_survey(const MissionFile& file) {
  ASSERT_EQ(file.mission.waypoints.size(), 3U);
  const auto& [a, b, c] =
      std::tie(file.mission.waypoints[0], file.mission.waypoints[1], file.mission.waypoints[2]);
  EXPECT_EQ(a.position_map, Vec3(3, 8.5, 2));
  EXPECT_DOUBLE_EQ(a.yaw_rad.value_or(0.0), std::numbers::pi / 2.0);
  EXPECT_EQ(a.hold_s, 1.5);
  EXPECT_FALSE(a.passes());
  EXPECT_EQ(b.position_map, Vec3(1, 1, 1));
  EXPECT_FALSE(b.yaw_rad);
  EXPECT_EQ(b.v_max_m_s, 0.8);
  EXPECT_EQ(b.pass_radius_m, 0.5);
  EXPECT_EQ(c.position_map, Vec3(-1, 0, 1));
  EXPECT_EQ(c.v_max_m_s, 0.0);
}

TEST(MissionFiles, InYamlSayWaypointsByKeys) {
  const auto file = parse_mission("a.yaml", kYaml);
  ASSERT_TRUE(file) << file.error().message;
  EXPECT_EQ(file->mission.name, "survey");
  EXPECT_THAT(file->lines, ElementsAre(3, 6, 7));
  expect_survey(*file);
}

TEST(MissionFiles, AsTablesSayWaypointsByColumns) {
  const auto file = parse_mission("a.csv", kCsv);
  ASSERT_TRUE(file) << file.error().message;
  EXPECT_EQ(file->mission.name, "a.csv");
  EXPECT_THAT(file->lines, ElementsAre(3, 5, 6));
  expect_survey(*file);
}

struct Bad {
  const char* path;
  const char* text;
  const char* sentence;
};

TEST(MissionFiles, ThatAreWrongAreRefusedWithLineAndReason) {
  const std::vector<Bad> all{
      {"a.yaml", "waypoints:\n- position: [1, 2]\n",
       "a.yaml, line 2: position is not three numbers"},
      {"a.yaml", "waypoints:\n- position: [1, 2, x]\n", "line 2: position: 'x' is not a number"},
      {"a.yaml", "waypoints:\n- position: [1, 2, .inf]\n", "line 2: position: '.inf' is not"},
      {"a.yaml", "waypoints:\n- position: [1, 2, [3]]\n", "line 2: position is not a number"},
      {"a.yaml", "waypoints:\n- hold_s: 1\n", "line 2: the waypoint has no position"},
      {"a.yaml", "waypoints:\n- position: [1, 2, 3]\n  hold: 1\n",
       "line 3: a waypoint has no key 'hold': it has position, yaw_deg, hold_s"},
      {"a.yaml", "waypoints:\n- {position: [1, 2, 3], hold_s: 1, hold_s: 2}\n",
       "line 2: hold_s is specified twice"},
      {"a.yaml", "waypoints:\n- [1, 2, 3]\n", "line 2: a waypoint is not a map"},
      {"a.yaml", "waypoints: 3\n", "line 1: waypoints is not a list"},
      {"a.yaml", "name: [a]\nwaypoints: []\n", "line 1: name is not a text"},
      {"a.yaml", "name: a\npoints: []\n", "line 2: a mission has no key 'points'"},
      {"a.yaml", "- 1\n", "line 1: it is not a map of keys"},
      {"a.yaml", "", "line 1: it is not a map of keys"},
      {"a.yaml", "waypoints: []\n", "a.yaml: the mission has no waypoints"},
      {"a.yaml", "waypoints:\n- position: [1, 2\n", "it is not valid YAML"},
      {"a.yaml", "waypoints:\n- {position: [1, 2, 3]}\n- {position: [1, 2, 3], hold_s: -1}\n",
       "line 3: waypoint 2: its hold of -1 s"},
      {"a.yaml", "waypoints:\n- {position: [1, 2, 3], pass_within_m: 1}\n",
       "line 2: waypoint 1, the last one, is passed"},
      {"a.csv", "x_m,y_m\n1,2\n", "a.csv, line 1: column z_m is missing"},
      {"a.csv", "x_m,y_m,z_m,hold\n", "line 1: there is no column 'hold'"},
      {"a.csv", "x_m,y_m,z_m,x_m\n", "line 1: column x_m is specified twice"},
      {"a.csv", "x_m,y_m,z_m\n1,2,3\n1,2\n", "line 3: it has 2 values, but there are 3 columns"},
      {"a.csv", "x_m,y_m,z_m\n1,,3\n", "line 2: y_m is empty"},
      {"a.csv", "x_m,y_m,z_m\n1,2 m,3\n", "line 2: y_m: '2 m' is not a number"},
      {"a.csv", "x_m,y_m,z_m\n", "a.csv: the mission has no waypoints"},
      {"a.txt", "", "a.txt: a mission is a .yaml, .yml or .csv file"},
  };
  for (const auto& [path, text, sentence] : all) {
    const auto file = parse_mission(path, text);
    ASSERT_FALSE(file) << text;
    EXPECT_EQ(file.code(), ErrorCode::invalid_input);
    EXPECT_THAT(file.error().message, HasSubstr(sentence)) << text;
  }
}

TEST(MissionFiles, ThatCannotBeReadSayWhy) {
  const auto file = read_mission("/nowhere/a.yaml");
  EXPECT_EQ(file.code(), ErrorCode::io_failed);
  EXPECT_THAT(file.error().message, HasSubstr("/nowhere/a.yaml cannot be read: No such file"));
  EXPECT_EQ(read_mission(testing::TempDir()).code(), ErrorCode::io_failed);
}

}  // namespace
}  // namespace goshawk::mission
