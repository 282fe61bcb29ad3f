#pragma once

#include <cmath>
#include <cstdint>

namespace goshawk::navigator {

inline std::int64_t to_ns(double s) {
  return std::llround(s * 1e9);
}

// Failures that pass by themselves are tried again after this time.
inline constexpr double kRetryDelay_s = 0.2;

}  // namespace goshawk::navigator
