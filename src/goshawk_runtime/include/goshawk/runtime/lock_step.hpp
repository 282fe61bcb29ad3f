#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace goshawk::runtime {

/// A simulation that runs node by node, so that it repeats bit for bit and as fast as the computer
/// can (docs/adr/0006-lock-step.md). For each step of time the leader advances the clock, does what
/// is due, then gives every follower its turn, one after another: the follower sees the new time,
/// runs its timers, takes every message that has come, and answers. No two of them ever run at
/// once, so whatever one has sent is there when the next begins.
struct LockStep {
  std::vector<std::string> followers;  // node names, in the order of their turns
  double step_s = 0.004;               // [s] of simulated time, 1e-6 to 1
  double speed = 0.0;                  // simulated time for the machine's, at most; 0: no limit
};

/// [ns] where simulated time begins: zero means "no time yet" in ROS.
inline constexpr std::int64_t kFirst_ns = 1'000'000'000;

/// "a,b,c" to its names; blanks and empty parts are left out.
std::vector<std::string> split_names(std::string_view names);

}  // namespace goshawk::runtime
