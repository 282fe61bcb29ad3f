#include "goshawk/conversions/moving_boxes.hpp"

#include <gmock/gmock.h>

#include <cmath>

#include "goshawk/conversions/geometry.hpp"

namespace goshawk::conversions {
namespace {

using testing::HasSubstr;

MovingBox person() {
  return {.id = 7,
          .kind = "person",
          .position_map = Vec3(1, 2, 3),
          .q_map_box = Quaternion(std::sqrt(0.5), 0, 0, std::sqrt(0.5)),
          .half_m = Vec3(0.3, 0.2, 0.9),
          .velocity_map = Vec3(1, 0, 0),
          .angular_velocity_map = Vec3(0, 0, 0.5),
          .position_error_m = 0.1,
          .velocity_error_m_s = 0.2};
}

goshawk_msgs::msg::MovingBoxes message_of(const std::vector<MovingBox>& boxes) {
  goshawk_msgs::msg::MovingBoxes m;
  m.header(make_header(1));
  fill_msg(boxes, m);
  return m;
}

template <typename Change>
std::string said_of(Change change) {
  MovingBox box = person();
  change(box);
  const auto boxes = from_msg(message_of({box}));
  return boxes ? "accepted" : boxes.error().message;
}

TEST(MovingBoxes, ComeBackAsTheyWere) {
  const auto boxes = from_msg(message_of({person()}));
  ASSERT_TRUE(boxes);
  const MovingBox &a = boxes->front(), b = person();
  EXPECT_EQ(a.id, b.id);
  EXPECT_EQ(a.kind, b.kind);
  EXPECT_EQ(a.position_map, b.position_map);
  EXPECT_TRUE(a.q_map_box.isApprox(b.q_map_box));
  EXPECT_EQ(a.half_m, b.half_m);
  EXPECT_EQ(a.velocity_map, b.velocity_map);
  EXPECT_EQ(a.angular_velocity_map, b.angular_velocity_map);
  EXPECT_EQ(a.position_error_m, b.position_error_m);
  EXPECT_EQ(a.velocity_error_m_s, b.velocity_error_m_s);
}

TEST(MovingBoxes, BadOnesAreRefusedWithASentence) {
  const double nan = std::nan("");
  EXPECT_THAT(said_of([&](MovingBox& b) { b.position_map.y() = nan; }),
              HasSubstr("box 7: its place"));
  EXPECT_THAT(said_of([&](MovingBox& b) { b.position_map.y() = 1e9; }), HasSubstr("its place"));
  EXPECT_THAT(said_of([&](MovingBox& b) { b.velocity_map.y() = nan; }), HasSubstr("its velocity"));
  EXPECT_THAT(said_of([&](MovingBox& b) { b.half_m.z() = 0.0; }), HasSubstr("half extents"));
  EXPECT_THAT(said_of([&](MovingBox& b) { b.q_map_box = Quaternion(0, 0, 0, 0); }),
              HasSubstr("no rotation"));
  EXPECT_THAT(said_of([&](MovingBox& b) { b.position_error_m = -1.0; }), HasSubstr("its errors"));
}

TEST(MovingBoxes, NoTwoHaveOneIdAndNoListIsEndless) {
  EXPECT_THAT(from_msg(message_of({person(), person()})).error().message,
              HasSubstr("box 7 is listed twice"));
  const std::vector<MovingBox> many(kMostMovingBoxes + 1, person());
  EXPECT_THAT(from_msg(message_of(many)).error().message, HasSubstr("more than 10000"));
  auto elsewhere = message_of({});
  elsewhere.header().frame_id("odom");
  EXPECT_EQ(from_msg(elsewhere).code(), ErrorCode::wrong_frame);
}

}  // namespace
}  // namespace goshawk::conversions
