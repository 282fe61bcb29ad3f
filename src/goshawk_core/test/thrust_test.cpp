// Thrust and tilt that a curve needs, by its control points, against samples of the curve.
#include "goshawk/core/thrust.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "goshawk/core/random.hpp"
#include "goshawk/core/vehicle.hpp"

namespace goshawk {
namespace {

BezierPiece random_piece(Random& random, double reach_m) {
  BezierPiece piece;
  piece.duration_s = random.uniform(0.5, 2.0);
  for (int j = 0; j < piece.control_points.cols(); ++j) {
    for (int axis = 0; axis < 3; ++axis) {
      piece.control_points(axis, j) = random.uniform(-reach_m, reach_m);
    }
  }
  return piece;
}

Vec3 specific_force(const BezierPiece& piece, double t_s) {
  return Trajectory{{piece}}.sample(t_s).acceleration + Vec3(0.0, 0.0, kGravity_m_s2);
}

TEST(Thrust, BoundsHoldOnTheWholeCurveAndAreReachedAtItsEnds) {
  Random random(3);
  for (int i = 0; i < 200; ++i) {
    SCOPED_TRACE(i);
    const BezierPiece piece = random_piece(random, random.uniform(0.05, 2.0));
    const ThrustUse use = thrust_of(piece);
    for (int k = 0; k <= 200; ++k) {
      const Vec3 f = specific_force(piece, piece.duration_s * k / 200);
      ASSERT_LE(f.norm(), use.thrust_most_m_s2 + 1e-9);
      ASSERT_GE(f.z(), use.thrust_least_m_s2 - 1e-9);
      // Forces within a tilt form a convex set below pi / 2 only.
      const bool bounded = use.tilt_rad < 0.5 * std::numbers::pi;
      ASSERT_TRUE(!bounded || std::acos(f.z() / f.norm()) <= use.tilt_rad + 1e-9);
    }
  }
}

TEST(Thrust, HoveringNeedsGravityAndNoTilt) {
  BezierPiece still;
  still.duration_s = 1.0;
  still.control_points.setConstant(2.0);
  const ThrustUse use = thrust_of(still);
  EXPECT_DOUBLE_EQ(use.thrust_most_m_s2, kGravity_m_s2);
  EXPECT_DOUBLE_EQ(use.thrust_least_m_s2, kGravity_m_s2);
  EXPECT_DOUBLE_EQ(use.tilt_rad, 0.0);
}

TEST(Thrust, ATrajectoryNeedsWhatItsHardestPieceNeeds) {
  Random random(4);
  const BezierPiece gentle = random_piece(random, 0.01);
  const BezierPiece hard = random_piece(random, 1.0);
  const ThrustUse whole = thrust_of(Trajectory{{gentle, hard}});
  EXPECT_DOUBLE_EQ(whole.thrust_most_m_s2, thrust_of(hard).thrust_most_m_s2);
  EXPECT_DOUBLE_EQ(whole.thrust_least_m_s2, thrust_of(hard).thrust_least_m_s2);
  EXPECT_DOUBLE_EQ(whole.tilt_rad, thrust_of(hard).tilt_rad);
}

TEST(Thrust, EachLimitIsHeldAloneAndZeroIsNone) {
  const ThrustUse use{12.0, 8.0, 0.3};
  EXPECT_TRUE(respects(use, {}));
  EXPECT_TRUE(ThrustLimits{}.none());
  EXPECT_TRUE(respects(use, {12.0, 8.0, 0.3}));
  EXPECT_FALSE(respects(use, {11.9, 0.0, 0.0}));
  EXPECT_FALSE(respects(use, {0.0, 8.1, 0.0}));
  EXPECT_FALSE(respects(use, {0.0, 0.0, 0.29}));
}

// Any acceleration of that length, in any direction, keeps all limits; a little more does not.
TEST(Thrust, TheSafeAccelerationIsTheLargestOneSafeInEveryDirection) {
  Random random(5);
  for (int i = 0; i < 100; ++i) {
    SCOPED_TRACE(i);
    const ThrustLimits limits{random.uniform(10.5, 20.0), random.uniform(1.0, 9.0),
                              random.uniform(0.1, 1.2)};
    const double safe = limits.safe_acceleration_m_s2();
    const auto holds = [&](const Vec3& a) {
      const Vec3 f = a + Vec3(0.0, 0.0, kGravity_m_s2);
      return respects({f.norm(), f.z(), std::acos(f.z() / f.norm())}, limits);
    };
    bool breaks = false;
    for (int k = 0; k < 2000; ++k) {
      const Vec3 way =
          Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)).normalized();
      ASSERT_TRUE(holds(safe * way));
      breaks = breaks || !holds(1.1 * safe * way);
    }
    EXPECT_TRUE(breaks);
  }
  EXPECT_LT((ThrustLimits{9.0, 0.0, 0.0}.safe_acceleration_m_s2()), 0.0);
}

}  // namespace
}  // namespace goshawk
