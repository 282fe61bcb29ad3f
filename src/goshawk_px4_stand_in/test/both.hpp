#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "goshawk/px4/bridge.hpp"
#include "goshawk/px4_stand_in/autopilot.hpp"

namespace goshawk::px4_stand_in {

/// The bridge and the stand-in in one thread and simulated time, each message delivered within the
/// step, and a tracker that flies back and forth along x.
class Both {
 public:
  Both(const px4::Config& bridge, const Config& autopilot);
  ~Both();

  /// Lets time pass. @param each called after each step of 4 ms
  void run(double seconds, const std::function<void()>& each = {});
  /// Until the condition holds. @return whether it did within most_s
  bool run_until(const std::function<bool()>& condition, double most_s);

  /// Our processes, one by one: a bridge that does not run hears and sends nothing.
  bool bridge_runs = true;
  bool tracker_runs = false;
  /// As a supervisor does: a new process that knows nothing.
  void restart_bridge();

  px4::Bridge& bridge() { return *bridge_; }
  Autopilot& autopilot() { return *autopilot_; }
  /// Where the tracker wants the vehicle now.
  FlatState reference() const;
  bool told_of(const std::string& words) const;
  /// The vehicle's state as the stages have it.
  const std::optional<px4::TimedState>& given() const { return given_; }
  double now_s() const { return double(now_ns_) * 1e-9; }

  /// The way back and forth: its length and its largest speed.
  double length_m = 1.0, speed_m_s = 0.45;

 private:
  struct Pipes;
  FallbackStop fallback() const;
  void track();

  px4::Config bridge_config_;
  std::unique_ptr<Pipes> pipes_;
  std::unique_ptr<Autopilot> autopilot_;
  std::unique_ptr<px4::Bridge> bridge_;
  std::int64_t now_ns_ = 5'000'000'000;
  std::int64_t track_begin_ns_ = 0;
  std::optional<Vec3> track_from_;
  std::optional<px4::TimedState> given_;
  std::uint64_t seed_ = 1;
};

}  // namespace goshawk::px4_stand_in
