#include "messages.hpp"

#include <gtest/gtest.h>

#include "goshawk/conversions/geometry.hpp"

namespace goshawk::obstacle_tracker {
namespace {

MovingBox walker() {
  return {.id = 7,
          .kind = "person",
          .position_map = Vec3(1, 2, 3),
          .half_m = Vec3(0.3, 0.2, 0.9),
          .velocity_map = Vec3(1, -2, 0),
          .position_error_m = 0.1,
          .velocity_error_m_s = 0.2};
}

Config agile() {
  Config config;
  config.agility_m_s = 0.5;
  config.horizon_s = 2.0;
  config.top_speed_m_s = 1.0;
  return config;
}

TEST(ObstacleMessages, ABoxIsCarriedOnAtItsVelocityUpToTheHorizon) {
  goshawk_msgs::msg::PredictedObstacles m;
  fill_msg(bounded({walker()}, agile()), m);
  ASSERT_EQ(m.obstacles().size(), 1u);
  const auto& o = m.obstacles()[0];
  EXPECT_EQ(o.id(), 7u);
  EXPECT_EQ(o.kind(), "person");
  EXPECT_EQ(conversions::from_msg(o.half_extents()), walker().half_m);
  ASSERT_EQ(o.track().size(), 1u);
  EXPECT_EQ(o.track()[0].duration(), 2.0);
  ASSERT_EQ(o.track()[0].control_points().size(), 2u);
  EXPECT_EQ(conversions::from_msg(o.track()[0].control_points()[0]), Vec3(1, 2, 3));
  EXPECT_EQ(conversions::from_msg(o.track()[0].control_points()[1]), Vec3(3, -2, 3));
  EXPECT_EQ(o.valid_until(), 2.0);
  EXPECT_DOUBLE_EQ(o.error(), 0.2);
  EXPECT_DOUBLE_EQ(o.error_rate(), 0.9);
  EXPECT_DOUBLE_EQ(o.top_speed(), walker().velocity_map.norm());
}

TEST(ObstacleMessages, WhatStandsStaysAndWhatTurnsIsInTheBallAroundIt) {
  MovingBox stands = walker(), turns = walker();
  stands.velocity_map.setZero();
  stands.velocity_error_m_s = 0.0;
  turns.angular_velocity_map = Vec3(0, 0, 1);
  const auto found = bounded({stands, turns}, agile());
  EXPECT_EQ(found[0].top_speed_m_s, 0.0);
  EXPECT_EQ(found[0].bound_rate_m_s, 0.0);
  EXPECT_GE(found[1].box.half_m.minCoeff(), walker().half_m.norm());
}

TEST(ObstacleMessages, AShorterListLeavesNothingOfALongerOne) {
  goshawk_msgs::msg::PredictedObstacles m;
  fill_msg(bounded({walker(), walker()}, agile()), m);
  fill_msg(bounded({}, agile()), m);
  EXPECT_TRUE(m.obstacles().empty());
}

}  // namespace
}  // namespace goshawk::obstacle_tracker
