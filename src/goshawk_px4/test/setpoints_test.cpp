#include "goshawk/px4/setpoints.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace goshawk::px4 {
namespace {

const MapFrame kSame(Vec3::Zero(), 0.0);

TEST(Setpoints, AStateOfTheMapIsOneOfPx4sFrame) {
  const FlatState state{
      .position = {1, 2, 3}, .velocity = {0.1, 0.2, 0.3}, .acceleration = {-1, 0, 2}};
  const auto m = trajectory_setpoint(state, 0.5, kSame);
  EXPECT_EQ(m.position, (Vec3f{2.0f, 1.0f, -3.0f}));
  EXPECT_EQ(m.velocity, (Vec3f{0.2f, 0.1f, -0.3f}));
  EXPECT_EQ(m.acceleration, (Vec3f{0.0f, -1.0f, -2.0f}));
  EXPECT_NEAR(m.yaw, 1.070796, 1e-6);
  EXPECT_TRUE(std::isnan(m.yawspeed));
}

TEST(Setpoints, WherePx4sOriginLiesIsTakenOff) {
  const MapFrame frame({10, 0, 1}, 0.0);
  const auto m = trajectory_setpoint({.position = {11, 2, 1}}, 0.0, frame);
  EXPECT_EQ(m.position, (Vec3f{2.0f, 1.0f, -0.0f}));
}

TEST(Setpoints, HoverThrustLiftsTheWeight) {
  Config config;
  config.mass_kg = 1.5;
  config.hover_thrust = 0.4;
  EXPECT_NEAR(throttle_of(14.709975, config), 0.4, 1e-6);
  EXPECT_NEAR(throttle_of(20.0, config), 0.543849, 1e-6);
  EXPECT_EQ(throttle_of(0.0, config), 0.0);
  EXPECT_EQ(throttle_of(1000.0, config), 1.0);
  const auto m = attitude_setpoint({20.0, Quaternion::Identity(), Vec3::Zero()}, config, kSame);
  EXPECT_NEAR(m.thrust_body[2], -0.543849, 1e-6);
  EXPECT_EQ(m.thrust_body[0], 0.0f);
  // Level, nose to the east: a quarter turn from north.
  EXPECT_NEAR(m.q_d[0], std::sqrt(0.5), 1e-6);
  EXPECT_NEAR(m.q_d[3], std::sqrt(0.5), 1e-6);
}

TEST(Setpoints, TheThrustCurveIsInverted) {
  Config config;
  config.mass_kg = 1.0;
  config.hover_thrust = 0.4;
  config.thrust_curve = 0.3;
  const auto share = [](double u) { return 0.3 * u * u + 0.7 * u; };
  EXPECT_NEAR(share(0.474810), 0.4, 1e-6);
  for (const double u : {0.1, 0.4, 0.474810, 0.9}) {
    const double thrust_n = kGravity_m_s2 * share(u) / share(0.4);
    EXPECT_NEAR(throttle_of(thrust_n, config), u, 1e-9);
  }
}

}  // namespace
}  // namespace goshawk::px4
