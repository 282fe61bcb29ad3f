#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "goshawk/conversions/grid.hpp"
#include "goshawk/conversions/vehicle.hpp"

namespace goshawk::conversions {
namespace {

TEST(Stamp, SurvivesTheRoundTripAlsoBeforeTheEpoch) {
  for (const std::int64_t t : {0LL, 1LL, 999'999'999LL, 1'000'000'000LL, -1LL, -1'500'000'000LL}) {
    EXPECT_EQ(to_ns(to_stamp(t)), t);
  }
}

TEST(VoxelGridMessage, SurvivesTheRoundTrip) {
  VoxelGrid in;
  in.geometry = {Vec3(-1, 2, 0.5), 0.25, {70, 3, 2}};
  in.grown = BitGrid({70, 3, 2}, true);
  in.grown.set({69, 2, 1}, true);
  in.known = BitGrid({70, 3, 2}, false, true);
  in.known.set({0, 0, 0}, false);
  in.raw = BitGrid({70, 3, 2}, true);
  in.raw.set({3, 2, 1}, true);
  in.unknown_is_occupied = false;
  in.unknown_grows = true;
  in.version = 9;
  in.inflation_m = 0.2;
  goshawk_msgs::msg::VoxelGrid m;
  m.header(make_header(0));
  fill_msg(in, m);
  const auto out = from_msg(m);
  ASSERT_TRUE(out.ok()) << out.error().message;
  EXPECT_EQ(out->grown, in.grown);
  EXPECT_EQ(out->known, in.known);
  EXPECT_EQ(out->raw, in.raw);
  EXPECT_FALSE(out->unknown_is_occupied);
  EXPECT_TRUE(out->unknown_grows);
  EXPECT_EQ(out->version, 9u);
  in.raw = {};
  fill_msg(in, m);
  EXPECT_TRUE(from_msg(m)->raw.empty());
  EXPECT_EQ(out->geometry.origin_map, in.geometry.origin_map);
}

TEST(VoxelGridMessage, WithTheWrongNumberOfWordsIsRefused) {
  VoxelGrid in;
  in.geometry = {Vec3::Zero(), 0.25, {70, 3, 2}};
  in.grown = BitGrid({70, 3, 2}, true);
  goshawk_msgs::msg::VoxelGrid m;
  m.header(make_header(0));
  fill_msg(in, m);
  for (auto* words : {&m.grown(), &m.known(), &m.raw()}) {
    fill_msg(in, m);
    words->resize(11);
    EXPECT_EQ(from_msg(m).code(), ErrorCode::invalid_input);
  }
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
  grid.grown = BitGrid(grid.geometry.size, true);
  grid.known = BitGrid(grid.geometry.size, false);
  grid.version = 3;
  GridUpdate in{3, 4, {0, -1, 2}, {Brick{}}};
  in.bricks[0].index = {1, 1, 0};
  in.bricks[0].grown[0] = 0b101;
  in.bricks[0].known[0] = 0b111;
  in.bricks[0].raw.emplace().fill(5);
  goshawk_msgs::msg::VoxelGridUpdate m;
  m.header(make_header(0));
  fill_msg(in, m);
  const auto out = from_msg(m);
  ASSERT_TRUE(out.ok()) << out.error().message;
  EXPECT_EQ(out->bricks, in.bricks);
  EXPECT_EQ(out->shift, in.shift);
  GridUpdate in_place = *out;  // a window that moved away would leave nothing of the grid
  in_place.shift = {};
  ASSERT_TRUE(apply(grid, in_place).ok());
  EXPECT_EQ(grid.version, 4u);
  EXPECT_TRUE(grid.grown.get({66, 8, 0}));
  EXPECT_FALSE(grid.grown.get({65, 8, 0}));
  EXPECT_EQ(grid.grown.count(), 2);
  EXPECT_EQ(grid.known.count(), 3);
}

TEST(VoxelGridUpdateMessage, WithShortBricksOrFarIndicesIsRefused) {
  GridUpdate in{1, 2, {}, {Brick{}}};
  goshawk_msgs::msg::VoxelGridUpdate m;
  m.header(make_header(0));
  fill_msg(in, m);
  m.bricks()[0].known().pop_back();
  EXPECT_EQ(from_msg(m).code(), ErrorCode::invalid_input);
  fill_msg(in, m);
  m.bricks()[0].raw().resize(63);
  EXPECT_EQ(from_msg(m).code(), ErrorCode::invalid_input);
  fill_msg(in, m);
  ASSERT_TRUE(from_msg(m).ok()) << "no raw words at all";
  m.bricks()[0].brick_z(4'000'000'000U);
  VoxelGrid grid;
  grid.geometry = {Vec3::Zero(), 0.25, {70, 9, 2}};
  grid.grown = BitGrid(grid.geometry.size, true);
  grid.known = BitGrid(grid.geometry.size, false);
  grid.version = 1;
  const auto far = from_msg(m);
  ASSERT_TRUE(far.ok());
  EXPECT_EQ(apply(grid, *far).code(), ErrorCode::invalid_input);
}

TEST(OdometryMessage, TurnsTheTwistIntoTheMapAndBack) {
  RigidBodyState in;
  in.position_map = Vec3(1, 2, 3);
  in.velocity_map = Vec3(0.5, -1, 0.2);
  in.q_map_base = Eigen::AngleAxisd(1.2, Vec3::UnitZ()) * Eigen::AngleAxisd(0.3, Vec3::UnitX());
  in.angular_velocity_base = Vec3(0.1, 0.2, 0.3);
  nav_msgs::msg::Odometry m;
  fill_msg(in, m);
  const auto out = from_msg(m);
  ASSERT_TRUE(out.ok()) << out.error().message;
  EXPECT_LT((out->velocity_map - in.velocity_map).norm(), 1e-12);
  EXPECT_LT(out->q_map_base.angularDistance(in.q_map_base), 1e-7);
}

TEST(OdometryMessage, WithAWrongFrameOrQuaternionIsRefused) {
  nav_msgs::msg::Odometry m;
  fill_msg(RigidBodyState{}, m);
  m.child_frame_id("base_link_frd");
  EXPECT_EQ(from_msg(m).code(), ErrorCode::wrong_frame);
  fill_msg(RigidBodyState{}, m);
  m.pose().pose().orientation().w(0.0);
  EXPECT_EQ(from_msg(m).code(), ErrorCode::invalid_input);
  m.pose().pose().orientation().w(std::nan(""));
  EXPECT_EQ(from_msg(m).code(), ErrorCode::invalid_input);
  fill_msg(RigidBodyState{}, m);
  m.twist().twist().linear().x(std::nan(""));
  EXPECT_EQ(from_msg(m).code(), ErrorCode::invalid_input);
}

geometry_msgs::msg::Quaternion quaternion(double x, double y, double z, double w) {
  geometry_msgs::msg::Quaternion m;
  m.x(x);
  m.y(y);
  m.z(z);
  m.w(w);
  return m;
}

TEST(QuaternionMessage, OfAnyLengthIsMadeToHaveLengthOne) {
  for (const double length : {1e-3, 1.0, std::sqrt(2.0), 40.0, 1e200}) {
    const auto q = from_msg(quaternion(0.0, 0.0, length, length));
    ASSERT_TRUE(q) << q.error().message;
    EXPECT_NEAR(q->norm(), 1.0, 1e-12);
    EXPECT_NEAR(yaw_of(*q), std::numbers::pi / 2.0, 1e-12) << length;
  }
}

TEST(QuaternionMessage, WithoutADirectionIsRefused) {
  const double inf = std::numeric_limits<double>::infinity();
  for (const double bad : {0.0, 1e-9, -1e-300, std::nan(""), inf, -inf}) {
    const auto q = from_msg(quaternion(0.0, bad, 0.0, 0.0));
    EXPECT_EQ(q.code(), ErrorCode::invalid_input) << bad;
  }
}

TEST(GoalMessage, GivesPlaceAndHeadingOrSaysWhatIsWrong) {
  geometry_msgs::msg::PoseStamped m;
  m.header(make_header(0));
  m.pose().position(to_point(Vec3(1, 2, 3)));
  m.pose().orientation(quaternion(0.0, 0.0, 1.0, 1.0));
  const auto goal = from_msg(m);
  ASSERT_TRUE(goal) << goal.error().message;
  EXPECT_EQ(goal->position_map, Vec3(1, 2, 3));
  EXPECT_NEAR(goal->yaw_rad, std::numbers::pi / 2.0, 1e-12);
  m.pose().orientation(quaternion(0.0, 0.0, 0.0, 0.0));
  EXPECT_EQ(from_msg(m).code(), ErrorCode::invalid_input);
  EXPECT_NE(from_msg(m).error().message.find("orientation"), std::string::npos);
  m.pose().orientation(quaternion(0.0, 0.0, 0.0, 1.0));
  m.pose().position().y(std::nan(""));
  EXPECT_EQ(from_msg(m).code(), ErrorCode::invalid_input);
  m.pose().position().y(0.0);
  m.header().frame_id("odom");
  EXPECT_EQ(from_msg(m).code(), ErrorCode::wrong_frame);
}

TEST(CommandMessage, WithNegativeOrMissingThrustIsRefused) {
  goshawk_msgs::msg::AttitudeSetpoint m;
  m.header(make_header(0));
  fill_msg(AttitudeSetpoint{9.81, Quaternion::Identity(), Vec3::Zero()}, m);
  ASSERT_TRUE(from_msg(m).ok());
  m.thrust(-1.0);
  EXPECT_EQ(from_msg(m).code(), ErrorCode::invalid_input);
  m.thrust(std::nan(""));
  EXPECT_EQ(from_msg(m).code(), ErrorCode::invalid_input);
}

TEST(FallbackStopMessage, KeepsEveryStateAndIsCheckedWhenItComes) {
  FallbackStop stop{.step_s = 0.05, .states = {{.position = {1, 2, 3}}, {.position = {1, 2, 4}}}};
  stop.states[0].velocity = {0.1, 0.2, 0.3};
  stop.states[0].acceleration = {4, 5, 6};
  goshawk_msgs::msg::FallbackStop m;
  m.header(make_header(0));
  m.states().resize(7);  // of an earlier one
  fill_msg(stop, m);
  const auto back = from_msg(m);
  ASSERT_TRUE(back.ok()) << back.error().message;
  EXPECT_EQ(back->step_s, 0.05);
  ASSERT_EQ(back->states.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(largest_difference(back->states[i], stop.states[i]), 0.0);
  }
  m.states().back().velocity().x(1.0);
  EXPECT_EQ(from_msg(m).code(), ErrorCode::invalid_input);
  m.header(make_header(0, "odom"));
  EXPECT_EQ(from_msg(m).code(), ErrorCode::wrong_frame);
}

}  // namespace
}  // namespace goshawk::conversions
