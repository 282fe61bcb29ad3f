// Yaw as an output of its own: from the request's yaw and rate to where the config looks.
#include "goshawk/trajectory_optimizer/yaw.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "corridor_maker.hpp"
#include "goshawk/trajectory_optimizer/trajectory_optimizer.hpp"

namespace goshawk::trajectory_optimizer {
namespace {

constexpr YawMode kModes[] = {YawMode::fixed, YawMode::along_motion, YawMode::towards_point};

Trajectory trajectory_through(const Corridor& corridor) {
  auto optimizer = TrajectoryOptimizer::create({}).value();
  return optimizer.optimise(test::ask(corridor), corridor).value().trajectory();
}

double turn(double from, double to) {
  return std::remainder(to - from, 2.0 * std::numbers::pi);
}

TEST(Yaw, BeginsAsAskedAndKeepsItsRateInEveryMode) {
  Random random(3);
  for (int i = 0; i < 60; ++i) {
    SCOPED_TRACE(i);
    const auto trajectory = trajectory_through(test::random_corridor(random, {}));
    const Config config{.yaw = kModes[i % 3],
                        .yaw_rate_max_rad_s = random.uniform(0.2, 3.0),
                        .yaw_point_x_m = random.uniform(-5.0, 5.0)};
    PlanRequest request;
    request.start_yaw_rad = random.uniform(-9.0, 9.0);
    request.start_yaw_rate_rad_s = config.yaw_rate_max_rad_s * random.uniform(-0.99, 0.99);
    request.goal_yaw_rad = random.uniform(-9.0, 9.0);
    const auto curve = plan_yaw(trajectory, request, config);
    ASSERT_TRUE(curve);
    EXPECT_NEAR(curve->duration_s(), trajectory.duration_s(), 1e-9);
    EXPECT_NEAR(curve->yaw_rad(0.0), request.start_yaw_rad, 1e-12);
    EXPECT_NEAR(curve->rate_rad_s(0.0), request.start_yaw_rate_rad_s, 1e-9);
    const double dt = trajectory.duration_s() / 5000;
    for (int k = 0; k < 5000; ++k) {
      const double step = curve->yaw_rad((k + 1) * dt) - curve->yaw_rad(k * dt);
      ASSERT_LE(std::abs(step), config.yaw_rate_max_rad_s * dt * (1.0 + 1e-9));
    }
  }
}

TEST(Yaw, ARateAboveTheLimitIsTheLimit) {
  PlanRequest request;
  request.start_yaw_rate_rad_s = -9.0;
  const auto curve = plan_yaw(trajectory_through(test::straight_corridor(4.0)), request,
                              {.yaw = YawMode::fixed, .yaw_rate_max_rad_s = 0.5});
  ASSERT_TRUE(curve);
  EXPECT_NEAR(curve->rate_rad_s(0.0), -0.5, 1e-9);
  EXPECT_NEAR(curve->yaw_rad(0.0), 0.0, 1e-12);
}

TEST(Yaw, LooksAlongTheMotionOnceItHasTurned) {
  PlanRequest request;
  request.start_yaw_rad = 3.0;
  const auto curve = plan_yaw(trajectory_through(test::straight_corridor(8.0)), request,
                              {.yaw = YawMode::along_motion, .yaw_rate_max_rad_s = 2.0});
  ASSERT_TRUE(curve);
  EXPECT_NEAR(turn(curve->yaw_rad(3.0), 0.0), 0.0, 1e-9);
}

TEST(Yaw, LooksAtAPointItFliesPast) {
  const auto trajectory = trajectory_through(test::straight_corridor(8.0));
  const Config config{.yaw = YawMode::towards_point,
                      .yaw_rate_max_rad_s = 3.0,
                      .yaw_point_x_m = 4.0,
                      .yaw_point_y_m = 3.0};
  const auto curve = plan_yaw(trajectory, {}, config);
  ASSERT_TRUE(curve);
  for (double t = 1.0; t < trajectory.duration_s(); t += 0.1) {
    const Vec3 to = Vec3(4.0, 3.0, 0.0) - trajectory.sample(t).position;
    EXPECT_LT(std::abs(turn(curve->yaw_rad(t), std::atan2(to.y(), to.x()))), 0.1) << t;
  }
}

TEST(Yaw, SaysNothingWithoutADirection) {
  const Config motion{.yaw = YawMode::along_motion};
  FlatState state;
  state.position = Vec3(1, 1, 1);
  EXPECT_FALSE(wanted_yaw_rad(state, {}, motion));
  state.velocity = Vec3(0, 0, 2);
  EXPECT_FALSE(wanted_yaw_rad(state, {}, motion));
  state.velocity = Vec3(0, -1, 2);
  EXPECT_NEAR(wanted_yaw_rad(state, {}, motion).value(), -std::numbers::pi / 2.0, 1e-12);
  Config point{.yaw = YawMode::towards_point, .yaw_point_x_m = 1.0, .yaw_point_y_m = 1.0};
  EXPECT_FALSE(wanted_yaw_rad(state, {}, point));
  point.yaw_point_x_m = point.yaw_point_y_m = 2.0;
  EXPECT_NEAR(wanted_yaw_rad(state, {}, point).value(), std::numbers::pi / 4.0, 1e-12);
  EXPECT_FALSE(wanted_yaw_rad(state, {}, {}));
  EXPECT_FALSE(plan_yaw(trajectory_through(test::straight_corridor(2.0)), {}, {}));
}

// A stage keeps nothing: what the vehicle was told before is in the request or plays no part.
TEST(Yaw, DoesNotDependOnEarlierRequests) {
  Random random(5);
  for (const YawMode mode : kModes) {
    const Config config{.yaw = mode};
    auto used = TrajectoryOptimizer::create(config).value();
    for (int i = 0; i < 10; ++i) {
      const auto corridor = test::random_corridor(random, {});
      PlanRequest request = test::ask(corridor);
      request.start_yaw_rad = random.uniform(-3.0, 3.0);
      request.goal_yaw_rad = random.uniform(-3.0, 3.0);
      auto fresh = TrajectoryOptimizer::create(config).value();
      const auto answer = used.optimise(request, corridor);
      const auto alone = fresh.optimise(request, corridor);
      ASSERT_TRUE(answer && answer->yaw && alone && alone->yaw);
      EXPECT_EQ(answer->yaw->step_s, alone->yaw->step_s);
      EXPECT_EQ(answer->yaw->points_rad, alone->yaw->points_rad);
    }
  }
}

}  // namespace
}  // namespace goshawk::trajectory_optimizer
