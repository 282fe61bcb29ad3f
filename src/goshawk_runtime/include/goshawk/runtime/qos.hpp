#pragma once

namespace goshawk::runtime {

/// The few qualities of service that the topics use (docs/interfaces.md).
struct Qos {
  bool reliable = true;
  bool transient_local = false;  // a late subscriber gets the last `depth` samples
  int depth = 10;                // samples kept; the newest push the oldest out

  static constexpr Qos reliable_last(int depth = 10) { return {true, false, depth}; }
  /// Offered for what a newer message replaces: ROS 2's readers mostly ask for reliable, and the
  /// depth of one keeps the writer from waiting for them.
  static constexpr Qos state() { return reliable_last(1); }
  static constexpr Qos latched(int depth = 1) { return {true, true, depth}; }
  static constexpr Qos best_effort(int depth = 1) { return {false, false, depth}; }
};

}  // namespace goshawk::runtime
