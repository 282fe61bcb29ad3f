#pragma once

#include <cstdint>
#include <optional>

namespace goshawk::px4 {

/// Brings PX4's time stamps to our own clock, whatever they count from: microseconds since PX4
/// booted, or since 1970 if the agent's clock was taken over. The fastest message of the last
/// seconds tells the difference of the clocks, as nothing arrives before it was sent.
class Px4Clock {
 public:
  /// @param stamp_us of a message @param received_ns our monotonic clock
  /// @return [ns] of our monotonic clock when it was stamped, never after received_ns
  std::int64_t read(std::uint64_t stamp_us, std::int64_t received_ns);

  /// [s] by which PX4's clock was set since the last call: a restart, or a step of the companion's
  /// clock; nothing if it was not
  std::optional<double> take_step();

 private:
  void begin(std::int64_t offset_ns, std::int64_t received_ns);

  bool started_ = false;
  std::int64_t window_begin_ns_ = 0;
  std::int64_t least_ns_ = 0;       // of this window: received minus stamped
  std::int64_t last_least_ns_ = 0;  // of the one before
  std::optional<double> step_s_;
};

}  // namespace goshawk::px4
