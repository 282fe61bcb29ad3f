#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "goshawk/conversions/grid.hpp"
#include "goshawk/conversions/plan.hpp"
#include "goshawk/conversions/vehicle.hpp"
#include "goshawk/core/random.hpp"

namespace goshawk::conversions {
namespace {

using testing::HasSubstr;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

Vec3 random_vector(Random& random) {
  return {random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-9, 9)};
}

goshawk_msgs::msg::PlanRequest valid_request() {
  PlanRequest request;
  request.id = 7;
  request.stamp_ns = 5'000'000'000;
  request.start.position = Vec3(1, 2, 3);
  request.goal.position = Vec3(4, 5, 6);
  return to_msg(request);
}

TEST(Stamp, SurvivesTheRoundTripAlsoBeforeTheEpoch) {
  for (const std::int64_t t : {0LL, 1LL, 999'999'999LL, 1'000'000'000LL, -1LL, -1'500'000'000LL}) {
    EXPECT_EQ(to_ns(to_stamp(t)), t);
  }
}

TEST(PlanRequestMessage, SurvivesTheRoundTrip) {
  Random random(3);
  PlanRequest in;
  in.id = 42;
  in.stamp_ns = 123'456'789'012;
  in.start = {random_vector(random), random_vector(random), random_vector(random), Vec3::Zero()};
  in.goal.position = random_vector(random);
  in.other_goals_map = {random_vector(random), random_vector(random)};
  in.goal_yaw_rad = 1.5;
  in.deadline_s = 0.25;
  in.duration_s = 12.5;
  in.limits = {.v_max_m_s = 3.0,
               .a_max_m_s2 = 4.0,
               .norm = LimitNorm::per_axis,
               .j_max_m_s3 = 5.0,
               .v_max_vertical_m_s = 6.0,
               .a_max_vertical_m_s2 = 7.0};
  const auto out = from_msg(to_msg(in));
  ASSERT_TRUE(out.ok()) << out.error().message;
  EXPECT_EQ(out->id, in.id);
  EXPECT_EQ(out->stamp_ns, in.stamp_ns);
  EXPECT_EQ(out->start.position, in.start.position);
  EXPECT_EQ(out->start.velocity, in.start.velocity);
  EXPECT_EQ(out->start.acceleration, in.start.acceleration);
  EXPECT_EQ(out->goal.position, in.goal.position);
  EXPECT_EQ(out->other_goals_map, in.other_goals_map);
  EXPECT_EQ(out->goal_yaw_rad, in.goal_yaw_rad);
  EXPECT_EQ(out->deadline_s, in.deadline_s);
  EXPECT_EQ(out->duration_s, in.duration_s);
  EXPECT_EQ(out->limits.norm, LimitNorm::per_axis);
  EXPECT_EQ(out->limits.j_max_m_s3, in.limits.j_max_m_s3);
  EXPECT_EQ(out->limits.v_max_vertical_m_s, in.limits.v_max_vertical_m_s);
  EXPECT_EQ(out->limits.a_max_vertical_m_s2, in.limits.a_max_vertical_m_s2);
}

TEST(PlanRequestMessage, IsRefusedInAnotherFrame) {
  auto m = valid_request();
  m.header().frame_id("odom_ned");
  const auto result = from_msg(m);
  EXPECT_EQ(result.code(), ErrorCode::wrong_frame);
  EXPECT_THAT(result.error().message, HasSubstr("odom_ned"));
}

TEST(PlanRequestMessage, IsRefusedWithAnyNumberNotFinite) {
  auto m = valid_request();
  m.start().position().y(kNaN);
  EXPECT_EQ(from_msg(m).code(), ErrorCode::invalid_input);
  m = valid_request();
  m.goal().acceleration().z(HUGE_VAL);
  EXPECT_EQ(from_msg(m).code(), ErrorCode::invalid_input);
  m = valid_request();
  m.deadline(-1.0);
  EXPECT_EQ(from_msg(m).code(), ErrorCode::invalid_input);
  m = valid_request();
  m.other_goals().resize(2);
  m.other_goals()[1].x(kNaN);
  EXPECT_EQ(from_msg(m).code(), ErrorCode::invalid_input);
}

TEST(PlanRequestMessage, IsRefusedWithLimitsNotAboveZero) {
  for (const double bad : {0.0, -1.0, kNaN, HUGE_VAL}) {
    auto m = valid_request();
    m.limits().a_max(bad);
    const auto result = from_msg(m);
    EXPECT_EQ(result.code(), ErrorCode::invalid_limits);
    EXPECT_THAT(result.error().message, HasSubstr("a_max"));
  }
  auto m = valid_request();
  m.limits().norm(9);
  EXPECT_EQ(from_msg(m).code(), ErrorCode::invalid_limits);
}

TEST(PlanRequestMessage, DeadlineIsCountedFromTheStamp) {
  PlanRequest request;
  request.stamp_ns = 1'000'000'000;
  EXPECT_TRUE(check_deadline(request, 1LL << 60).ok()) << "no deadline";
  request.deadline_s = 0.5;
  EXPECT_TRUE(check_deadline(request, 1'400'000'000).ok());
  EXPECT_EQ(check_deadline(request, 1'600'000'000).code(), ErrorCode::deadline_exceeded);
}

TEST(VoxelGridMessage, SurvivesTheRoundTrip) {
  VoxelGrid in;
  in.geometry = {Vec3(-1, 2, 0.5), 0.25, {70, 3, 2}};
  in.occupied = BitGrid({70, 3, 2}, true);
  in.occupied.set({69, 2, 1}, true);
  in.known = BitGrid({70, 3, 2}, false, true);
  in.known.set({0, 0, 0}, false);
  in.version = 9;
  in.inflation_m = 0.2;
  goshawk_msgs::msg::VoxelGrid m;
  m.header(make_header(0));
  fill_msg(in, m);
  const auto out = from_msg(m);
  ASSERT_TRUE(out.ok()) << out.error().message;
  EXPECT_EQ(out->occupied, in.occupied);
  EXPECT_EQ(out->known, in.known);
  EXPECT_EQ(out->version, 9u);
  EXPECT_EQ(out->geometry.origin_map, in.geometry.origin_map);
}

TEST(VoxelGridMessage, WithTheWrongNumberOfWordsIsRefused) {
  VoxelGrid in;
  in.geometry = {Vec3::Zero(), 0.25, {70, 3, 2}};
  in.occupied = BitGrid({70, 3, 2}, true);
  goshawk_msgs::msg::VoxelGrid m;
  m.header(make_header(0));
  fill_msg(in, m);
  m.occupied().pop_back();
  EXPECT_EQ(from_msg(m).code(), ErrorCode::invalid_input);
  m.size_x(0);
  EXPECT_EQ(from_msg(m).code(), ErrorCode::map_empty);
  m.size_x(4'000'000'000U);
  EXPECT_EQ(from_msg(m).code(), ErrorCode::map_too_large);
  m.size_x(2'000'000'000U);
  m.size_y(2'000'000'000U);
  m.size_z(2'000'000'000U);
  EXPECT_EQ(from_msg(m).code(), ErrorCode::map_too_large);
}

TEST(VoxelGridUpdateMessage, SurvivesTheRoundTripAndBringsTheGridUpToDate) {
  VoxelGrid grid;
  grid.geometry = {Vec3::Zero(), 0.25, {70, 9, 2}};
  grid.occupied = BitGrid(grid.geometry.size, true);
  grid.known = BitGrid(grid.geometry.size, false);
  grid.version = 3;
  GridUpdate in{3, 4, {Brick{}}};
  in.bricks[0].index = {1, 1, 0};
  in.bricks[0].occupied[0] = 0b101;
  in.bricks[0].known[0] = 0b111;
  goshawk_msgs::msg::VoxelGridUpdate m;
  m.header(make_header(0));
  fill_msg(in, m);
  const auto out = from_msg(m);
  ASSERT_TRUE(out.ok()) << out.error().message;
  EXPECT_EQ(out->bricks, in.bricks);
  ASSERT_TRUE(apply(grid, *out).ok());
  EXPECT_EQ(grid.version, 4u);
  EXPECT_TRUE(grid.occupied.get({66, 8, 0}));
  EXPECT_FALSE(grid.occupied.get({65, 8, 0}));
  EXPECT_EQ(grid.occupied.count(), 2);
  EXPECT_EQ(grid.known.count(), 3);
}

TEST(VoxelGridUpdateMessage, WithShortBricksOrFarIndicesIsRefused) {
  GridUpdate in{1, 2, {Brick{}}};
  goshawk_msgs::msg::VoxelGridUpdate m;
  m.header(make_header(0));
  fill_msg(in, m);
  m.bricks()[0].known().pop_back();
  EXPECT_EQ(from_msg(m).code(), ErrorCode::invalid_input);
  fill_msg(in, m);
  m.bricks()[0].brick_z(4'000'000'000U);
  VoxelGrid grid;
  grid.geometry = {Vec3::Zero(), 0.25, {70, 9, 2}};
  grid.occupied = BitGrid(grid.geometry.size, true);
  grid.known = BitGrid(grid.geometry.size, false);
  grid.version = 1;
  const auto far = from_msg(m);
  ASSERT_TRUE(far.ok());
  EXPECT_EQ(apply(grid, *far).code(), ErrorCode::invalid_input);
}

TEST(PolytopeMessage, WithSizesThatDisagreeOrNormalsOfAnotherLengthIsRefused) {
  const auto box = Polytope::box(Vec3::Zero(), Vec3::Ones());
  auto m = to_msg(box);
  ASSERT_TRUE(from_msg(m).ok());
  m.normals().pop_back();
  EXPECT_EQ(from_msg(m).code(), ErrorCode::invalid_input);
  m = to_msg(box);
  m.normals()[0] = 2.0;
  EXPECT_EQ(from_msg(m).code(), ErrorCode::invalid_input);
  m = to_msg(box);
  m.offsets()[0] = kNaN;
  EXPECT_EQ(from_msg(m).code(), ErrorCode::invalid_input);
}

goshawk_msgs::msg::BezierTrajectory valid_trajectory() {
  PlanRequest request;
  request.id = 1;
  request.goal.position = Vec3(1, 0, 0);
  Trajectory trajectory;
  trajectory.pieces.push_back(BezierPiece::between(request.start, request.goal, 10.0));
  goshawk_msgs::msg::BezierTrajectory m;
  m.header(make_header(0));
  m.request(to_msg(request));
  m.pieces(to_msg(trajectory));
  m.polytopes(to_msg(std::vector{Polytope::box(Vec3(-1, -1, -1), Vec3(2, 1, 1))}));
  return m;
}

TEST(TrajectoryMessage, IsTakenWithACertificateOfOurOwn) {
  const auto received = from_msg(valid_trajectory());
  ASSERT_TRUE(received.ok()) << received.error().message;
  EXPECT_TRUE(received->certificate.holds());
  EXPECT_LT(received->certificate.position_m, 0.0);
}

TEST(TrajectoryMessage, IsRefusedWhereTheCertificateFailsWhateverItClaims) {
  auto m = valid_trajectory();
  m.pieces()[0].control_points()[3].y(5.0);  // out of the polytope
  m.certificate().position(-1.0);
  EXPECT_EQ(from_msg(m).code(), ErrorCode::not_certified);
  m = valid_trajectory();
  m.pieces()[0].duration(0.1);  // far too fast
  EXPECT_EQ(from_msg(m).code(), ErrorCode::not_certified);
  m = valid_trajectory();
  m.request().goal().position().x(1.5);  // ends elsewhere
  EXPECT_EQ(from_msg(m).code(), ErrorCode::not_certified);
}

TEST(TrajectoryMessage, ThatNamesAMissingPolytopeIsRefused) {
  auto m = valid_trajectory();
  m.pieces()[0].polytope(1);
  EXPECT_EQ(from_msg(m).code(), ErrorCode::invalid_input);
}

TEST(OdometryMessage, TurnsTheTwistIntoTheMapAndBack) {
  RigidBodyState in;
  in.position_map = Vec3(1, 2, 3);
  in.velocity_map = Vec3(0.5, -1, 0.2);
  in.q_map_base = yaw_rotation(1.2) * Eigen::AngleAxisd(0.3, Vec3::UnitX());
  in.angular_velocity_base = Vec3(0.1, 0.2, 0.3);
  nav_msgs::msg::Odometry m;
  fill_msg(in, m);
  const auto out = from_msg(m);
  ASSERT_TRUE(out.ok()) << out.error().message;
  EXPECT_LT((out->velocity_map - in.velocity_map).norm(), 1e-12);
  EXPECT_LT(out->q_map_base.angularDistance(in.q_map_base), 1e-7);
  EXPECT_NEAR(yaw_of(yaw_rotation(1.2)), 1.2, 1e-12);
}

TEST(OdometryMessage, WithAWrongFrameOrQuaternionIsRefused) {
  nav_msgs::msg::Odometry m;
  fill_msg(RigidBodyState{}, m);
  m.child_frame_id("base_link_frd");
  EXPECT_EQ(from_msg(m).code(), ErrorCode::wrong_frame);
  fill_msg(RigidBodyState{}, m);
  m.pose().pose().orientation().w(0.0);
  EXPECT_EQ(from_msg(m).code(), ErrorCode::invalid_input);
  fill_msg(RigidBodyState{}, m);
  m.twist().twist().linear().x(kNaN);
  EXPECT_EQ(from_msg(m).code(), ErrorCode::invalid_input);
}

TEST(CommandMessage, WithNegativeOrMissingThrustIsRefused) {
  goshawk_msgs::msg::AttitudeSetpoint m;
  m.header(make_header(0));
  fill_msg(AttitudeSetpoint{9.81, Eigen::Quaterniond::Identity(), Vec3::Zero()}, m);
  ASSERT_TRUE(from_msg(m).ok());
  m.thrust(-1.0);
  EXPECT_EQ(from_msg(m).code(), ErrorCode::invalid_input);
  m.thrust(kNaN);
  EXPECT_EQ(from_msg(m).code(), ErrorCode::invalid_input);
}

}  // namespace
}  // namespace goshawk::conversions
