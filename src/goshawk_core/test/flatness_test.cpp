#include "goshawk/core/flatness.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "goshawk/core/random.hpp"

namespace goshawk {
namespace {

Vec3 drawn_vector(Random& random, double size) {
  return {random.uniform(-size, size), random.uniform(-size, size), random.uniform(-size, size)};
}

TEST(Flatness, HoverNeedsTheWeightAsThrustAndNoTilt) {
  const auto out = thrust_attitude_of({0, 0, kGravity_m_s2}, Vec3::Zero(), 0.8, 0.0, 1.3);
  EXPECT_NEAR(out.thrust_n, 1.3 * kGravity_m_s2, 1e-12);
  EXPECT_LT(
      out.q_map_base.angularDistance(Eigen::Quaterniond(Eigen::AngleAxisd(0.8, Vec3::UnitZ()))),
      1e-12);
  EXPECT_EQ(out.angular_velocity_base, Vec3::Zero());
}

TEST(Flatness, ThrustAlongTheAttitudeGivesBackTheForceAndTheHeading) {
  Random random(5);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 force = drawn_vector(random, 6.0) + Vec3(0, 0, kGravity_m_s2);
    const double yaw = random.uniform(-3.1, 3.1);
    const auto out = thrust_attitude_of(force, drawn_vector(random, 5.0), yaw, 0.0, 2.0);
    EXPECT_LT((out.thrust_n / 2.0 * (out.q_map_base * Vec3::UnitZ()) - force).norm(), 1e-9);
    EXPECT_NEAR(wrapped(yaw_of(out.q_map_base) - yaw), 0.0, 1e-9);
    EXPECT_NEAR(out.q_map_base.norm(), 1.0, 1e-14);
  }
}

// The truth for the rates: the attitude a moment later and a moment before.
TEST(Flatness, BodyRatesAreTheDerivativeOfTheAttitude) {
  Random random(6);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 force = drawn_vector(random, 6.0) + Vec3(0, 0, kGravity_m_s2);
    const Vec3 rate = drawn_vector(random, 10.0);
    const double yaw = random.uniform(-3.1, 3.1), yaw_rate = random.uniform(-2.0, 2.0);
    const double h = 1e-5;
    const auto at = [&](double t) {
      return thrust_attitude_of(force + t * rate, rate, yaw + t * yaw_rate, yaw_rate, 1.0);
    };
    const Eigen::AngleAxisd turn(at(-h).q_map_base.conjugate() * at(h).q_map_base);
    const Vec3 omega = turn.angle() / (2.0 * h) * turn.axis();
    EXPECT_LT((at(0.0).angular_velocity_base - omega).norm(), 1e-5 * (1.0 + omega.norm()));
  }
}

TEST(Flatness, AnglesAreWrappedToHalfATurn) {
  EXPECT_NEAR(wrapped(3.0 * std::numbers::pi / 2.0), -std::numbers::pi / 2.0, 1e-12);
  EXPECT_NEAR(wrapped(-100.0 * std::numbers::pi), 0.0, 1e-12);
}

}  // namespace
}  // namespace goshawk
