#include "goshawk/sensors/return_model.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "support.hpp"

namespace goshawk::sensors {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

ReturnParameters plain() {
  ReturnParameters p;
  p.range_min_m = 0.5;
  p.range_max_m = 50.0;
  p.range_noise_m = 0.0;
  return p;
}

std::vector<double> measured(const ReturnParameters& p, double true_m, double beside_m, int count) {
  const ReturnModel model(p);
  Random random(99);
  std::vector<double> values;
  for (int i = 0; i < count; ++i) {
    if (const auto m = model.measure(true_m, beside_m, random)) values.push_back(*m);
  }
  return values;
}

struct Moments {
  double mean = 0.0, deviation = 0.0;
};

Moments moments_of(const std::vector<double>& values) {
  Moments m;
  for (const double v : values) m.mean += v / double(values.size());
  for (const double v : values) {
    m.deviation += (v - m.mean) * (v - m.mean) / double(values.size());
  }
  m.deviation = std::sqrt(m.deviation);
  return m;
}

double chi_square(const std::vector<int>& counts, const std::vector<double>& expected) {
  double sum = 0.0;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    sum += (counts[i] - expected[i]) * (counts[i] - expected[i]) / expected[i];
  }
  return sum;
}

// A share of n draws lies within 5 deviations of the binomial distribution.
void expect_share(double count, double n, double share) {
  EXPECT_NEAR(count / n, share, 5.0 * std::sqrt(share * (1.0 - share) / n));
}

TEST(ReturnModel, NormalNumbersPassAChiSquareTest) {
  Random random(1);
  constexpr int kDraws = 20'000, kBins = 16;
  std::vector<int> counts(kBins, 0);
  double sum = 0.0, squares = 0.0;
  for (int i = 0; i < kDraws; ++i) {
    const double v = normal(random);
    sum += v, squares += v * v;
    const double share = 0.5 * std::erfc(-v / std::sqrt(2.0));  // uniform, if v is normal
    ++counts[std::size_t(std::min(int(share * kBins), kBins - 1))];
  }
  EXPECT_NEAR(sum / kDraws, 0.0, 5.0 / std::sqrt(double(kDraws)));
  EXPECT_NEAR(squares / kDraws, 1.0, 5.0 * std::sqrt(2.0 / kDraws));
  // 15 degrees of freedom: 44.3 is passed by chance once in 10,000.
  EXPECT_LT(chi_square(counts, std::vector<double>(kBins, double(kDraws) / kBins)), 44.3);
}

