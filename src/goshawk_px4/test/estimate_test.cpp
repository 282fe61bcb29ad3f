#include "goshawk/px4/estimate.hpp"

#include <gtest/gtest.h>

namespace goshawk::px4 {
namespace {

VehicleLocalPosition good_local(std::uint64_t sample_us = 1000) {
  VehicleLocalPosition m;
  m.timestamp_sample = sample_us;
  m.xy_valid = m.z_valid = m.v_xy_valid = m.v_z_valid = m.heading_good_for_control = true;
  m.x = 1.0f;
  m.y = 2.0f;
  m.z = -3.0f;
  m.heading = 0.0f;
  return m;
}

VehicleOdometry good_odometry(std::uint64_t sample_us = 1000) {
  VehicleOdometry m;
  m.timestamp_sample = sample_us;
  m.position = {1.0f, 2.0f, -3.0f};
  m.q = {1.0f, 0.0f, 0.0f, 0.0f};
  m.velocity = {0.5f, 0.0f, -0.1f};
  m.angular_velocity = {0.1f, 0.2f, 0.3f};
  m.position_variance = {1e-4f, 1e-4f, 1e-4f};
  return m;
}

class Estimates : public testing::Test {
 protected:
  std::string refusal(const VehicleOdometry& odometry) {
    const auto state = estimate.hear(odometry);
    return state ? "" : state.error().message;
  }
  Config config;
  Estimate estimate{config};
};

TEST_F(Estimates, OdometryIsBroughtToTheMap) {
  ASSERT_TRUE(estimate.hear(good_local()));
  const auto state = estimate.hear(good_odometry());
  ASSERT_TRUE(state) << state.error().message;
  EXPECT_LT((state->position_map - Vec3(2, 1, 3)).norm(), 1e-6);
  EXPECT_LT((state->velocity_map - Vec3(0, 0.5, 0.1)).norm(), 1e-6);
  EXPECT_LT((state->angular_velocity_base - Vec3(0.1, -0.2, -0.3)).norm(), 1e-6);
  EXPECT_NEAR(yaw_of(state->q_map_base), 1.570796, 1e-5);  // north
}

TEST_F(Estimates, AVelocityInTheBodyIsTurned) {
  ASSERT_TRUE(estimate.hear(good_local()));
  auto odometry = good_odometry();
  odometry.q = {0.70710678f, 0.0f, 0.0f, 0.70710678f};  // nose to the east
  odometry.velocity_frame = 3;
  odometry.velocity = {1.0f, 0.0f, 0.0f};
  EXPECT_LT((estimate.hear(odometry)->velocity_map - Vec3(1, 0, 0)).norm(), 1e-6);
}

TEST_F(Estimates, WhatPx4DoesNotTrustIsNotUsed) {
  EXPECT_NE(refusal(good_odometry()).find("vehicle_local_position"), std::string::npos);
  auto local = good_local();
  local.xy_valid = false;
  ASSERT_TRUE(estimate.hear(local));
  EXPECT_NE(refusal(good_odometry()).find("local position is not valid"), std::string::npos);
  local.xy_valid = true;
  local.v_z_valid = false;
  ASSERT_TRUE(estimate.hear(local));
  EXPECT_NE(refusal(good_odometry()).find("velocity is not valid"), std::string::npos);
  local.v_z_valid = true;
  local.heading_good_for_control = false;
  ASSERT_TRUE(estimate.hear(local));
  EXPECT_NE(refusal(good_odometry()).find("heading"), std::string::npos);
}

TEST_F(Estimates, WhatIsUncertainOrNoNumberIsNotUsed) {
  ASSERT_TRUE(estimate.hear(good_local()));
  auto odometry = good_odometry();
  odometry.position_variance[1] = 0.16f;  // 0.4 m, as with a common GNSS receiver
  EXPECT_NE(refusal(odometry).find("max_position_deviation_m"), std::string::npos);
  odometry.position_variance[1] = kNan;
  EXPECT_NE(refusal(odometry).find("how certain"), std::string::npos);
  odometry = good_odometry();
  odometry.position[0] = kNan;
  EXPECT_EQ(estimate.hear(odometry).code(), ErrorCode::invalid_input);
  odometry = good_odometry();
  odometry.q = {0.0f, 0.0f, 0.0f, 0.0f};
  EXPECT_EQ(estimate.hear(odometry).code(), ErrorCode::invalid_input);
  odometry = good_odometry();
  odometry.pose_frame = 2;
  EXPECT_NE(refusal(odometry).find("pose_frame"), std::string::npos);
}

TEST_F(Estimates, AResetMovesTheFrameAndTheVehicleStays) {
  ASSERT_TRUE(estimate.hear(good_local()));
  const Vec3 before = estimate.hear(good_odometry())->position_map;
  auto odometry = good_odometry(2000);
  odometry.reset_counter = 1;
  odometry.position = {3.0f, 1.0f, -3.5f};
  // Odometry may come before the size of the reset is told.
  EXPECT_NE(refusal(odometry).find("by how much"), std::string::npos);
  auto local = good_local(2000);
  local.x = 3.0f;
  local.y = 1.0f;
  local.z = -3.5f;
  local.delta_xy = {2.0f, -1.0f};
  local.delta_z = -0.5f;
  local.xy_reset_counter = local.z_reset_counter = 1;
  const auto reset = estimate.hear(local);
  ASSERT_TRUE(reset && *reset);
  EXPECT_NEAR((*reset)->position_m, Vec3(2, -1, -0.5).norm(), 1e-6);
  EXPECT_LT((estimate.hear(odometry)->position_map - before).norm(), 1e-6);
  EXPECT_EQ(estimate.resets(), 1u);
}

TEST_F(Estimates, CountersWrapAround) {
  auto local = good_local();
  local.xy_reset_counter = 255;
  ASSERT_TRUE(estimate.hear(local));
  local.xy_reset_counter = 0;
  local.delta_xy = {0.1f, 0.0f};
  const auto reset = estimate.hear(local);
  ASSERT_TRUE(reset && *reset);
  EXPECT_NEAR((*reset)->position_m, 0.1, 1e-6);
}

TEST_F(Estimates, ResetsThatWereMissedAreAFault) {
  ASSERT_TRUE(estimate.hear(good_local()));
  auto local = good_local(2000);
  local.heading_reset_counter = 2;
  EXPECT_EQ(estimate.hear(local).code(), ErrorCode::tracking_lost);
}

}  // namespace
}  // namespace goshawk::px4
