#include "flight/track_times.hpp"

#include <gtest/gtest.h>

#include "goshawk/core/random.hpp"

namespace goshawk::cli {
namespace {

constexpr std::int64_t kMs = 1'000'000;

TEST(TrackTimes, AreTheStampsOfAClockThatNobodySets) {
  TrackTimes times;
  Random random(1);
  std::int64_t stamp_ns = 5'000'000'000;
  for (int k = 0; k < 1000; ++k) {
    stamp_ns += (k % 100 == 99 ? 700 : 4) * kMs;  // with gaps, which are heard of as well
    EXPECT_EQ(times.time_ns(stamp_ns, stamp_ns + random.below(20) * kMs), stamp_ns);
  }
}

TEST(TrackTimes, GoOnEvenlyWhenTheClockIsSet) {
  TrackTimes times;
  std::int64_t set_by_ns = 0, last_ns = 0;
  for (int k = 0; k < 1000; ++k) {
    if (k == 300) set_by_ns -= 3'000 * kMs;
    if (k == 600) set_by_ns += 5'000 * kMs;
    const std::int64_t at_ns = 10'000 * kMs + k * 4 * kMs;
    const std::int64_t time_ns = times.time_ns(at_ns + set_by_ns, at_ns);
    if (k > 0) {
      EXPECT_EQ(time_ns - last_ns, 4 * kMs) << k;
    }
    last_ns = time_ns;
  }
}

TEST(TrackTimes, NeverGoBackHoweverLittleTheClockIsSetBack) {
  for (const std::int64_t back_ns : {1 * kMs, 5 * kMs, 50 * kMs, 99 * kMs, 2'000 * kMs}) {
    TrackTimes times;
    std::int64_t last_ns = 0;
    for (int k = 0; k < 100; ++k) {
      const std::int64_t at_ns = 10'000 * kMs + k * 4 * kMs;
      const std::int64_t time_ns = times.time_ns(k < 50 ? at_ns : at_ns - back_ns, at_ns);
      EXPECT_GE(time_ns, last_ns) << k;
      last_ns = time_ns;
    }
  }
}

TEST(TrackTimes, StampsThatAreHeardLateOrMuchFasterThanTheyPassAreRight) {
  TrackTimes times;
  for (int k = 0; k < 1000; ++k) {
    // Simulated time, and a reader that sleeps for two seconds in between.
    const std::int64_t heard_ns = k * kMs / 10 + (k > 500 ? 2'000 * kMs : 0);
    EXPECT_EQ(times.time_ns(k * 4 * kMs, heard_ns), k * 4 * kMs);
  }
}

}  // namespace
}  // namespace goshawk::cli
