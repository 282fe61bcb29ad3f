#include "goshawk/obstacle_tracker/axis_filter.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>

#include "goshawk/core/random.hpp"

namespace goshawk::obstacle_tracker {
namespace {

// Truth: the same filter as matrices, from the textbook.
TEST(AxisFilter, IsTheKalmanFilterOfMatrices) {
  Random random(1);
  AxisFilter axis = AxisFilter::at(1.0, 0.3, 2.0);
  Eigen::Vector2d x(1.0, 0.0);
  Eigen::Matrix2d p = Eigen::Vector2d(0.09, 4.0).asDiagonal();
  for (int i = 0; i < 200; ++i) {
    const double dt = random.uniform(0.0, 0.3), a = 1.5, sd = random.uniform(0.05, 0.5);
    Eigen::Matrix2d f;
    f << 1.0, dt, 0.0, 1.0;
    const Eigen::Vector2d g(0.5 * dt * dt, dt);
    x = f * x;
    p = f * p * f.transpose() + a * a * g * g.transpose();
    axis.predict(dt, a);
    const double measured = random.uniform(-2.0, 2.0);
    const Eigen::Vector2d gain = p.col(0) / (p(0, 0) + sd * sd);
    x += gain * (measured - x[0]);
    p -= gain * p.row(0).eval();
    axis.update(measured, sd);
    ASSERT_NEAR(axis.position, x[0], 1e-9);
    ASSERT_NEAR(axis.velocity, x[1], 1e-9);
    ASSERT_NEAR(axis.pp, p(0, 0), 1e-9);
    ASSERT_NEAR(axis.pv, p(0, 1), 1e-9);
    ASSERT_NEAR(axis.vv, p(1, 1), 1e-9);
  }
}

TEST(AxisFilter, FindsASteadyVelocityAndStatesItsError) {
  Random random(2);
  int inside = 0;
  constexpr int kRuns = 400;
  for (int run = 0; run < kRuns; ++run) {
    AxisFilter axis = AxisFilter::at(0.0, 0.1, 2.0);
    for (int i = 1; i <= 20; ++i) {
      double noise = -6.0;
      for (int k = 0; k < 12; ++k) noise += random.uniform();
      axis.predict(0.1, 0.2);
      axis.update(1.5 * 0.1 * i + 0.1 * noise, 0.1);
    }
    inside += std::abs(axis.velocity - 1.5) < 2.0 * std::sqrt(axis.vv) ? 1 : 0;
  }
  EXPECT_GT(inside, int(0.93 * kRuns));
}

}  // namespace
}  // namespace goshawk::obstacle_tracker
