#include "goshawk/core/yaw_curve.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "goshawk/core/random.hpp"

namespace goshawk {
namespace {

YawCurve random_curve(Random& random) {
  YawCurve curve{random.uniform(0.02, 0.5), {}};
  const int points = 3 + random.below(8);
  for (int k = 0; k < points; ++k) curve.points_rad.push_back(random.uniform(-7.0, 7.0));
  return curve;
}

TEST(YawCurve, BeginsAndEndsHalfwayBetweenItsOuterPoints) {
  const YawCurve curve{0.5, {1.0, 2.0, 4.0, 4.0}};
  EXPECT_DOUBLE_EQ(curve.duration_s(), 1.0);
  EXPECT_DOUBLE_EQ(curve.yaw_rad(0.0), 1.5);
  EXPECT_DOUBLE_EQ(curve.yaw_rad(0.5), 3.0);
  EXPECT_DOUBLE_EQ(curve.yaw_rad(1.0), 4.0);
  EXPECT_DOUBLE_EQ(curve.rate_rad_s(0.0), 2.0);
  EXPECT_DOUBLE_EQ(curve.rate_rad_s(0.25), 3.0);
  EXPECT_DOUBLE_EQ(curve.rate_rad_s(1.0), 0.0);
}

// The definition: the basis function of each point, piecewise quadratic over three spans.
TEST(YawCurve, IsTheSumOfItsBasisFunctions) {
  const auto basis = [](double x) {  // the uniform quadratic B-spline over [0, 3]
    if (x < 0.0 || x > 3.0) return 0.0;
    if (x < 1.0) return 0.5 * x * x;
    if (x < 2.0) return 0.5 * (-2.0 * x * x + 6.0 * x - 3.0);
    return 0.5 * (3.0 - x) * (3.0 - x);
  };
  Random random(1);
  for (int n = 0; n < 200; ++n) {
    const YawCurve curve = random_curve(random);
    const double t = random.uniform(0.0, curve.duration_s());
    double sum = 0.0;
    for (std::size_t k = 0; k < curve.points_rad.size(); ++k) {
      sum += curve.points_rad[k] * basis(t / curve.step_s + 2.0 - double(k));
    }
    ASSERT_NEAR(curve.yaw_rad(t), sum, 1e-12);
  }
}

TEST(YawCurve, HasTheRateThatDifferencesShow) {
  Random random(2);
  for (int n = 0; n < 200; ++n) {
    const YawCurve curve = random_curve(random);
    const double h = 1e-5 * curve.step_s;
    const double t = random.uniform(2.0 * h, curve.duration_s() - 2.0 * h);
    const double rate = (curve.yaw_rad(t + h) - curve.yaw_rad(t - h)) / (2.0 * h);
    ASSERT_NEAR(curve.rate_rad_s(t), rate, 1e-3 * (1.0 + std::abs(rate)));
  }
}

TEST(YawCurve, StaysAtItsEndsBeforeAndAfter) {
  Random random(3);
  const YawCurve curve = random_curve(random);
  EXPECT_EQ(curve.yaw_rad(-5.0), curve.yaw_rad(0.0));
  EXPECT_EQ(curve.yaw_rad(curve.duration_s() + 5.0), curve.yaw_rad(curve.duration_s()));
  EXPECT_EQ(curve.rate_rad_s(-5.0), 0.0);
  EXPECT_EQ(curve.rate_rad_s(curve.duration_s() + 5.0), 0.0);
}

TEST(YawCurve, CheckRefusesWhatIsNoCurve) {
  EXPECT_TRUE((YawCurve{0.1, {0, 1, 2}}.check().ok()));
  EXPECT_EQ(YawCurve{}.check().code(), ErrorCode::invalid_input);
  EXPECT_EQ((YawCurve{0.1, {0, 1}}.check().code()), ErrorCode::invalid_input);
  for (const double step : {0.0, -0.1, double(NAN), double(INFINITY)}) {
    EXPECT_EQ((YawCurve{step, {0, 1, 2}}.check().code()), ErrorCode::invalid_input) << step;
  }
  for (const double bad : {double(NAN), double(INFINITY)}) {
    EXPECT_EQ((YawCurve{0.1, {0, 1, bad}}.check().code()), ErrorCode::invalid_input) << bad;
  }
}

// What proves a rate limit without a look at the curve.
TEST(YawCurve, ItsPointsBoundItsHeadingAndItsRateAtAllTimesAndNotLoosely) {
  Random random(4);
  for (int n = 0; n < 200; ++n) {
    const YawCurve curve = random_curve(random);
    double bound = 0.0, fastest = 0.0;
    for (std::size_t k = 1; k < curve.points_rad.size(); ++k) {
      const double difference = curve.points_rad[k] - curve.points_rad[k - 1];
      bound = std::max(bound, std::abs(difference) / curve.step_s);
    }
    const auto [low, high] = std::ranges::minmax(curve.points_rad);
    for (int k = 0; k <= 1000; ++k) {
      const double t = curve.duration_s() * k / 1000.0;
      ASSERT_GE(curve.yaw_rad(t), low - 1e-12);
      ASSERT_LE(curve.yaw_rad(t), high + 1e-12);
      fastest = std::max(fastest, std::abs(curve.rate_rad_s(t)));
    }
    ASSERT_LE(fastest, bound * (1.0 + 1e-12));
    ASSERT_GT(fastest, 0.9 * bound);
  }
}

}  // namespace
}  // namespace goshawk
