#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "goshawk/px4/estimate.hpp"
#include "goshawk/px4/format_check.hpp"
#include "goshawk/px4/px4_clock.hpp"
#include "goshawk/px4/reference_track.hpp"
#include "goshawk/px4/registration.hpp"

namespace goshawk::px4 {

/// What the bridge does.
enum class Phase {
  checking,  // PX4 is not heard, or its messages are not compared yet
  waiting,   // Goshawk does not fly: disarmed, on the ground, or PX4 or a pilot flies
  starting,  // selects the mode and arms
  climbing,  // the automatic takeoff
  flying,    // PX4 follows Goshawk's setpoints
  landing,   // PX4's own landing, at Goshawk's wish
  refused    // for good: formats that do not fit
};
std::string_view to_string(Phase phase);

/// Who has the vehicle.
enum class InCharge { nobody, goshawk, pilot, autopilot };

struct TimedState {
  RigidBodyState state;
  std::int64_t time_ns = 0;  // [ns] of our monotonic clock, when it was true
};

/// Flies with PX4: gives it setpoints while it is in Goshawk's mode, and its odometry to the
/// stages. PX4, the pilot and the ground station decide about the mode at any time; Goshawk
/// notices, says so, and never takes control back by itself. Time is an argument: our monotonic
/// clock. It keeps references to the link, and cannot be moved.
///
///     bridge.hear(status, now_ns);                     // whatever PX4 sends
///     if (auto state = bridge.hear(odometry, now_ns)) publish(*state);
///     bridge.hear(command, now_ns); bridge.hear(fallback_stop, now_ns);   // the tracker
///     bridge.step(now_ns);                             // 50 times a second
class Bridge {
 public:
  /// @pre check(config) ok @param seed another one for each process
  Bridge(const Config& config, Link& link, std::uint64_t seed);
  Bridge(const Bridge&) = delete;
  Bridge& operator=(const Bridge&) = delete;

  void hear(const MessageFormatResponse& m);
  void hear(const VehicleStatus& m, std::int64_t now_ns);
  void hear(const VehicleLandDetected& m) { landed_ = m.landed; }
  void hear(const BatteryStatus& m);
  void hear(const FailsafeFlags& m) { flags_ = m; }
  void hear(const ManualControlSetpoint& m) { sticks_move_ = m.valid && m.sticks_moving; }
  void hear(const VehicleCommandAck& m);
  void hear(const VehicleLocalPosition& m, std::int64_t now_ns);
  /// @return the vehicle's state for the stages: once it has been in the air, and while it is sure
  std::optional<TimedState> hear(const VehicleOdometry& m, std::int64_t now_ns);
  void hear(const RegisterExtComponentReply& m, std::int64_t now_ns);
  void hear(const ArmingCheckRequest& m, std::int64_t now_ns);
  void hear(const SetpointConfigReply& m) { registration_.hear(m); }

  /// The tracker's.
  void hear(const AttitudeSetpoint& command, std::int64_t now_ns);
  void hear(FallbackStop stop, std::int64_t now_ns);

  /// Sends what PX4 must hear now, at 50 Hz.
  void step(std::int64_t now_ns);

  Phase phase() const { return phase_; }
  /// Hovers under Goshawk's control for the first time: the stages may plan.
  bool ready() const { return ready_; }
  InCharge in_charge() const;
  const std::optional<VehicleStatus>& status() const { return status_; }
  std::uint32_t resets() const { return estimate_.resets(); }
  /// 0 to 1; nothing: not known
  std::optional<double> battery() const;
  /// [s] of the tracker's newest command; nothing: none came
  std::optional<double> command_age_s(std::int64_t now_ns) const;

 private:
  bool has_state(std::int64_t now_ns) const;
  bool in_the_air() const { return status_ && status_->armed() && !landed_; }
  bool mode_is_ours() const;
  std::optional<std::uint8_t> our_mode() const;
  Status can_fly(std::int64_t now_ns) const;
  std::string reasons() const;

  void step_check(std::int64_t now_ns);
  void step_waiting(std::int64_t now_ns);
  void step_starting(std::int64_t now_ns);
  void step_climbing(std::int64_t now_ns);
  void step_flying(std::int64_t now_ns);
  void step_landing(std::int64_t now_ns);
  void step_takeoff_of_px4(std::int64_t now_ns);
  void watch_silence(std::int64_t now_ns);
  void watch_tracker(std::int64_t now_ns);
  void send_alive(std::int64_t now_ns);
  void send_setpoint(std::int64_t now_ns);
  void take_control(std::int64_t now_ns);
  void lose_control();
  void give_up_control(const Error& why);
  void ask(std::uint32_t command, float param1, std::int64_t now_ns, std::int64_t period_ns);
  void say(ErrorCode code, const std::string& sentence);
  void say_once(const Error& fault);
  void say_seldom(const Error& fault, std::int64_t now_ns);

  Config config_;
  Link& link_;
  FormatCheck formats_;
  Registration registration_;
  Estimate estimate_;
  ReferenceTrack track_;
  Px4Clock clock_;

  Phase phase_ = Phase::checking;
  bool started_ = false;  // the automatic takeoff is over, or somebody else flew
  bool opened_ = false;   // odometry goes to the stages
  bool ready_ = false;
  bool gave_up_ = false;  // control is given to PX4's Hold until somebody selects our mode again
  bool landed_ = true;
  bool sticks_move_ = false;
  bool tracker_silent_ = false;
  std::optional<Error> unfit_;  // why Goshawk never flies again: its frame is lost
  std::optional<VehicleStatus> status_;
  std::int64_t status_ns_ = 0;
  std::optional<RigidBodyState> state_;
  std::int64_t state_ns_ = 0;
  std::optional<BatteryStatus> battery_;
  FailsafeFlags flags_;
  std::optional<AttitudeSetpoint> command_;
  std::int64_t command_ns_ = 0;
  std::optional<std::int64_t> first_step_ns_;
  std::optional<std::int64_t> alive_since_ns_;  // the stream that Offboard needs
  std::int64_t asked_ns_ = 0;                   // the last command to PX4
  int asks_ = 0;
  std::string said_;
  std::optional<std::int64_t> seldom_ns_;  // when say_seldom() last said something
  std::string unsure_;                     // why the newest odometry was not used; empty: it was
};

}  // namespace goshawk::px4
