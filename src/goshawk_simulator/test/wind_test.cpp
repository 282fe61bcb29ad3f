#include "goshawk/simulator/wind.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace goshawk::simulator {
namespace {

TEST(Wind, IsConstantWithoutGusts) {
  Wind wind({.mean_map = {3.0, -1.0, 0.5}}, 0.001);
  for (int i = 0; i < 100; ++i) wind.step();
  EXPECT_EQ(wind.velocity_map(), Vec3(3.0, -1.0, 0.5));
}

TEST(Wind, GustsHaveTheStatedDeviationAndCorrelationTime) {
  Wind wind({.mean_map = {1, 0, 0}, .gust_deviation_m_s = 0.8, .gust_time_s = 0.5, .seed = 7},
            0.01);
  double sum = 0.0, square = 0.0, product = 0.0;
  Vec3 before = wind.velocity_map();
  const int n = 200000;  // 2000 s: 4000 correlation times
  const int lag = 1;
  for (int i = 0; i < n; ++i) {
    wind.step();
    const Vec3 now = wind.velocity_map();
    sum += now.x();
    square += std::pow(now.x() - 1.0, 2);
    product += (now.x() - 1.0) * (before.x() - 1.0);
    before = now;
  }
  EXPECT_NEAR(sum / n, 1.0, 0.05);
  EXPECT_NEAR(std::sqrt(square / n), 0.8, 0.04);
  EXPECT_NEAR(product / square, std::exp(-lag * 0.01 / 0.5), 0.002);
}

TEST(Wind, TheSameSeedBlowsTheSameBitsAndAnotherSeedOthers) {
  const Wind::Parameters parameters{.gust_deviation_m_s = 1.0, .seed = 42};
  auto other_parameters = parameters;
  other_parameters.seed = 43;
  Wind a(parameters, 0.001), b(parameters, 0.001), c(other_parameters, 0.001);
  for (int i = 0; i < 100; ++i) {
    EXPECT_EQ(a.velocity_map(), b.velocity_map());
    EXPECT_NE(a.velocity_map(), c.velocity_map());
    a.step();
    b.step();
    c.step();
  }
}

TEST(Wind, ThatChangesCarriesItsGustsOnWithoutAJump) {
  Wind wind({.mean_map = {1, 0, 0}, .gust_deviation_m_s = 1.0, .gust_time_s = 0.5}, 0.001);
  for (int i = 0; i < 100; ++i) wind.step();
  const Vec3 gust = wind.velocity_map() - Vec3(1, 0, 0);
  wind.change({0, 2, 0}, 0.0);
  EXPECT_LT((wind.velocity_map() - Vec3(0, 2, 0) - gust).norm(), 1e-12);
  for (int i = 0; i < 500; ++i) wind.step();  // one correlation time
  EXPECT_NEAR((wind.velocity_map() - Vec3(0, 2, 0)).norm(), gust.norm() * std::exp(-1.0), 1e-9);
}

}  // namespace
}  // namespace goshawk::simulator
