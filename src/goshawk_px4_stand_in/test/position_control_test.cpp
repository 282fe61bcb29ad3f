#include "goshawk/px4_stand_in/position_control.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace goshawk::px4_stand_in {
namespace {

constexpr double kHover = 0.5, kStep_s = 0.004;

px4::TrajectorySetpoint at_origin() {
  px4::TrajectorySetpoint m;
  m.position = m.velocity = m.acceleration = {0.0f, 0.0f, 0.0f};
  m.yaw = 0.0f;
  return m;
}

TEST(PositionControl, AtItsSetpointItHovers) {
  PositionControl control;
  const auto thrust = control.step({}, at_origin(), kHover, kStep_s);
  EXPECT_NEAR(thrust.acceleration_m_s2, kGravity_m_s2, 1e-9);
  EXPECT_LT((thrust.attitude - Eigen::Matrix3d::Identity()).norm(), 1e-9);
}

TEST(PositionControl, AnErrorToTheNorthTiltsTheNoseDown) {
  PositionControl control;
  auto setpoint = at_origin();
  setpoint.position[0] = 1.0f;
  const auto thrust = control.step({}, setpoint, kHover, kStep_s);
  EXPECT_LT(thrust.attitude(2, 0) * -1.0, 0.0) << "x of the body points below the horizon";
  // 1.8 * 0.95 m/s^2 and one step of the integral.
  EXPECT_NEAR(-thrust.attitude(0, 2) * thrust.acceleration_m_s2, 1.8 * 0.95 + 0.4 * 0.95 * kStep_s,
              1e-6);
}

TEST(PositionControl, VelocityIsClippedSilently) {
  PositionControl control;
  auto setpoint = at_origin();
  setpoint.position[2] = -100.0f;  // 100 m higher: 3 m/s up at the most
  const auto thrust = control.step({}, setpoint, kHover, kStep_s);
  EXPECT_NEAR(thrust.acceleration_m_s2,
              std::min(kGravity_m_s2 / kHover, kGravity_m_s2 + 4.0 * 3.0 + 2.0 * 3.0 * kStep_s),
              1e-6);
}

TEST(PositionControl, TiltStaysBelowItsLimit) {
  PositionControl control;
  auto setpoint = at_origin();
  setpoint.acceleration[1] = 50.0f;
  const auto thrust = control.step({}, setpoint, kHover, kStep_s);
  EXPECT_GE(thrust.attitude(2, 2), std::cos(0.785) - 1e-6);
}

TEST(PositionControl, WhatIsNoNumberIsNotControlled) {
  PositionControl control;
  px4::TrajectorySetpoint setpoint;
  setpoint.velocity = {0.0f, 0.0f, 0.0f};
  LocalState far;
  far.position = {9, 9, -9};
  const auto thrust = control.step(far, setpoint, kHover, kStep_s);
  EXPECT_NEAR(thrust.acceleration_m_s2, kGravity_m_s2, 1e-9);
}

}  // namespace
}  // namespace goshawk::px4_stand_in
