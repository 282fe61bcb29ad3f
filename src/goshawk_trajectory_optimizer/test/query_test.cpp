// A given arrival, a deadline, and every kind of limit.
#include <gtest/gtest.h>

#include "corridor_maker.hpp"
#include "goshawk/trajectory_optimizer/trajectory_optimizer.hpp"

namespace goshawk::trajectory_optimizer {
namespace {

using test::at_rest;

TrajectoryOptimizer default_optimizer() {
  return TrajectoryOptimizer::create({}).value();
}

Result<Solution> answer_from_rest(TrajectoryOptimizer& optimizer, const Corridor& corridor,
                                  const Limits& limits, double duration_s = 0.0) {
  PlanRequest request = test::ask(corridor, limits);
  request.duration_s = duration_s;
  return optimizer.optimise(request, corridor);
}

TEST(GivenArrival, IsMetAndSmootherThanTheSoonest) {
  Random random(31);
  auto optimizer = default_optimizer();
  for (int i = 0; i < 60; ++i) {
    SCOPED_TRACE(i);
    const auto corridor = test::random_corridor(random, {});
    const auto soonest = answer_from_rest(optimizer, corridor, {});
    ASSERT_TRUE(soonest) << soonest.error().message;
    const double duration_s = soonest->trajectory().duration_s() * random.uniform(1.0, 4.0);
    const auto solution = answer_from_rest(optimizer, corridor, {}, duration_s);
    ASSERT_TRUE(solution) << solution.error().message;
    EXPECT_NEAR(solution->trajectory().duration_s(), duration_s, 1e-9 * duration_s);
    EXPECT_LE(solution->jerk_cost, soonest->jerk_cost * (1.0 + 1e-6));
  }
}

TEST(GivenArrival, TooSoonIsRefusedWithTheSoonest) {
  auto optimizer = default_optimizer();
  const auto solution = answer_from_rest(optimizer, test::straight_corridor(8.0), {}, 3.0);
  ASSERT_FALSE(solution);
  EXPECT_EQ(solution.code(), ErrorCode::trajectory_infeasible);
  EXPECT_NE(solution.error().message.find("soonest"), std::string::npos);
}

TEST(GivenArrival, NonsenseIsRefused) {
  auto optimizer = default_optimizer();
  for (const double bad : {-1.0, double(NAN), HUGE_VAL, 1e9}) {
    const auto solution = answer_from_rest(optimizer, test::straight_corridor(8.0), {}, bad);
    ASSERT_FALSE(solution);
    EXPECT_EQ(solution.code(), ErrorCode::invalid_input);
  }
}

TEST(GivenArrival, FromAMovingStart) {
  auto optimizer = default_optimizer();
  auto start = at_rest(Vec3::Zero());
  start.velocity = Vec3(1.0, 0.3, 0);
  const auto corridor = test::straight_corridor(6.0, 1.5);
  PlanRequest request = test::ask(start, at_rest(Vec3(6, 0, 0)));
  request.duration_s = 6.0;
  const auto solution = optimizer.optimise(request, corridor);
  ASSERT_TRUE(solution) << solution.error().message;
  EXPECT_NEAR(solution->trajectory().duration_s(), 6.0, 1e-9);
}

TEST(Deadline, EndsTheWork) {
  auto optimizer = default_optimizer();
  Random random(4);
  const auto corridor = test::random_corridor(random, {});
  int asked = 0;
  const auto solution =
      optimizer.optimise(test::ask(corridor), corridor, [&] { return ++asked > 3; });
  ASSERT_FALSE(solution);
  EXPECT_EQ(solution.code(), ErrorCode::deadline_exceeded);
  EXPECT_EQ(asked, 4);
  EXPECT_TRUE(answer_from_rest(optimizer, corridor, {}));
}

TEST(JerkLimit, HoldsOnTheCurveAndCostsTime) {
  Random random(12);
  auto optimizer = default_optimizer();
  for (int i = 0; i < 100; ++i) {
    SCOPED_TRACE(i);
    const auto corridor = test::random_corridor(random, {});
    const Limits limits{.j_max_m_s3 = random.uniform(2.0, 40.0)};
    const auto free = answer_from_rest(optimizer, corridor, {});
    const auto solution = answer_from_rest(optimizer, corridor, limits);
    ASSERT_TRUE(free && solution) << solution.error().message;
    EXPECT_LE(solution->certified.certificate().jerk_m_s3, 1e-6);
    for (const auto& piece : solution->trajectory().pieces) {
      for (int s = 0; s <= 20; ++s) {
        ASSERT_LE(piece.sample(piece.duration_s * s / 20).jerk.norm(), limits.j_max_m_s3 + 1e-6);
      }
    }
  }
}

TEST(JerkLimit, IsNearlyTimeOptimalOnALongStraightLine) {
  auto optimizer = default_optimizer();
  // Rest to rest with |j| <= j: ramps of a_max / j at each end of each acceleration.
  const Limits limits{.j_max_m_s3 = 4.0};
  const double least_s = 10.0 / 2.0 + 2.0 / 2.0 + 2.0 / 4.0;
  const auto solution = answer_from_rest(optimizer, test::straight_corridor(10.0), limits);
  ASSERT_TRUE(solution) << solution.error().message;
  EXPECT_GE(solution->trajectory().duration_s(), least_s * (1.0 - 1e-9));
  EXPECT_LE(solution->trajectory().duration_s(), 1.08 * least_s);
}

TEST(HorizontalAndVertical, EachHasItsOwnLimit) {
  Random random(13);
  auto optimizer = default_optimizer();
  for (int i = 0; i < 100; ++i) {
    SCOPED_TRACE(i);
    const auto corridor = test::random_corridor(random, {});
    const Limits limits{.v_max_m_s = random.uniform(1.0, 4.0),
                        .a_max_m_s2 = random.uniform(1.0, 4.0),
                        .norm = LimitNorm::horizontal_vertical,
                        .v_max_vertical_m_s = random.uniform(0.3, 4.0),
                        .a_max_vertical_m_s2 = random.uniform(0.3, 4.0)};
    const auto solution = answer_from_rest(optimizer, corridor, limits);
    ASSERT_TRUE(solution) << solution.error().message;
    for (int s = 0; s <= 500; ++s) {
      const auto state =
          solution->trajectory().sample(solution->trajectory().duration_s() * s / 500);
      ASSERT_LE(state.velocity.head<2>().norm(), limits.v_max_m_s + 1e-6);
      ASSERT_LE(std::abs(state.velocity.z()), limits.v_max_vertical_m_s + 1e-6);
      ASSERT_LE(state.acceleration.head<2>().norm(), limits.a_max_m_s2 + 1e-6);
      ASSERT_LE(std::abs(state.acceleration.z()), limits.a_max_vertical_m_s2 + 1e-6);
    }
  }
}

TEST(HorizontalAndVertical, ASlowClimbTakesItsTime) {
  auto optimizer = default_optimizer();
  Corridor corridor;
  corridor.waypoints_map = {Vec3::Zero(), Vec3(0, 0, 4)};
  corridor.polytopes = {Polytope::box(Vec3(-1, -1, -1), Vec3(1, 1, 5))};
  const Limits limits{.norm = LimitNorm::horizontal_vertical, .v_max_vertical_m_s = 0.5};
  const auto solution = answer_from_rest(optimizer, corridor, limits);
  ASSERT_TRUE(solution) << solution.error().message;
  EXPECT_GE(solution->trajectory().duration_s(), 8.0);
  EXPECT_LE(solution->trajectory().duration_s(), 9.0);
}

}  // namespace
}  // namespace goshawk::trajectory_optimizer
