#include "goshawk/px4/px4_clock.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

#include "goshawk/core/random.hpp"

namespace goshawk::px4 {
namespace {

constexpr std::int64_t kMilli_ns = 1'000'000;

TEST(Px4Clock, TheFastestMessageTellsTheDifferenceOfTheClocks) {
  Px4Clock clock;
  Random random(7);
  const std::int64_t booted_ns = 987'654'321'000;  // PX4's zero on our clock
  std::int64_t latest_error_ns = 0;
  for (int i = 0; i < 1000; ++i) {
    const std::int64_t made_ns = booted_ns + i * 10 * kMilli_ns;
    const auto delay_ns = std::int64_t(random.uniform(1.0, 9.0) * double(kMilli_ns));
    const std::int64_t read =
        clock.read(std::uint64_t(made_ns - booted_ns) / 1000, made_ns + delay_ns);
    latest_error_ns = read - made_ns;
    EXPECT_LE(read, made_ns + delay_ns);
  }
  // What stays is the least delay, 1 ms.
  EXPECT_LT(std::abs(latest_error_ns - kMilli_ns), kMilli_ns / 4);
  EXPECT_FALSE(clock.take_step());
}

TEST(Px4Clock, ARestartOfPx4IsAStep) {
  Px4Clock clock;
  clock.read(500'000'000, 1000 * kMilli_ns);
  EXPECT_FALSE(clock.take_step());
  EXPECT_EQ(clock.read(1000, 2000 * kMilli_ns), 2000 * kMilli_ns);
  const auto step = clock.take_step();
  ASSERT_TRUE(step);
  EXPECT_LT(*step, -400.0);
  EXPECT_FALSE(clock.take_step());
}

TEST(Px4Clock, DriftOfTheClocksIsFollowed) {
  Px4Clock clock;
  std::int64_t error_ns = 0;
  for (int i = 0; i < 6000; ++i) {  // a minute; PX4's clock is slower by 50 ppm
    const std::int64_t now_ns = i * 10 * kMilli_ns;
    const auto stamp_us = std::uint64_t(double(now_ns) * (1.0 - 50e-6) / 1000.0);
    error_ns = clock.read(stamp_us, now_ns) - now_ns;
  }
  EXPECT_LT(std::abs(error_ns), kMilli_ns);
}

}  // namespace
}  // namespace goshawk::px4
