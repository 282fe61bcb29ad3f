#pragma once

#include <cstdint>
#include <cstdio>
#include <string>

namespace goshawk::tracker {

/// Beyond this no clock goes, and differences do not overflow.
inline constexpr std::int64_t kTimeBound_ns = 4'000'000'000'000'000'000;

inline bool within_bound(std::int64_t time_ns) {
  return time_ns >= -kTimeBound_ns && time_ns <= kTimeBound_ns;
}

inline double seconds(std::int64_t from_ns, std::int64_t to_ns) {
  return double(to_ns - from_ns) * 1e-9;
}

/// For sentences: three digits.
inline std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

}  // namespace goshawk::tracker
