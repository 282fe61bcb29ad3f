// Yaw as an output of its own, and what thrust and tilt the others ask for.
#include <gtest/gtest.h>

#include <numbers>

#include "corridor_maker.hpp"
#include "goshawk/core/vehicle.hpp"
#include "goshawk/trajectory_optimizer/flatness.hpp"
#include "goshawk/trajectory_optimizer/trajectory_optimizer.hpp"
#include "goshawk/trajectory_optimizer/yaw.hpp"

namespace goshawk::trajectory_optimizer {
namespace {

using test::at_rest;

Solution fly(const Corridor& corridor, const Limits& limits = {}, const Config& config = {}) {
  auto optimizer = TrajectoryOptimizer::create(config).value();
  return optimizer
      .optimise(corridor, at_rest(corridor.waypoints_map.front()),
                at_rest(corridor.waypoints_map.back()), limits)
      .value();
}

double turn(double from, double to) {
  return std::remainder(to - from, 2.0 * std::numbers::pi);
}

TEST(Yaw, RateLimitAndContinuityHoldForEveryMode) {
  Random random(3);
  for (int i = 0; i < 60; ++i) {
    SCOPED_TRACE(i);
    const auto trajectory = fly(test::random_corridor(random, {})).trajectory;
    const YawRequest request{.mode = YawMode(i % 3),
                             .start_rad = random.uniform(-9.0, 9.0),
                             .fixed_rad = random.uniform(-9.0, 9.0),
                             .point_map = test::random_direction(random),
                             .rate_max_rad_s = random.uniform(0.2, 3.0)};
    const auto curve = plan_yaw(trajectory, request);
    ASSERT_TRUE(curve) << curve.error().message;
    EXPECT_NEAR(curve->duration_s(), trajectory.duration_s(), 1e-9);
    EXPECT_NEAR(curve->yaw_rad(0.0), request.start_rad, 1e-12);
    EXPECT_LE(curve->rate_bound_rad_s(), request.rate_max_rad_s);
    const double dt = trajectory.duration_s() / 5000;
    for (int k = 0; k < 5000; ++k) {
      const double a = curve->yaw_rad(k * dt), b = curve->yaw_rad((k + 1) * dt);
      ASSERT_LE(std::abs(b - a), request.rate_max_rad_s * dt * (1.0 + 1e-9));
      ASSERT_NEAR((b - a) / dt, curve->rate_rad_s((k + 0.5) * dt), 0.05 * request.rate_max_rad_s);
    }
  }
}

TEST(Yaw, LooksAlongTheMotionOnceItHasTurned) {
  const auto trajectory = fly(test::straight_corridor(8.0)).trajectory;
  const auto curve = plan_yaw(trajectory, {.start_rad = 3.0, .rate_max_rad_s = 2.0}).value();
  EXPECT_NEAR(turn(curve.yaw_rad(3.0), 0.0), 0.0, 1e-9);
}

TEST(Yaw, LooksAtAPointItFliesPast) {
  const auto trajectory = fly(test::straight_corridor(8.0)).trajectory;
  const Vec3 point(4.0, 3.0, 0.0);
  const auto curve =
      plan_yaw(trajectory,
               {.mode = YawMode::towards_point, .point_map = point, .rate_max_rad_s = 3.0})
          .value();
  for (double t = 1.0; t < trajectory.duration_s(); t += 0.1) {
    const Vec3 to = point - trajectory.sample(t).position;
    EXPECT_LT(std::abs(turn(curve.yaw_rad(t), std::atan2(to.y(), to.x()))), 0.1) << t;
  }
}

TEST(Yaw, WhereThereIsNothingToLookAtThereIsNoWish) {
  FlatState state;
  state.position = Vec3(1, 1, 1);
  YawRequest motion{.mode = YawMode::along_motion};
  EXPECT_FALSE(wanted_yaw_rad(state, motion));
  state.velocity = Vec3(0, 0, 2);
  EXPECT_FALSE(wanted_yaw_rad(state, motion));
  state.velocity = Vec3(0, -1, 2);
  EXPECT_NEAR(wanted_yaw_rad(state, motion).value(), -std::numbers::pi / 2.0, 1e-12);
  YawRequest point{.mode = YawMode::towards_point, .point_map = Vec3(1, 1, 5)};
  EXPECT_FALSE(wanted_yaw_rad(state, point));
  point.point_map = Vec3(2, 2, 0);
  EXPECT_NEAR(wanted_yaw_rad(state, point).value(), std::numbers::pi / 4.0, 1e-12);
}

TEST(Yaw, RefusesNonsense) {
  const auto trajectory = fly(test::straight_corridor(2.0)).trajectory;
  EXPECT_EQ(plan_yaw({}, {}).code(), ErrorCode::invalid_input);
  EXPECT_EQ(plan_yaw(trajectory, {.start_rad = NAN}).code(), ErrorCode::invalid_input);
  for (const double bad : {0.0, -1.0, double(NAN), HUGE_VAL}) {
    EXPECT_EQ(plan_yaw(trajectory, {.rate_max_rad_s = bad}).code(), ErrorCode::invalid_limits);
  }
}

TEST(Flatness, BoundsHoldOnTheSampledCurve) {
  Random random(5);
  for (int i = 0; i < 50; ++i) {
    const auto trajectory =
        fly(test::random_corridor(random, {}), {.v_max_m_s = 4.0, .a_max_m_s2 = 8.0}).trajectory;
    const FlatnessUse use = flatness_of(trajectory);
    for (int k = 0; k <= 1000; ++k) {
      const Vec3 f = trajectory.sample(trajectory.duration_s() * k / 1000).acceleration +
                     Vec3(0, 0, kGravity_m_s2);
      ASSERT_LE(f.norm(), use.thrust_most_m_s2 + 1e-9);
      ASSERT_GE(f.norm(), use.thrust_least_m_s2 - 1e-9);
      ASSERT_LE(std::acos(f.z() / f.norm()), use.tilt_rad + 1e-9);
    }
  }
}

TEST(Flatness, AFlightThatAsksTooMuchIsSlowedWhereItDoes) {
  Random random(6);
  const Limits limits{.v_max_m_s = 4.0, .a_max_m_s2 = 6.0};
  int slowed = 0;
  for (int i = 0; i < 40; ++i) {
    SCOPED_TRACE(i);
    const auto corridor = test::random_corridor(random, {});
    Config config;
    config.max_tilt_rad = 0.35;
    config.max_thrust_m_s2 = 14.0;
    const auto free = fly(corridor, limits);
    const auto able = fly(corridor, limits, config);
    EXPECT_TRUE(able.certificate.holds());
    EXPECT_TRUE(respects(flatness_of(able.trajectory), {14.0, 0.0, 0.35}));
    // Not slower than a flight whose limit is safe everywhere.
    const double safe = FlatnessLimits{14.0, 0.0, 0.35}.safe_acceleration_m_s2();
    const auto careful = fly(corridor, {.v_max_m_s = 4.0, .a_max_m_s2 = safe});
    EXPECT_LE(able.trajectory.duration_s(), careful.trajectory.duration_s() + 1e-9);
    slowed += able.trajectory.duration_s() > free.trajectory.duration_s() ? 1 : 0;
  }
  EXPECT_GT(slowed, 20);
}

TEST(Flatness, ALimitThatIsSetBetweenTwoFlightsHoldsForTheNext) {
  Random random(8);
  const auto corridor = test::random_corridor(random, {});
  const auto flown = [&](TrajectoryOptimizer& optimizer) {
    return optimizer
        .optimise(corridor, at_rest(corridor.waypoints_map.front()),
                  at_rest(corridor.waypoints_map.back()), {})
        .value();
  };
  auto optimizer = TrajectoryOptimizer::create({}).value();
  const auto before = flown(optimizer);
  Config config;
  config.max_tilt_rad = 0.1;
  ASSERT_TRUE(optimizer.reconfigure(config));
  const auto after = flown(optimizer);
  EXPECT_TRUE(respects(flatness_of(after.trajectory), {0.0, 0.0, 0.1}));
  EXPECT_GT(after.trajectory.duration_s(), before.trajectory.duration_s());
  Config bad;
  bad.max_tilt_rad = 2.0;
  EXPECT_EQ(optimizer.reconfigure(bad).code(), ErrorCode::invalid_parameter);
  EXPECT_EQ(flown(optimizer).trajectory.duration_s(), after.trajectory.duration_s());
  ASSERT_TRUE(optimizer.reconfigure({}));
  EXPECT_EQ(flown(optimizer).trajectory.duration_s(), before.trajectory.duration_s());
}

TEST(Flatness, AVehicleThatCannotHoverIsSaidToBeOne) {
  Config config;
  config.max_thrust_m_s2 = 9.0;
  auto optimizer = TrajectoryOptimizer::create(config).value();
  const auto solution = optimizer.optimise(test::straight_corridor(3.0), at_rest(Vec3::Zero()),
                                           at_rest(Vec3(3, 0, 0)), {});
  ASSERT_FALSE(solution);
  EXPECT_EQ(solution.code(), ErrorCode::trajectory_infeasible);
}

}  // namespace
}  // namespace goshawk::trajectory_optimizer