TEST(ReturnModel, LidarNoiseHasTheMeanAndDeviationOfTheParameters) {
  auto p = plain();
  p.range_noise_m = 0.03;
  const auto values = measured(p, 12.0, 12.0, 20'000);
  ASSERT_EQ(values.size(), 20'000U);
  const Moments m = moments_of(values);
  EXPECT_NEAR(m.mean, 12.0, 5.0 * 0.03 / std::sqrt(2e4));
  EXPECT_NEAR(m.deviation, 0.03, 5.0 * 0.03 / std::sqrt(4e4));
}

TEST(ReturnModel, StereoNoiseGrowsWithTheSquareOfDepth) {
  SensorParameters s;
  apply_preset(Preset::d435, s);
  s.returns.edge_share = 0.0;
  // 3.8, 15, 34 and 94 mm: D435 with 0.08 pixels.
  for (const auto& [depth_m, deviation_m] :
       {std::pair{1.0, 0.0038}, {2.0, 0.0151}, {3.0, 0.034}, {5.0, 0.0943}}) {
    const Moments m = moments_of(measured(s.returns, depth_m, depth_m, 20'000));
    EXPECT_NEAR(m.deviation, deviation_m, 0.03 * deviation_m) << depth_m;
    EXPECT_NEAR(m.mean, depth_m, 5.0 * deviation_m / std::sqrt(2e4));
  }
  s.returns.range_noise_m = 0.0943;
  EXPECT_NEAR(ReturnModel(s.returns).deviation_m(5.0), std::sqrt(2.0) * 0.0943, 1e-3);
}

TEST(ReturnModel, WhatIsTooNearTooFarOrNowhereIsMissing) {
  const auto p = plain();
  EXPECT_TRUE(measured(p, 0.49, 0.49, 100).empty());
  EXPECT_TRUE(measured(p, 50.01, 50.01, 100).empty());
  EXPECT_TRUE(measured(p, kInfinity, kInfinity, 100).empty());
  EXPECT_EQ(measured(p, 0.51, 0.51, 100).size(), 100U);
  EXPECT_EQ(measured(p, 49.9, 49.9, 100).size(), 100U);
}

TEST(ReturnModel, NoiseNeverReportsARangeThatTheSensorDoesNotMeasure) {
  auto p = plain();
  p.range_noise_m = 0.2;
  for (const double true_m : {0.5, 50.0}) {
    const auto values = measured(p, true_m, true_m, 4000);
    expect_share(double(values.size()), 4000, 0.5);
    for (const double v : values) EXPECT_TRUE(v >= p.range_min_m && v <= p.range_max_m);
  }
}

TEST(ReturnModel, TheMissingShareIsLost) {
  auto p = plain();
  p.missing_share = 0.07;
  expect_share(double(measured(p, 9.0, 9.0, 20'000).size()), 20'000, 0.93);
}

TEST(ReturnModel, FalseReturnsLieEvenlyBeforeTheSurfaceAndAlsoInOpenSky) {
  auto p = plain();
  p.false_share = 0.1;
  for (const double true_m : {20.0, kInfinity}) {
    std::vector<int> counts(8, 0);
    int wrong = 0;
    const double reach = std::min(true_m, p.range_max_m);
    for (const double v : measured(p, true_m, true_m, 40'000)) {
      if (v == true_m) continue;
      ++wrong;
      ++counts[std::size_t((v - p.range_min_m) / (reach - p.range_min_m) * 8)];
    }
    expect_share(wrong, 40'000, 0.1);
    // 7 degrees of freedom: 29.9 is passed by chance once in 10,000.
    EXPECT_LT(chi_square(counts, std::vector<double>(8, wrong / 8.0)), 29.9);
  }
}

TEST(ReturnModel, BesideAnEdgeAShareLiesBetweenBothSurfaces) {
  auto p = plain();
  p.edge_share = 0.25;
  p.edge_depth_m = 2.0;
  int between = 0;
  for (const double v : measured(p, 6.0, 4.5, 20'000)) {
    EXPECT_TRUE(v >= 4.5 && v <= 6.0);
    between += v < 6.0 ? 1 : 0;
  }
  expect_share(between, 20'000, 0.25);
  for (const double beside_m : {6.0, 6.01, 3.9, kInfinity}) {
    for (const double v : measured(p, 6.0, beside_m, 200)) EXPECT_EQ(v, 6.0) << beside_m;
  }
  EXPECT_TRUE(measured(p, kInfinity, 6.0, 200).empty()) << "an edge before the sky";
}

TEST(ReturnModel, DirectionsErrByTheAngleNoise) {
  auto p = plain();
  p.angle_noise_rad = 0.0026;
  const ReturnModel model(p);
  Random random(2);
  double squares = 0.0;
  constexpr int kDraws = 10'000;
  for (int i = 0; i < kDraws; ++i) {
    const Vec3 d = random_direction(random);
    const Vec3 reported = model.direction(d, random);
    EXPECT_NEAR(reported.norm(), 1.0, 1e-12);
    squares += (reported - d).squaredNorm();
  }
  // Two axes.
  EXPECT_NEAR(std::sqrt(0.5 * squares / kDraws), 0.0026, 0.0026 * 5.0 / std::sqrt(4.0 * kDraws));
}

}  // namespace
}  // namespace goshawk::sensors
