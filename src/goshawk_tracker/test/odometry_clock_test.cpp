#include "goshawk/tracker/odometry_clock.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "goshawk/core/random.hpp"

namespace goshawk::tracker {
namespace {

constexpr std::int64_t kMs = 1'000'000;
constexpr std::int64_t kWall = 1'700'000'000'000 * kMs;  // what the wall clock says at zero

/// Odometry every 4 ms that takes 1 ms to arrive and is `delay_ms` old when it is sent.
struct Source {
  explicit Source(std::int64_t delay_ms = 0) : delay_ns(delay_ms * kMs) {}

  /// @return [ms] how old the reading says it is when it arrives
  double next(std::int64_t late_ms = 0) {
    now += 4 * kMs;
    return at(now, late_ms);
  }
  double at(std::int64_t made_ns, std::int64_t late_ms = 0) {
    const std::int64_t arrival = made_ns + delay_ns + (1 + late_ms) * kMs;
    const auto reading = clock.read(made_ns + kWall + sender_ns, arrival + kWall + own_ns, arrival);
    set_by_s = reading.set_by_s;
    return double(arrival - reading.time_ns) / kMs;
  }

  OdometryClock clock{0.1};
  std::int64_t delay_ns;
  std::int64_t now = 0;
  std::int64_t sender_ns = 0;  // by how much the sender's wall clock was set
  std::int64_t own_ns = 0;
  double set_by_s = 0.0;
};

TEST(OdometryClock, TellsTheAgeWhileNobodySetsAClock) {
  for (const int delay_ms : {0, 20, 60}) {
    Source source(delay_ms);
    Random random(1);
    for (int i = 0; i < 500; ++i) {
      const auto late = std::int64_t(random.below(3));
      EXPECT_NEAR(source.next(late), double(delay_ms + 1 + late), 1e-9);
      EXPECT_EQ(source.set_by_s, 0.0);
    }
  }
}

TEST(OdometryClock, AStepOfEitherClockOrOfBothDoesNotChangeTheAgeAndIsTold) {
  for (const double step_s : {-5.0, -0.3, -0.05, 0.05, 0.3, 5.0}) {
    for (const int who : {1, 2, 3}) {  // the sender's, the tracker's, both
      Source source(20);
      for (int i = 0; i < 100; ++i) source.next();
      const auto step_ns = std::llround(step_s * 1e9);
      if (who & 1) source.sender_ns = step_ns;
      if (who & 2) source.own_ns = step_ns;
      double told_s = 0.0;
      for (int i = 0; i < 100; ++i) {
        EXPECT_NEAR(source.next(), 21.0, 1e-6) << step_s << " " << who;
        told_s += source.set_by_s;
      }
      EXPECT_NEAR(told_s, who & 1 ? step_s : 0.0, 1e-6);
    }
  }
}

TEST(OdometryClock, WhatWasHeldUpIsAsOldAsItIs) {
  Source source;
  for (int i = 0; i < 100; ++i) source.next();
  // Four seconds of a stopped process: what its socket kept, then what is new.
  const std::int64_t stopped = source.now;
  for (int i = 1; i <= 50; ++i) {
    const std::int64_t made = stopped + 4 * i * kMs;
    EXPECT_NEAR(source.at(made, 4000 - 4 * i), double(4001 - 4 * i), 1e-6);
  }
  source.now = stopped + 4000 * kMs;
  EXPECT_NEAR(source.next(), 1.0, 1e-6);
  EXPECT_EQ(source.set_by_s, 0.0);
}

TEST(OdometryClock, AStepOfBothClocksInAPauseIsNoDelay) {
  Source source;
  for (int i = 0; i < 100; ++i) source.next();
  source.now += 2000 * kMs;
  source.sender_ns = source.own_ns = -1500 * kMs;
  EXPECT_NEAR(source.next(), 1.0, 1e-6);
  EXPECT_NEAR(source.set_by_s, -1.5, 1e-6);
}

TEST(OdometryClock, HostsWhoseClocksDisagreeAreTakenByDifferences) {
  for (const std::int64_t skew_ms : {-3000, 3000}) {
    Source source;
    source.sender_ns = skew_ms * kMs;
    EXPECT_NEAR(source.next(), 0.0, 1e-6);
    EXPECT_NEAR(source.next(7), 7.0, 1e-6);
    EXPECT_NEAR(source.next(), 0.0, 1e-6);
  }
}

}  // namespace
}  // namespace goshawk::tracker
