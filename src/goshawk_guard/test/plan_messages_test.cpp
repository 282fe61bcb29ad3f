#include "../component/plan_messages.hpp"

#include <gmock/gmock.h>

#include "goshawk/conversions/geometry.hpp"

namespace goshawk::guard {
namespace {

using testing::HasSubstr;
constexpr std::int64_t kSecond = 1'000'000'000;

nav_msgs::msg::Path path_of(const std::vector<std::int64_t>& stamps_ns) {
  nav_msgs::msg::Path m;
  m.header(conversions::make_header(5 * kSecond));
  for (std::size_t i = 0; i < stamps_ns.size(); ++i) {
    geometry_msgs::msg::PoseStamped pose;
    pose.header(conversions::make_header(stamps_ns[i]));
    pose.pose().position(conversions::to_point(Vec3(double(i), 2, 3)));
    m.poses().push_back(pose);
  }
  return m;
}

trajectory_msgs::msg::MultiDOFJointTrajectory trajectory_of(std::size_t points) {
  trajectory_msgs::msg::MultiDOFJointTrajectory m;
  m.header(conversions::make_header(5 * kSecond));
  for (std::size_t i = 0; i < points; ++i) {
    trajectory_msgs::msg::MultiDOFJointTrajectoryPoint point;
    point.transforms().resize(1);
    point.transforms()[0].translation(conversions::to_vector(Vec3(double(i), 0, 1)));
    point.time_from_start().sec(std::int32_t(i) + 1);
    point.time_from_start().nanosec(500'000'000);
    m.points().push_back(point);
  }
  return m;
}

TEST(PathMessage, WithStampsIsTimed) {
  const auto plan = plan_of(path_of({7 * kSecond, 8 * kSecond, 10 * kSecond})).value();
  EXPECT_EQ(plan.kind, PlanKind::path);
  EXPECT_EQ(plan.start_time_ns, 7 * kSecond);
  const auto& samples = std::get<Samples>(plan.shape).samples;
  ASSERT_EQ(samples.size(), 3u);
  EXPECT_DOUBLE_EQ(samples[2].t_s, 3.0);
  EXPECT_EQ(samples[2].position, Vec3(2, 2, 3));
  EXPECT_FALSE(samples[2].velocity);
}

TEST(PathMessage, WithEqualStampsIsAPolyline) {
  for (const std::int64_t stamp : {std::int64_t{0}, 9 * kSecond}) {
    const auto plan = plan_of(path_of({stamp, stamp, stamp})).value();
    EXPECT_FALSE(plan.start_time_ns);
    EXPECT_EQ(std::get<Waypoints>(plan.shape).points_map.size(), 3u);
  }
  EXPECT_TRUE(std::get<Waypoints>(plan_of(path_of({})).value().shape).points_map.empty());
}

TEST(PathMessage, OfAnotherFrameIsRefused) {
  auto m = path_of({0, 0});
  m.header().frame_id("odom");
  EXPECT_EQ(plan_of(m).code(), ErrorCode::wrong_frame);
  m = path_of({0, 0});
  m.poses()[1].header().frame_id("base_link");
  EXPECT_EQ(plan_of(m).code(), ErrorCode::wrong_frame);
  m.poses()[1].header().frame_id("");
  EXPECT_TRUE(plan_of(m)) << "the path's own";
}

TEST(TrajectoryMessage, BeginsAtItsFirstPoint) {
  auto m = trajectory_of(3);
  m.points()[1].velocities().resize(1);
  m.points()[1].velocities()[0].linear(conversions::to_vector(Vec3(1, 0, 0)));
  const auto plan = plan_of(m).value();
  EXPECT_EQ(plan.start_time_ns, 5 * kSecond + 3 * kSecond / 2);
  const auto& samples = std::get<Samples>(plan.shape).samples;
  ASSERT_EQ(samples.size(), 3u);
  EXPECT_DOUBLE_EQ(samples[0].t_s, 0.0);
  EXPECT_DOUBLE_EQ(samples[2].t_s, 2.0);
  EXPECT_EQ(*samples[1].velocity, Vec3(1, 0, 0));
  EXPECT_FALSE(samples[1].acceleration);
}

TEST(TrajectoryMessage, WithoutAStampBeginsAsSoonAsItMay) {
  auto m = trajectory_of(2);
  m.header().stamp(conversions::to_stamp(0));
  EXPECT_FALSE(plan_of(m).value().start_time_ns);
}

TEST(TrajectoryMessage, OfSeveralBodiesOrNoneIsRefused) {
  auto m = trajectory_of(3);
  m.points()[1].transforms().resize(2);
  ASSERT_FALSE(plan_of(m));
  EXPECT_THAT(plan_of(m).error().message, HasSubstr("point 1 has 2 transforms"));
  m = trajectory_of(3);
  m.points()[2].transforms().clear();
  EXPECT_EQ(plan_of(m).code(), ErrorCode::invalid_input);
  m = trajectory_of(3);
  m.points()[2].accelerations().resize(2);
  EXPECT_EQ(plan_of(m).code(), ErrorCode::invalid_input);
  m = trajectory_of(3);
  m.header().frame_id("world");
  EXPECT_EQ(plan_of(m).code(), ErrorCode::wrong_frame);
}

TEST(PolynomialMessage, KeepsItsNumbers) {
  goshawk_msgs::msg::PolynomialPlan m;
  m.header(conversions::make_header(0));
  m.start_time(conversions::to_stamp(3 * kSecond));
  m.pieces().resize(1);
  m.pieces()[0].duration(2.0);
  m.pieces()[0].x({1, 2, 3});
  m.pieces()[0].y({4});
  m.pieces()[0].z({5, 6});
  const auto plan = plan_of(m).value();
  EXPECT_EQ(plan.start_time_ns, 3 * kSecond);
  const auto& piece = std::get<Polynomials>(plan.shape).pieces.at(0);
  EXPECT_EQ(piece.duration_s, 2.0);
  EXPECT_THAT(piece.coefficients[0], testing::ElementsAre(1, 2, 3));
  EXPECT_THAT(piece.coefficients[2], testing::ElementsAre(5, 6));
  m.header().frame_id("");
  EXPECT_EQ(plan_of(m).code(), ErrorCode::wrong_frame);
}

TEST(BsplineMessage, KeepsItsNumbers) {
  goshawk_msgs::msg::BsplinePlan m;
  m.header(conversions::make_header(0));
  m.degree(3);
  m.knots({0, 1, 2});
  m.control_points({conversions::to_point(Vec3(1, 2, 3))});
  const auto plan = plan_of(m).value();
  EXPECT_FALSE(plan.start_time_ns);
  const auto& spline = std::get<Bspline>(plan.shape);
  EXPECT_EQ(spline.degree, 3);
  EXPECT_THAT(spline.knots_s, testing::ElementsAre(0, 1, 2));
  EXPECT_EQ(spline.control_points_map.at(0), Vec3(1, 2, 3));
  m.degree(4'000'000'000u);
  EXPECT_GT(std::get<Bspline>(plan_of(m).value().shape).degree, 5);
  m.header().frame_id("odom");
  EXPECT_EQ(plan_of(m).code(), ErrorCode::wrong_frame);
}

}  // namespace
}  // namespace goshawk::guard
