#include "goshawk/px4/bridge.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <stdexcept>
#include <utility>
#include <vector>

#include "mode_names.hpp"

// What the bridge hears, and what follows at once.

namespace goshawk::px4 {

std::string_view to_string(Phase phase) {
  switch (phase) {
    case Phase::checking:
      return "checking";
    case Phase::waiting:
      return "waiting";
    case Phase::starting:
      return "starting";
    case Phase::climbing:
      return "climbing";
    case Phase::flying:
      return "flying";
    case Phase::landing:
      return "landing";
    case Phase::refused:
      return "refused";
  }
  throw std::logic_error("to_string() of no Phase");
}

Bridge::Bridge(const Config& config, Link& link, std::uint64_t seed)
    : config_(config),
      link_(link),
      formats_(config),
      registration_(config, seed),
      estimate_(config),
      track_(config_) {}

void Bridge::hear(const MessageFormatResponse& m) {
  if (phase_ != Phase::checking) return;
  if (const Status status = formats_.hear(m); !status) {
    phase_ = Phase::refused;
    link_.tell(status.error());
  }
}

void Bridge::hear(const VehicleStatus& m, std::int64_t now_ns) {
  status_ = m;
  status_ns_ = now_ns;
  const bool climbs = phase_ == Phase::climbing && config_.mode == ModeKind::offboard;
  if ((phase_ == Phase::flying || climbs) && !mode_is_ours()) lose_control();
}

void Bridge::hear(const BatteryStatus& m) {
  const auto before = std::exchange(battery_, m);
  const int last = before ? before->warning : 0;
  if (m.connected && m.warning > last) {
    say(ErrorCode::tracking_lost,
        fmt::format("PX4 warns of the battery: {}, {:.0f} % left; {}",
                    m.warning == BatteryStatus::kLow ? "low" : "critical", 100.0 * m.remaining,
                    m.warning == BatteryStatus::kLow
                        ? "land soon"
                        : "Goshawk does not start; in the air PX4's COM_LOW_BAT_ACT decides"));
  }
}

void Bridge::hear(const VehicleCommandAck& m) {
  constexpr std::uint8_t kAccepted = 0, kInProgress = 5;
  if (m.target_component != kComponent || m.result == kAccepted || m.result == kInProgress) return;
  say_once(fail(
      ErrorCode::not_permitted,
      fmt::format("PX4 rejects {} (result {}): {}", command_name(m.command), m.result, reasons())));
}

void Bridge::hear(const VehicleLocalPosition& m, std::int64_t) {
  const auto reset = estimate_.hear(m);
  if (!reset) {
    unfit_ = reset.error();
    return give_up_control(*unfit_);
  }
  if (!*reset) return;
  const auto& [position_m, heading_rad] = **reset;
  const std::string what =
      fmt::format("PX4 reset its estimate by {:.2g} m and {:.2g} rad", position_m, heading_rad);
  if (position_m > config_.max_reset_m || heading_rad > config_.max_heading_reset_rad) {
    give_up_control(fail(ErrorCode::tracking_lost,
                         what +
                             ", more than max_reset_m or max_heading_reset_rad: the map may not be "
                             "where PX4 says. Check the position source"));
  } else {
    say(ErrorCode::ok, what + ": its frame moves in the map, the flight goes on");
  }
}

std::optional<TimedState> Bridge::hear(const VehicleOdometry& m, std::int64_t now_ns) {
  const std::int64_t time_ns = clock_.read(m.timestamp_sample, now_ns);
  if (const auto step_s = clock_.take_step()) {
    say(ErrorCode::clock_set,
        fmt::format(
            "PX4's clock was set by {:.3g} s: it restarted, or the companion's clock was set",
            *step_s));
  }
  const auto state = estimate_.hear(m);
  if (!state) {
    unsure_ = state.error().message;
    say_seldom(state.error(), now_ns);
    return {};
  }
  unsure_.clear();
  state_ = *state;
  state_ns_ = now_ns;
  const bool starts = phase_ == Phase::starting || phase_ == Phase::climbing;
  if (in_the_air() && !starts) opened_ = true;
  if (!opened_ || unfit_ || phase_ == Phase::refused) return {};
  return TimedState{*state, time_ns};
}

void Bridge::hear(const RegisterExtComponentReply& m, std::int64_t now_ns) {
  if (config_.mode != ModeKind::external) return;
  if (const Status status = registration_.hear(m, now_ns); !status) say_once(status.error());
}

void Bridge::hear(const ArmingCheckRequest& m, std::int64_t now_ns) {
  registration_.hear(m, can_fly(now_ns).ok(), now_ns, link_);
}

void Bridge::hear(const AttitudeSetpoint& command, std::int64_t now_ns) {
  command_ = command;
  command_ns_ = now_ns;
  if (phase_ != Phase::flying) return;
  track_.turn_to(yaw_of(command.q_map_base));
  if (config_.setpoint == SetpointLevel::attitude) send_setpoint(now_ns);
}

void Bridge::hear(FallbackStop stop, std::int64_t now_ns) {
  if (phase_ != Phase::flying || !has_state(now_ns)) return;
  if (const Status status = track_.offer(std::move(stop), *state_, now_ns); !status) {
    say_seldom(status.error(), now_ns);
  }
}

std::optional<double> Bridge::battery() const {
  if (!battery_ || !battery_->connected) return {};
  return battery_->remaining;
}

std::optional<double> Bridge::command_age_s(std::int64_t now_ns) const {
  if (!command_) return {};
  return double(now_ns - command_ns_) * 1e-9;
}

InCharge Bridge::in_charge() const {
  if (!status_ || !status_->armed()) return InCharge::nobody;
  if (mode_is_ours()) return InCharge::goshawk;
  return is_flown_by_hand(status_->nav_state) ? InCharge::pilot : InCharge::autopilot;
}

std::string Bridge::reasons() const {
  std::vector<std::string_view> why;
  if (flags_.attitude_invalid) why.push_back("attitude invalid");
  if (flags_.local_position_invalid) why.push_back("local position invalid");
  if (flags_.local_velocity_invalid) why.push_back("local velocity invalid");
  if (flags_.offboard_control_signal_lost) why.push_back("no Offboard signal");
  if (flags_.manual_control_signal_lost) why.push_back("no remote control");
  if (flags_.battery_unhealthy) why.push_back("battery unhealthy");
  if (flags_.geofence_breached) why.push_back("geofence breached");
  if (flags_.fd_critical_failure) why.push_back("failure detected");
  if (why.empty()) return "the ground station shows why";
  return fmt::format("PX4 says: {}", fmt::join(why, ", "));
}

void Bridge::say(ErrorCode code, const std::string& sentence) {
  link_.tell(fail(code, sentence));
}

// Of what comes at a hundred times a second, with other numbers each time.
void Bridge::say_seldom(const Error& fault, std::int64_t now_ns) {
  constexpr std::int64_t kSeldom_ns = 1'000'000'000;
  if (seldom_ns_ && now_ns - *seldom_ns_ < kSeldom_ns) return;
  if (fault.message != said_) seldom_ns_ = now_ns;
  say_once(fault);
}

// What is the case for many messages is said when it begins.
void Bridge::say_once(const Error& fault) {
  if (fault.message == said_) return;
  said_ = fault.message;
  link_.tell(fault);
}

}  // namespace goshawk::px4
