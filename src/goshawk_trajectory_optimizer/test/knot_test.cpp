#include "goshawk/trajectory_optimizer/knot.hpp"

#include <gtest/gtest.h>

#include "goshawk/core/random.hpp"
#include "goshawk/core/trajectory.hpp"

namespace goshawk::trajectory_optimizer {
namespace {

Knot random_knot(Random& random) {
  return Knot::NullaryExpr([&] { return random.uniform(-3.0, 3.0); });
}

FlatState state_of(const Knot& knot) {
  FlatState s;
  s.position = knot.col(0);
  s.velocity = knot.col(1);
  s.acceleration = knot.col(2);
  return s;
}

TEST(Knot, PointMapsGiveTheControlPointsOfTheQuintic) {
  Random random(1);
  for (int n = 0; n < 100; ++n) {
    const Knot a = random_knot(random);
    const Knot b = random_knot(random);
    const double T = random.uniform(0.1, 4.0);
    const auto piece = BezierPiece::between(state_of(a), state_of(b), T);
    const auto expect = [](const Vec3& value, const Vec3& truth) {
      EXPECT_LT((value - truth).norm(), 1e-9 * (1.0 + truth.norm()));
    };
    for (int j = 0; j < 6; ++j) expect(position_point(j, T)(a, b), piece.control_points.col(j));
    for (int j = 0; j < 5; ++j) expect(velocity_point(j, T)(a, b), piece.velocity_points().col(j));
    for (int j = 0; j < 4; ++j) {
      expect(acceleration_point(j, T)(a, b), piece.acceleration_points().col(j));
    }
    for (int j = 0; j < 3; ++j) expect(jerk_point(j, T)(a, b), piece.jerk_points().col(j));
  }
}

TEST(Knot, JerkHessianGivesTheQuadratureOfTheSquaredJerk) {
  Random random(2);
  for (int n = 0; n < 100; ++n) {
    const Knot a = random_knot(random);
    const Knot b = random_knot(random);
    const double T = random.uniform(0.1, 4.0);
    const auto piece = BezierPiece::between(state_of(a), state_of(b), T);
    double integral = 0.0;  // Simpson: exact for cubics, error T^5 / N^4 for this quartic
    constexpr int kSteps = 400;
    for (int i = 0; i <= kSteps; ++i) {
      const double weight = i == 0 || i == kSteps ? 1.0 : i % 2 == 1 ? 4.0 : 2.0;
      integral += weight * piece.sample(T * i / kSteps).jerk.squaredNorm();
    }
    integral *= T / kSteps / 3.0;
    Eigen::Matrix<double, 3, 6> x;
    x << a, b;
    const double cost = (x * jerk_hessian(T)).cwiseProduct(x).sum();
    EXPECT_NEAR(cost, integral, 1e-7 * integral);
  }
}

}  // namespace
}  // namespace goshawk::trajectory_optimizer
