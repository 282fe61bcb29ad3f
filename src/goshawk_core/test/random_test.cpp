#include "goshawk/core/random.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <set>

namespace goshawk {
namespace {

TEST(Random, GivesTheNumbersOfThePublishedAlgorithm) {
  // First outputs of SplitMix64 for the seed 1234567, as its reference code prints them.
  Random random(1234567);
  for (const std::uint64_t expected :
       {6457827717110365317ULL, 3203168211198807973ULL, 9817491932198370423ULL,
        4593380528125082431ULL, 16408922859458223821ULL}) {
    EXPECT_EQ(random.next(), expected);
  }
}

TEST(Random, RepeatsForASeedAndDiffersBetweenSeeds) {
  std::set<std::uint64_t> first_numbers;
  for (std::uint64_t seed = 0; seed < 1000; ++seed) {
    Random a(seed);
    Random b(seed);
    for (int i = 0; i < 10; ++i) ASSERT_EQ(a.next(), b.next());
    first_numbers.insert(Random(seed).next());
  }
  EXPECT_EQ(first_numbers.size(), 1000U);
}

TEST(Random, UniformStaysInItsIntervalAndHasItsMoments) {
  Random random(3);
  double sum = 0.0;
  double squares = 0.0;
  constexpr int n = 200000;
  for (int i = 0; i < n; ++i) {
    const double value = random.uniform();
    ASSERT_GE(value, 0.0);
    ASSERT_LT(value, 1.0);
    ASSERT_EQ(std::ldexp(value, 53), std::floor(std::ldexp(value, 53)));
    sum += value;
    squares += value * value;
  }
  EXPECT_NEAR(sum / n, 0.5, 5.0 * std::sqrt(1.0 / 12.0 / n));
  EXPECT_NEAR(squares / n, 1.0 / 3.0, 5.0 * std::sqrt(4.0 / 45.0 / n));
  for (int i = 0; i < 1000; ++i) {
    const double value = random.uniform(-3.0, -2.0);
    ASSERT_GE(value, -3.0);
    ASSERT_LE(value, -2.0);
  }
}

TEST(Random, BelowGivesEveryNumberEquallyOften) {
  Random random(4);
  constexpr int n = 70000;
  std::array<int, 7> counts{};
  for (int i = 0; i < n; ++i) {
    const int value = random.below(7);
    ASSERT_GE(value, 0);
    ASSERT_LT(value, 7);
    ++counts[std::size_t(value)];
  }
  double chi_squared = 0.0;
  for (const int count : counts) chi_squared += std::pow(count - n / 7.0, 2) / (n / 7.0);
  EXPECT_LT(chi_squared, 22.46);  // 99.9 % point for 6 degrees of freedom
  for (int i = 0; i < 100; ++i) EXPECT_EQ(random.below(1), 0);
  for (int i = 0; i < 1000; ++i) ASSERT_GE(random.below(2147483647), 0);
}

TEST(Random, ChanceIsCertainAtItsEnds) {
  Random random(5);
  int hits = 0;
  for (int i = 0; i < 10000; ++i) {
    ASSERT_FALSE(random.chance(0.0));
    ASSERT_TRUE(random.chance(1.0));
    hits += random.chance(0.25) ? 1 : 0;
  }
  EXPECT_NEAR(hits, 2500, 5.0 * std::sqrt(10000 * 0.25 * 0.75));
}

}  // namespace
}  // namespace goshawk
