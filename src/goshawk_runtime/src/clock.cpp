#include "goshawk/runtime/clock.hpp"

#include <chrono>

namespace goshawk::runtime {

std::int64_t SystemClock::now_ns() const {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

}  // namespace goshawk::runtime
