#pragma once

#include <deque>
#include <functional>
#include <string>

#include "goshawk/simulator/quadrotor.hpp"
#include "goshawk/tracker/tracker.hpp"
#include "trajectories.hpp"

namespace goshawk::tracker {

inline constexpr std::int64_t kSecond = 1'000'000'000;  // [ns]

/// How long odometry takes to come and commands to arrive; drawn anew for each.
struct Link {
  std::int64_t period_ns = 4'000'000;    // of odometry
  std::function<std::int64_t()> gap_ns;  // in place of the period, where set
  std::int64_t odometry_delay_ns = 0;
  std::int64_t command_delay_ns = 4'000'000;   // one step
  std::function<bool()> drop;                  // loses the command, where set
  std::function<void(RigidBodyState&)> spoil;  // changes what odometry says, where set
};

/// Quintics are steep at their ends, so that their hulls reach beyond the tilt that is flown; their
/// curves do not.
inline Config config_for(const std::string& controller) {
  Config config;
  config.controller = controller;
  config.max_tilt_rad = 1.2;
  config.min_thrust_n = 0.5;
  return config;
}

/// Tracker and simulated vehicle, joined by a link with delays. Time in whole milliseconds.
class ClosedLoop {
 public:
  ClosedLoop(const Config& tracker, const simulator::Config& vehicle, Link link = {});

  /// [m] of the vehicle's true position from the trajectory, over a run
  struct Errors {
    double rms_m = 0.0;
    double max_m = 0.0;
    double final_m = 0.0;
  };
  /// The monotonic clock of all: the world's time, and the time that it stood still.
  std::int64_t now_ns() const { return vehicle.time_ns() + paused_ns_; }
  /// Nothing runs for so long, the vehicle's world included: of the pause it lives through world_s.
  /// What is on its way waits in the sockets.
  void stop_everything(double pause_s, double world_s);

  /// Runs until the given time; `each` is called every millisecond.
  void run_until(std::int64_t end_ns, const std::function<void()>& each = {});
  /// Accepts the trajectory, flies it, and `rest_s` beyond its end.
  Errors fly(Draft committed, double rest_s = 1.0);

  simulator::Quadrotor vehicle;
  Tracker tracker;
  Error last_error{ErrorCode::ok, ""};
  int failsafe_ms = 0;
  bool connected = true;  // odometry is taken and commands are sent
  bool watched = true;    // the tracker is told of the time, odometry or not
  /// Until then the tracker's process does not run; its socket keeps what comes first.
  std::int64_t stalled_until_ns = 0;
  Link link;

 private:
  struct Arrival {
    std::int64_t time_ns;
    AttitudeSetpoint command;
  };
  void exchange();
  simulator::Measurement measure();
  void take(const simulator::Measurement& measured, std::int64_t now_ns);
  void give_fallback(std::int64_t now_ns);

  std::int64_t paused_ns_ = 0;
  std::int64_t next_odometry_ns_ = 0;
  std::int64_t next_fallback_ns_ = 0;
  std::uint64_t fallback_for_ = 0;  // the trajectory that the newest is about
  FallbackStop fallback_;
  std::deque<Arrival> arrivals_;
  std::deque<simulator::Measurement> kept_;
};

}  // namespace goshawk::tracker
