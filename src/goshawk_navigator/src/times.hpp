#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace goshawk::navigator {

inline std::int64_t to_ns(double s) {
  return std::llround(s * 1e9);
}

// Failures that pass by themselves are tried again after this time.
inline constexpr double kRetryDelay_s = 0.2;

// No way to rest was found on what is flown: again after this time.
inline constexpr double kBrakeAgain_s = 0.1;

/// [s] after so many trajectories in a row that the tracker did not fly: longer each time, so that
/// five attempts span 4.6 s. A tracker that has not heard yet that the navigator's clock was set
/// refuses all of them for a while.
inline double pause_s(int failures) {
  constexpr double kGrowth = 3.0, kLongest_s = 2.0;
  return std::min(kLongest_s, kRetryDelay_s * std::pow(kGrowth, failures - 1));
}

/// [s] by which a plan from rest begins later, after so many trajectories in a row that the tracker
/// did not fly: they may have come too late, over a network that loses packets.
inline double longer_lead_s(int failures) {
  constexpr double kLonger_s = 0.3;
  return kLonger_s * failures;
}

}  // namespace goshawk::navigator
