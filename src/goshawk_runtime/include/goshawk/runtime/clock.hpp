#pragma once

#include <cstdint>

namespace goshawk::runtime {

/// Time is an argument: nodes ask their clock, tests give them one of their own.
class Clock {
 public:
  virtual ~Clock() = default;
  /// @return [ns] since 1970-01-01 UTC, or since the simulation began
  virtual std::int64_t now_ns() const = 0;
};

/// The machine's own clock: stamps of processes on one machine compare.
class SystemClock : public Clock {
 public:
  std::int64_t now_ns() const override;
};

/// Stands still until it is set.
class ManualClock : public Clock {
 public:
  std::int64_t now_ns() const override { return now_ns_; }
  void set(std::int64_t now_ns) { now_ns_ = now_ns; }

 private:
  std::int64_t now_ns_ = 0;
};

}  // namespace goshawk::runtime
