#include <fmt/format.h>

#include "goshawk/px4/bridge.hpp"
#include "goshawk/px4/setpoints.hpp"
#include "mode_names.hpp"

// What the bridge does as time passes.

namespace goshawk::px4 {
namespace {

constexpr std::int64_t kMillisecond_ns = 1'000'000;
constexpr std::int64_t kStatusTimeout_ns = 2500 * kMillisecond_ns;  // PX4 sends it at 2 Hz
constexpr std::int64_t kStateTimeout_ns = 200 * kMillisecond_ns;
constexpr std::int64_t kCommandTimeout_ns = 100 * kMillisecond_ns;
constexpr std::int64_t kNobody_ns = 5000 * kMillisecond_ns;
constexpr std::int64_t kStream_ns = 1200 * kMillisecond_ns;  // Offboard wants it for more than 1 s
constexpr std::int64_t kAskEvery_ns = 500 * kMillisecond_ns;
constexpr std::int64_t kArmEvery_ns = 1000 * kMillisecond_ns;
constexpr int kMostAsks = 60;
constexpr double kTrackerTimeout_s = 0.3;
constexpr double kArrived_m = 0.15;
constexpr double kArrived_m_s = 0.15;

}  // namespace

void Bridge::step(std::int64_t now_ns) {
  if (!first_step_ns_) first_step_ns_ = now_ns;
  if (phase_ == Phase::refused) return;
  if (phase_ == Phase::checking) return step_check(now_ns);
  if (config_.mode == ModeKind::external) registration_.step(now_ns, link_);
  watch_silence(now_ns);
  switch (phase_) {
    case Phase::waiting:
      return step_waiting(now_ns);
    case Phase::starting:
      return step_starting(now_ns);
    case Phase::climbing:
      return step_climbing(now_ns);
    case Phase::flying:
      return step_flying(now_ns);
    case Phase::landing:
      return step_landing(now_ns);
    default:
      return;
  }
}

void Bridge::step_check(std::int64_t now_ns) {
  formats_.step(now_ns, link_);
  if (formats_.done()) {
    phase_ = Phase::waiting;
    return say(ErrorCode::ok,
               fmt::format("PX4 speaks the messages of release {}", to_word(config_.release)));
  }
  if (!formats_.unanswered()) return;
  say_once(
      fail(ErrorCode::stage_silent,
           fmt::format("PX4 does not answer what {} is like: does the Micro-XRCE-DDS agent run "
                       "in this domain and namespace, is PX4 connected to it, and is it 1.15 "
                       "or later?",
                       formats_.topic())));
}

void Bridge::watch_silence(std::int64_t now_ns) {
  const std::int64_t since_ns = status_ ? status_ns_ : *first_step_ns_;
  if (now_ns - since_ns <= (status_ ? kStatusTimeout_ns : kNobody_ns)) return;
  say_once(fail(ErrorCode::stage_silent,
                status_
                    ? "PX4 fell silent: is the agent alive, and is PX4 connected to it?"
                    : "PX4 answers, but no vehicle_status comes: set px4_release to the release "
                      "that flies"));
}

Status Bridge::can_fly(std::int64_t now_ns) const {
  if (unfit_) return *unfit_;
  const auto not_yet = [](const std::string& why) { return fail(ErrorCode::not_permitted, why); };
  if (!status_ || now_ns - status_ns_ > kStatusTimeout_ns) {
    return fail(ErrorCode::stage_silent, "no vehicle_status comes from PX4");
  }
  if (status_->vehicle_type != VehicleStatus::kRotary) {
    return not_yet(
        fmt::format("PX4 flies a vehicle of type {}, not a multicopter", status_->vehicle_type));
  }
  if (!has_state(now_ns)) {
    return fail(ErrorCode::tracking_lost,
                unsure_.empty() ? "no vehicle_odometry comes from PX4" : unsure_);
  }
  if (battery_ && battery_->connected && battery_->warning >= BatteryStatus::kCritical) {
    return not_yet("the battery is critical: charge it");
  }
  if (gave_up_) return not_yet("control was given to PX4's Hold: select Goshawk's mode again");
  if (config_.mode == ModeKind::external && !registration_.mode()) {
    return not_yet(registration_.unanswered()
                       ? "PX4 does not answer the registration of the mode Goshawk"
                       : "the mode Goshawk is not registered yet");
  }
  return success();
}

bool Bridge::has_state(std::int64_t now_ns) const {
  return state_ && now_ns - state_ns_ <= kStateTimeout_ns;
}

std::optional<std::uint8_t> Bridge::our_mode() const {
  return config_.mode == ModeKind::offboard ? nav_state::kOffboard : registration_.mode();
}

bool Bridge::mode_is_ours() const {
  const auto ours = our_mode();
  return status_ && ours && status_->nav_state == *ours;
}

void Bridge::step_waiting(std::int64_t now_ns) {
  if (gave_up_) {
    // Without the stream, and with honest answers to arming checks, PX4 leaves the mode even if it
    // misses the command.
    if (!mode_is_ours())
      gave_up_ = false;
    else
      ask(VehicleCommand::kSetNavState, nav_state::kHold, now_ns, kAskEvery_ns);
    return;
  }
  const Status fit = can_fly(now_ns);
  if (!fit) {
    alive_since_ns_.reset();
    if (now_ns - *first_step_ns_ > kNobody_ns) say_seldom(fit.error(), now_ns);
    return;
  }
  send_alive(now_ns);
  if (in_the_air()) {
    started_ = true;  // who flies already is not started
    if (mode_is_ours()) take_control(now_ns);
    return;
  }
  if (config_.takeoff != Takeoff::automatic || started_ || status_->armed()) return;
  const bool streamed = alive_since_ns_ && now_ns - *alive_since_ns_ >= kStream_ns;
  if (config_.mode == ModeKind::offboard && !streamed) return;
  phase_ = Phase::starting;
  asks_ = 0;
}

void Bridge::step_starting(std::int64_t now_ns) {
  if (const Status fit = can_fly(now_ns); !fit) {
    phase_ = Phase::waiting;
    return say_seldom(fit.error(), now_ns);
  }
  send_alive(now_ns);
  const bool offboard = config_.mode == ModeKind::offboard;
  const std::uint8_t mode = offboard ? nav_state::kOffboard : nav_state::kTakeoff;
  if (status_->armed()) {
    track_.hold(*state_);
    track_.climb(config_.takeoff_height_m, now_ns);
    phase_ = Phase::climbing;
    return;
  }
  if (asks_ > kMostAsks) {
    started_ = true;
    phase_ = Phase::waiting;
    return say(ErrorCode::not_permitted,
               "PX4 did not arm: " + reasons() + ". Goshawk does not try again");
  }
  if (status_->nav_state != mode) {
    ask(VehicleCommand::kSetNavState, mode, now_ns, kAskEvery_ns);
  } else {
    ask(VehicleCommand::kArm, 1, now_ns, kArmEvery_ns);
  }
}

void Bridge::step_climbing(std::int64_t now_ns) {
  if (!status_->armed()) {
    started_ = true;
    phase_ = Phase::waiting;
    return say(ErrorCode::not_permitted, "PX4 disarmed before it took off: " + reasons());
  }
  if (config_.mode == ModeKind::external) return step_takeoff_of_px4(now_ns);
  send_alive(now_ns);
  send_setpoint(now_ns);
  if (landed_ || !track_.at_rest(now_ns) || !has_state(now_ns)) return;
  const double off_m = (state_->position_map - track_.at(now_ns).position).norm();
  if (off_m <= kArrived_m && state_->velocity_map.norm() <= kArrived_m_s) take_control(now_ns);
}

// A mode of ours cannot leave the ground: PX4's Takeoff does, and ends in Hold.
void Bridge::step_takeoff_of_px4(std::int64_t now_ns) {
  if (mode_is_ours() && in_the_air()) return take_control(now_ns);
  const auto ours = our_mode();
  if (status_->nav_state == nav_state::kTakeoff) return;
  if (status_->nav_state != nav_state::kHold || !ours) return lose_control();
  ask(VehicleCommand::kSetNavState, *ours, now_ns, kAskEvery_ns);
}

void Bridge::take_control(std::int64_t now_ns) {
  started_ = ready_ = opened_ = true;
  phase_ = Phase::flying;
  tracker_silent_ = false;
  said_.clear();
  track_.hold(*state_);
  registration_.activated();
  say(ErrorCode::ok, "Goshawk flies at " + to_text(state_->position_map) + " m: PX4 is in " +
                         mode_name(status_->nav_state));
  send_setpoint(now_ns);
}

void Bridge::step_flying(std::int64_t now_ns) {
  if (!status_->armed()) {
    phase_ = Phase::waiting;
    return say(ErrorCode::not_permitted, "PX4 disarmed in Goshawk's mode");
  }
  watch_tracker(now_ns);
  if (phase_ != Phase::flying) return;
  const bool down = track_.at(now_ns).position.z() <= config_.land_height_m;
  if (track_.age_s(now_ns) && track_.at_rest(now_ns) && down) {
    phase_ = Phase::landing;
    say(ErrorCode::ok, "the tracker wants to land: PX4's Land mode takes over");
  }
  send_alive(now_ns);
  if (config_.mode == ModeKind::external) registration_.configure(now_ns, link_);
  send_setpoint(now_ns);
}

void Bridge::watch_tracker(std::int64_t now_ns) {
  const auto age_s = track_.age_s(now_ns);
  const bool silent = age_s && *age_s > kTrackerTimeout_s;
  if (silent && !tracker_silent_) {
    say(ErrorCode::stage_silent,
        "the tracker fell silent: what it gave in advance is flown to rest and held");
  }
  tracker_silent_ = silent;
  if (silent && track_.at_rest(now_ns) && *age_s > config_.hand_over_after_s) {
    return give_up_control(
        fail(ErrorCode::stage_silent, fmt::format("the tracker is silent for {:.0f} s", *age_s)));
  }
  // A mode that sends attitudes alone has nothing else to send.
  const bool blind = config_.mode == ModeKind::external &&
                     config_.setpoint == SetpointLevel::attitude && command_ &&
                     now_ns - command_ns_ > kCommandTimeout_ns;
  if (blind) give_up_control(fail(ErrorCode::stage_silent, "the tracker sends no attitude"));
}

void Bridge::step_landing(std::int64_t now_ns) {
  if (!status_->armed()) {
    phase_ = Phase::waiting;
    return say(ErrorCode::ok, "landed and disarmed");
  }
  if (status_->nav_state == nav_state::kLand) return;
  if (!mode_is_ours()) {
    phase_ = Phase::waiting;
    return say(ErrorCode::not_permitted,
               "PX4 does not land, it is in " + mode_name(status_->nav_state));
  }
  send_alive(now_ns);
  send_setpoint(now_ns);
  ask(VehicleCommand::kSetNavState, nav_state::kLand, now_ns, kAskEvery_ns);
}

void Bridge::send_alive(std::int64_t now_ns) {
  if (config_.mode != ModeKind::offboard) return;
  if (!alive_since_ns_) alive_since_ns_ = now_ns;
  OffboardControlMode alive;
  const bool fresh = command_ && now_ns - command_ns_ <= kCommandTimeout_ns;
  const bool attitude =
      config_.setpoint == SetpointLevel::attitude && phase_ == Phase::flying && fresh;
  (attitude ? alive.attitude : alive.position) = true;
  link_.send(alive);
}

void Bridge::send_setpoint(std::int64_t now_ns) {
  const bool fresh = command_ && now_ns - command_ns_ <= kCommandTimeout_ns;
  if (config_.setpoint == SetpointLevel::attitude && phase_ == Phase::flying && fresh) {
    return link_.send(attitude_setpoint(*command_, config_, estimate_.frame()));
  }
  link_.send(trajectory_setpoint(track_.at(now_ns), track_.yaw_rad(), estimate_.frame()));
}

void Bridge::lose_control() {
  phase_ = Phase::waiting;
  started_ = true;
  alive_since_ns_.reset();
  const std::string mode = mode_name(status_->nav_state);
  if (status_->failsafe) {
    return say(ErrorCode::not_permitted,
               fmt::format("PX4's failsafe has the vehicle, in {}: {}. Goshawk flies again if PX4 "
                           "returns to its mode",
                           mode, reasons()));
  }
  say(ErrorCode::not_permitted,
      fmt::format("{}: PX4 is in {}. Goshawk flies again when its mode is selected",
                  sticks_move_ ? "the pilot moved the sticks"
                               : "the pilot or the ground station selected another mode",
                  mode));
}

void Bridge::give_up_control(const Error& why) {
  const bool flies =
      phase_ == Phase::flying || phase_ == Phase::climbing || phase_ == Phase::landing;
  if (!flies) return link_.tell(why);
  gave_up_ = started_ = true;
  phase_ = Phase::waiting;
  alive_since_ns_.reset();
  asked_ns_ = 0;
  link_.tell(fail(why.code, why.message + ": control goes to PX4's own Hold"));
}

// Asks again every period_ns: what counts is what vehicle_status says, not the answer.
void Bridge::ask(std::uint32_t command, float param1, std::int64_t now_ns, std::int64_t period_ns) {
  if (asked_ns_ != 0 && now_ns - asked_ns_ < period_ns) return;
  asked_ns_ = now_ns;
  ++asks_;
  VehicleCommand m;
  m.command = command;
  m.param1 = param1;
  m.target_system = m.source_system = status_->system_id;
  m.target_component = status_->component_id;
  m.source_component = kComponent;
  link_.send(m);
}

}  // namespace goshawk::px4
