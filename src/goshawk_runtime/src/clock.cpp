#include "goshawk/runtime/clock.hpp"

#include <time.h>

#include <chrono>

namespace goshawk::runtime {

std::int64_t SystemClock::now_ns() const {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

// CLOCK_BOOTTIME, not CLOCK_MONOTONIC: that one stands still while the machine is suspended, and a
// vehicle does not.
std::int64_t SystemClock::monotonic_ns() const {
  timespec t{};
  clock_gettime(CLOCK_BOOTTIME, &t);
  return std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec;
}

}  // namespace goshawk::runtime
