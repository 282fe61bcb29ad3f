// Thrust and tilt that a flight needs, and how a flight is slowed to what a vehicle has.
#include <gtest/gtest.h>

#include "corridor_maker.hpp"
#include "goshawk/core/vehicle.hpp"
#include "goshawk/core/thrust.hpp"
#include "goshawk/trajectory_optimizer/trajectory_optimizer.hpp"

namespace goshawk::trajectory_optimizer {
namespace {

using test::at_rest;

Solution fly(const Corridor& corridor, const Limits& limits = {}, const Config& config = {}) {
  auto optimizer = TrajectoryOptimizer::create(config).value();
  return optimizer.optimise(test::ask(corridor, limits), corridor).value();
}

TEST(VehicleLimits, BoundsHoldOnTheSampledCurve) {
  Random random(5);
  for (int i = 0; i < 50; ++i) {
    const auto trajectory =
        fly(test::random_corridor(random, {}), {.v_max_m_s = 4.0, .a_max_m_s2 = 8.0}).trajectory();
    const ThrustUse use = thrust_of(trajectory);
    for (int k = 0; k <= 1000; ++k) {
      const Vec3 f = trajectory.sample(trajectory.duration_s() * k / 1000).acceleration +
                     Vec3(0, 0, kGravity_m_s2);
      ASSERT_LE(f.norm(), use.thrust_most_m_s2 + 1e-9);
      ASSERT_GE(f.norm(), use.thrust_least_m_s2 - 1e-9);
      ASSERT_LE(std::acos(f.z() / f.norm()), use.tilt_rad + 1e-9);
    }
  }
}

TEST(VehicleLimits, AFlightThatAsksTooMuchIsSlowedWhereItDoes) {
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
    EXPECT_TRUE(respects(thrust_of(able.trajectory()), {14.0, 0.0, 0.35}));
    // Not slower than a flight whose limit is safe everywhere.
    const double safe = ThrustLimits{14.0, 0.0, 0.35}.safe_acceleration_m_s2();
    const auto careful = fly(corridor, {.v_max_m_s = 4.0, .a_max_m_s2 = safe});
    EXPECT_LE(able.trajectory().duration_s(), careful.trajectory().duration_s() + 1e-9);
    slowed += able.trajectory().duration_s() > free.trajectory().duration_s() ? 1 : 0;
  }
  EXPECT_GT(slowed, 20);
}

TEST(VehicleLimits, ALimitThatIsSetBetweenTwoFlightsHoldsForTheNext) {
  Random random(8);
  const auto corridor = test::random_corridor(random, {});
  const auto flown = [&](TrajectoryOptimizer& optimizer) {
    return optimizer.optimise(test::ask(corridor), corridor).value();
  };
  auto optimizer = TrajectoryOptimizer::create({}).value();
  const auto before = flown(optimizer);
  Config config;
  config.max_tilt_rad = 0.1;
  ASSERT_TRUE(optimizer.reconfigure(config));
  const auto after = flown(optimizer);
  EXPECT_TRUE(respects(thrust_of(after.trajectory()), {0.0, 0.0, 0.1}));
  EXPECT_GT(after.trajectory().duration_s(), before.trajectory().duration_s());
  Config bad;
  bad.max_tilt_rad = 2.0;
  EXPECT_EQ(optimizer.reconfigure(bad).code(), ErrorCode::invalid_parameter);
  EXPECT_EQ(flown(optimizer).trajectory().duration_s(), after.trajectory().duration_s());
  ASSERT_TRUE(optimizer.reconfigure({}));
  EXPECT_EQ(flown(optimizer).trajectory().duration_s(), before.trajectory().duration_s());
}

TEST(VehicleLimits, AVehicleThatCannotHoverIsSaidToBeOne) {
  Config config;
  config.max_thrust_m_s2 = 9.0;
  auto optimizer = TrajectoryOptimizer::create(config).value();
  const auto solution = optimizer.optimise(test::ask(at_rest(Vec3::Zero()), at_rest(Vec3(3, 0, 0))),
                                           test::straight_corridor(3.0));
  ASSERT_FALSE(solution);
  EXPECT_EQ(solution.code(), ErrorCode::trajectory_infeasible);
}

}  // namespace
}  // namespace goshawk::trajectory_optimizer
