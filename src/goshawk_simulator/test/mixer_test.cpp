#include "goshawk/simulator/mixer.hpp"

#include <gtest/gtest.h>

#include "goshawk/core/random.hpp"

namespace goshawk::simulator {

using plant::VehicleParameters;

namespace {

using Vec4 = Vec4;

Wrench random_wrench(Random& random, double thrust, double tilt, double yaw) {
  return {random.uniform(0.0, thrust),
          {random.uniform(-tilt, tilt), random.uniform(-tilt, tilt), random.uniform(-yaw, yaw)}};
}

TEST(Mixer, ThrustOnTheLeftRollsToTheRightAndThrustInFrontPitchesTheNoseUp) {
  const Mixer mixer{VehicleParameters{}};
  EXPECT_GT(mixer.wrench(Vec4(1, 1, 0, 0)).torque_base_nm.x(), 0.0);
  EXPECT_LT(mixer.wrench(Vec4(1, 0, 0, 1)).torque_base_nm.y(), 0.0);
  EXPECT_NEAR(mixer.wrench(Vec4(1, 1, 0, 0)).torque_base_nm.x(), 2 * 0.17 / std::sqrt(2.0), 1e-12);
}

TEST(Mixer, GivesExactlyTheWantedWrenchWithinTheMotorsPower) {
  const Mixer mixer{VehicleParameters{}};
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    Vec4 thrust;
    for (int k = 0; k < 4; ++k) thrust[k] = random.uniform(0.8, 6.2);
    const Wrench wanted = mixer.wrench(thrust);
    EXPECT_LT((mixer.allocate(wanted) - thrust).norm(), 1e-9);
  }
}

TEST(Mixer, NeverAsksForMoreThanAMotorHasAndKeepsRollAndPitchWhenSaturated) {
  const VehicleParameters parameters;
  const Mixer mixer(parameters);
  const double lever = parameters.arm_length_m / std::sqrt(2.0);
  Random random(2);
  for (int i = 0; i < 2000; ++i) {
    const Wrench wanted = random_wrench(random, 60.0, 3.0, 2.0);
    const Vec4 thrust = mixer.allocate(wanted);
    EXPECT_GE(thrust.minCoeff(), 0.0);
    EXPECT_LE(thrust.maxCoeff(), parameters.max_motor_thrust_n);
    const Vec3 given = mixer.wrench(thrust).torque_base_nm;
    const double spread =
        (std::abs(wanted.torque_base_nm.x()) + std::abs(wanted.torque_base_nm.y())) / (2.0 * lever);
    const double share = std::min(1.0, parameters.max_motor_thrust_n / spread);
    EXPECT_NEAR(given.x(), share * wanted.torque_base_nm.x(), 1e-9);
    EXPECT_NEAR(given.y(), share * wanted.torque_base_nm.y(), 1e-9);
    // Yaw never turns the wrong way, and never beyond what was asked.
    EXPECT_GE(given.z() * wanted.torque_base_nm.z(), -1e-12);
    EXPECT_LE(std::abs(given.z()), std::abs(wanted.torque_base_nm.z()) + 1e-12);
  }
}

TEST(Mixer, AtFullThrustSomeYawIsLeftForATenthOfAMotor) {
  const VehicleParameters parameters;
  const Mixer mixer(parameters);
  const auto given = mixer.wrench(mixer.allocate({parameters.max_thrust_n(), {0, 0, 1.0}}));
  EXPECT_NEAR(given.thrust_n, 0.9 * parameters.max_thrust_n(), 1e-9);
  EXPECT_NEAR(given.torque_base_nm.z(), 0.1 * parameters.max_thrust_n() * 0.016, 1e-9);
}

TEST(Mixer, WithoutThrustTheAttitudeIsStillHeld) {
  const Mixer mixer{VehicleParameters{}};
  const auto given = mixer.wrench(mixer.allocate({0.0, {0.2, 0, 0}}));
  EXPECT_NEAR(given.torque_base_nm.x(), 0.2, 1e-12);
}

}  // namespace
}  // namespace goshawk::simulator
