#include "goshawk/tracker/position_controller.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "goshawk/core/flatness.hpp"
#include "goshawk/core/random.hpp"

namespace goshawk::tracker {
namespace {

Config without_observer(const std::string& controller = "pd") {
  Config config;
  config.controller = controller;
  config.disturbance_bandwidth_rad_s = 0.0;
  return config;
}

double tilt_rad(const AttitudeSetpoint& command) {
  return std::acos(std::min(1.0, (command.q_map_base * Vec3::UnitZ()).z()));
}

TEST(PositionController, AtTheTargetItAsksForTheWeightAndNothingElse) {
  for (const char* name : {"pd", "geometric"}) {
    PositionController controller(without_observer(name));
    RigidBodyState state;
    state.position_map = {1, 2, 3};
    const FlatState there{.position = state.position_map};
    const auto out = controller.step(state, {.now = there, .ahead = there}, 0.004);
    EXPECT_NEAR(out.thrust_n, kGravity_m_s2, 1e-12);
    EXPECT_LT(tilt_rad(out), 1e-7);
    EXPECT_LT(out.angular_velocity_base.norm(), 1e-12);
  }
}

TEST(PositionController, OnATrajectoryItAsksForTheForceThatFliesItAgainstTheKnownDrag) {
  const Config config = without_observer();
  PositionController controller(config);
  const FlatState flat{{0, 0, 0}, {2, 1, -1}, {1, -1, 0.5}, {2, 0, 1}};
  RigidBodyState state;
  state.velocity_map = flat.velocity;
  const auto out = controller.step(state, {.now = flat, .ahead = flat}, 0.004);
  const Vec3 drag = Vec3(0.25, 0.25, 0.15).cwiseProduct(flat.velocity);
  const Vec3 force = flat.acceleration + Vec3(0, 0, kGravity_m_s2) + drag;
  EXPECT_LT((out.thrust_n * (out.q_map_base * Vec3::UnitZ()) - force).norm(), 1e-9);
  const Vec3 rate = flat.jerk + Vec3(0.25, 0.25, 0.15).cwiseProduct(flat.acceleration);
  EXPECT_LT(
      (out.angular_velocity_base - thrust_attitude_of(force, rate, 0, 0, 1.0).angular_velocity_base)
          .norm(),
      1e-12);
}

TEST(PositionController, ErrorsActWithTheirGains) {
  const Config config = without_observer();
  PositionController controller(config);
  RigidBodyState state;
  state.position_map = {0.08, 0, 0.05};
  state.velocity_map = {0, 0.2, 0};
  const auto out = controller.step(state, {}, 0.004);
  const Vec3 force = out.thrust_n / config.mass_kg * (out.q_map_base * Vec3::UnitZ());
  EXPECT_NEAR(force.x(), -config.position_xy_1_s2 * 0.08, 1e-9);
  EXPECT_NEAR(force.y(), -config.velocity_xy_1_s * 0.2, 1e-9);
  EXPECT_NEAR(force.z() - kGravity_m_s2, -config.position_z_1_s2 * 0.05, 1e-9);
}

TEST(PositionController, APositionErrorActsUpToItsBound) {
  Config config = without_observer();
  config.max_position_error_m = 0.3;
  for (const double error_m : {0.3, 1.0, 1e6}) {
    PositionController controller(config);
    RigidBodyState state;
    state.position_map = {error_m, 0, 0};
    const auto out = controller.step(state, {}, 0.004);
    const Vec3 force = out.thrust_n / config.mass_kg * (out.q_map_base * Vec3::UnitZ());
    EXPECT_NEAR(force.x(), -config.position_xy_1_s2 * 0.3, 1e-9) << error_m;
  }
}

TEST(PositionController, WhateverTheErrorThrustAndTiltStayWithinBoundsAndFinite) {
  Random random(9);
  for (const char* name : {"pd", "geometric"}) {
    Config config;
    config.controller = name;
    PositionController controller(config);
    for (int i = 0; i < 5000; ++i) {
      const double size = std::pow(10.0, random.uniform(-3.0, 6.0));
      const auto vector = [&] {
        return Vec3(random.uniform(-size, size), random.uniform(-size, size),
                    random.uniform(-size, size));
      };
      RigidBodyState state;
      state.position_map = vector();
      state.velocity_map = vector();
      state.q_map_base = Eigen::Quaterniond(random.uniform(-1, 1), random.uniform(-1, 1),
                                            random.uniform(-1, 1), random.uniform(-1, 1));
      state.q_map_base.normalize();
      FlatState flat{vector(), vector(), vector(), vector()};
      const auto out = controller.step(state, {flat, flat, random.uniform(-3, 3), 0.5},
                                       random.uniform(0.0, 0.03));
      ASSERT_TRUE(std::isfinite(out.thrust_n) && out.q_map_base.coeffs().allFinite() &&
                  out.angular_velocity_base.allFinite());
      EXPECT_GE(out.thrust_n, config.min_thrust_n - 1e-9);
      EXPECT_LE(out.thrust_n, config.max_thrust_n + 1e-9);
      EXPECT_LE(tilt_rad(out), config.max_tilt_rad + 1e-9);
      EXPECT_LE(out.angular_velocity_base.norm(), config.max_body_rate_rad_s + 1e-9);
    }
  }
}

TEST(PositionController, TheGeometricOneThrustsOnlyAsFarAsTheBodyPointsThere) {
  PositionController controller(without_observer("geometric"));
  RigidBodyState state;
  state.q_map_base = Eigen::AngleAxisd(0.5, Vec3::UnitX());
  const auto out = controller.step(state, {}, 0.004);
  EXPECT_NEAR(out.thrust_n, kGravity_m_s2 * std::cos(0.5), 1e-9);
}

}  // namespace
}  // namespace goshawk::tracker
