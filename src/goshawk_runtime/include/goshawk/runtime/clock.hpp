#pragma once

#include <cstdint>

namespace goshawk::runtime {

/// Time is an argument: nodes ask their clock, tests give them one of their own.
class Clock {
 public:
  virtual ~Clock() = default;
  /// For stamps: time servers and people set this clock, so two readings tell no duration.
  /// @return [ns] since 1970-01-01 UTC, or since the simulation began
  virtual std::int64_t now_ns() const = 0;
  /// For durations: never set, and runs on while the machine is suspended.
  /// @return [ns] since an arbitrary moment; the same for all processes of a machine
  virtual std::int64_t monotonic_ns() const = 0;
};

/// The machine's own clocks: stamps of processes on one machine compare.
class SystemClock : public Clock {
 public:
  std::int64_t now_ns() const override;
  std::int64_t monotonic_ns() const override;
};

/// Stands still until it is set.
class ManualClock : public Clock {
 public:
  std::int64_t now_ns() const override { return now_ns_; }
  std::int64_t monotonic_ns() const override { return monotonic_ns_; }
  void set(std::int64_t now_ns) { now_ns_ = monotonic_ns_ = now_ns; }
  /// Time passes.
  void advance(std::int64_t by_ns) { now_ns_ += by_ns, monotonic_ns_ += by_ns; }
  /// A time server sets the clock: no time passes.
  void step_wall_clock(std::int64_t by_ns) { now_ns_ += by_ns; }

 private:
  std::int64_t now_ns_ = 0;
  std::int64_t monotonic_ns_ = 0;
};

}  // namespace goshawk::runtime
