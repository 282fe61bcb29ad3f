#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace goshawk::runtime {

/// A simulation that runs node by node, so that it repeats bit for bit and runs as fast as the
/// computer can (docs/adr/0006-lock-step.md). In each time step the leader advances the clock, runs
/// its own timers, then gives each follower its turn: the follower sets its time, runs its timers,
/// serves all messages, and answers. Two nodes never run at the same time, so everything that one
/// sends has arrived when the next begins.
struct LockStep {
  std::vector<std::string> followers;  // node names, in the order of their turns
  double step_s = 0.004;               // [s] of simulated time, 1e-6 to 1
  double speed = 0.0;  // most simulated seconds per second of real time; 0: no limit
};

/// [ns] Simulated time begins here, because zero means "no time yet" in ROS.
inline constexpr std::int64_t kFirst_ns = 1'000'000'000;

/// "a,b,c" to its names; blanks and empty parts are left out.
std::vector<std::string> split_names(std::string_view names);

}  // namespace goshawk::runtime
