#include <algorithm>

#include "goshawk/px4_stand_in/autopilot.hpp"

// Who decides: commands, arming, modes and failsafes.

namespace goshawk::px4_stand_in {

using namespace px4;

namespace {

constexpr std::uint8_t kAccepted = 0, kTemporarilyRejected = 1, kDenied = 2, kUnsupported = 3;
constexpr std::uint8_t kSystem = 1;
constexpr std::int64_t kAfterLanding_ns = 2'000'000'000;     // COM_DISARM_LAND
constexpr std::int64_t kWithoutTakeoff_ns = 11'000'000'000;  // COM_DISARM_PRFLT and 1 s
constexpr int kMostRecoveries = 3;

}  // namespace

void Autopilot::hear(const VehicleCommand& m) {
  if (m.target_system != 0 && m.target_system != kSystem) return;
  if (m.command == VehicleCommand::kSetNavState) return answer(m, select(std::uint8_t(m.param1)));
  if (m.command == VehicleCommand::kArm) return answer(m, arm(m.param1 > 0.5f));
  answer(m, kUnsupported);
}

void Autopilot::answer(const VehicleCommand& m, std::uint8_t result) {
  VehicleCommandAck ack;
  ack.command = m.command;
  ack.result = result;
  ack.target_component = m.source_component;
  wire_->send(ack);
  decide();
}

// Disarmed, any mode is accepted: arming needs its checks.
std::uint8_t Autopilot::select(std::uint8_t mode) {
  constexpr std::array kKnown{nav_state::kPosition, nav_state::kHold, nav_state::kOffboard,
                              nav_state::kTakeoff, nav_state::kLand};
  const bool external = external_.registered() && mode == external_.mode();
  if (!external && std::ranges::find(kKnown, mode) == kKnown.end()) return kDenied;
  if (armed_ && !can_run(mode)) return kTemporarilyRejected;
  intention_ = mode;
  recoveries_ = 0;
  return kAccepted;
}

std::uint8_t Autopilot::arm(bool wanted) {
  if (wanted == armed_) return kAccepted;
  if (!wanted) {
    if (!landed_) return kTemporarilyRejected;
    disarm();
    return kAccepted;
  }
  if (failed_armings_ < config_.failed_armings) {
    ++failed_armings_;
    return kTemporarilyRejected;
  }
  if (!can_run(intention_) || config_.battery < kCriticalCharge) return kTemporarilyRejected;
  armed_ = true;
  flew_ = false;
  armed_ns_ = now_ns_;
  return kAccepted;
}

bool Autopilot::offboard_alive() const {
  if (!offboard_ns_) return false;
  const bool fresh = double(now_ns_ - *offboard_ns_) * 1e-9 < config_.offboard_loss_s;
  const bool any =
      offboard_.position || offboard_.velocity || offboard_.acceleration || offboard_.attitude;
  return fresh && any;
}

bool Autopilot::can_run(std::uint8_t mode) const {
  if (mode == nav_state::kOffboard) return offboard_alive();
  if (mode == external_.mode()) return external_.can_run();
  return true;
}

// The mode that flies: what the user intends, or the failsafe of what cannot run. It goes back by
// itself when the cause is over, but not for ever.
std::uint8_t Autopilot::effective_mode() {
  if (!armed_ || can_run(intention_)) {
    if (failsafe_ && lost_external_ && ++recoveries_ > kMostRecoveries) intention_ = nav_state_;
    failsafe_ = lost_external_ = false;
    return intention_;
  }
  failsafe_ = true;
  if (intention_ == nav_state::kOffboard && config_.offboard_loss_action == LossAction::hold) {
    return nav_state::kHold;
  }
  lost_external_ = intention_ == external_.mode();
  return nav_state::kLand;
}

void Autopilot::decide() {
  if (armed_ && config_.sticks == Sticks::moved) intention_ = nav_state::kPosition;
  if (!armed_ && external_.registered() && !external_.responsive() &&
      intention_ != external_.mode()) {
    external_.remove();
  }
  const std::uint8_t mode = effective_mode();
  if (mode == nav_state_) return;
  nav_state_ = mode;
  activated_ns_ = now_ns_;
  begin_glide();
  climb_to_ned_ = glide_.position.z() - config_.takeoff_height_m;
}

void Autopilot::disarm() {
  armed_ = false;
  lift_ = Lift::off;
}

void Autopilot::disarm_if_done() {
  if (!armed_ || !landed_) return;
  const bool after_landing = flew_ && now_ns_ - landed_ns_ >= kAfterLanding_ns;
  const bool never_left = !flew_ && now_ns_ - armed_ns_ >= kWithoutTakeoff_ns;
  if (after_landing || never_left) disarm();
}

}  // namespace goshawk::px4_stand_in
