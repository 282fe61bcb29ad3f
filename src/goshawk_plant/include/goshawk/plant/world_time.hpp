#pragma once

#include <algorithm>

namespace goshawk::plant {

/// How much time passes in a simulated world. After a pause (a stopped process, a suspended
/// machine) it goes on where it stood, by one period: the world was stopped as well, and nobody
/// could steer in it. A shorter gap is lived through.
/// @param gap_s [s] since the last step @param period_s [s] between steps, > 0
inline double world_time_s(double gap_s, double period_s) {
  constexpr double kPause_s = 0.1;
  return gap_s > std::max(kPause_s, period_s) ? period_s : std::max(gap_s, 0.0);
}

}  // namespace goshawk::plant
