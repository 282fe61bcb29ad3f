#include <algorithm>
#include <cmath>
#include <string>

#include "goshawk/px4_stand_in/autopilot.hpp"
#include "goshawk/px4_wire/codec.hpp"
#include "goshawk/px4_wire/frames.hpp"

// What it publishes, and how often.

namespace goshawk::px4_stand_in {

using namespace px4;

namespace {

constexpr double kLow = 0.15, kEmergency = 0.05;
constexpr float kVelocityVariance = 0.01f, kAngleVariance = 0.001f;

template <typename... Messages>
std::optional<std::uint32_t> hash_of(std::string_view topic, Release release) {
  std::optional<std::uint32_t> hash;
  const auto look = [&]<typename Message>(const Message*) {
    if ("/fmu/" + std::string(Message::kTopic) != topic) return;
    if (const auto found = find_definition(Message::kType, release)) hash = found->layout.hash();
  };
  (look(static_cast<const Messages*>(nullptr)), ...);
  return hash;
}

}  // namespace

void Autopilot::hear(const MessageFormatRequest& m) {
  if (m.protocol_version != MessageFormatRequest::kProtocol) return;
  const auto hash =
      hash_of<VehicleStatus, VehicleOdometry, VehicleLocalPosition, VehicleLandDetected,
              BatteryStatus, FailsafeFlags, VehicleCommandAck, VehicleCommand, TrajectorySetpoint,
              VehicleAttitudeSetpoint, OffboardControlMode, RegisterExtComponentRequest,
              RegisterExtComponentReply, ArmingCheckRequest, ArmingCheckReply, VehicleControlMode,
              SetpointConfig, SetpointConfigReply>(text_of(m.topic_name), config_.release);
  MessageFormatResponse response;
  response.topic_name = m.topic_name;
  response.success = hash.has_value();
  response.message_hash = hash.value_or(0);
  wire_->send(response);
}

bool Autopilot::due(Due& what) {
  if (now_ns_ < what.next_ns) return false;
  what.next_ns = std::max(what.next_ns + what.period_ns, now_ns_);
  return true;
}

void Autopilot::report() {
  if (due(sticks_due_)) {
    wire_->send(ManualControlSetpoint{true, config_.sticks == Sticks::moved});
  }
  const VehicleStatus now = status();
  if (due(status_due_) || !(now == said_)) {
    said_ = now;
    wire_->send(now);
  }
  if (due(land_due_) || landed_ != said_landed_) {
    said_landed_ = landed_;
    wire_->send(VehicleLandDetected{landed_});
  }
  if (due(battery_due_)) wire_->send(battery());
  if (due(flags_due_)) {
    FailsafeFlags flags;
    flags.offboard_control_signal_lost = !offboard_alive();
    flags.battery_unhealthy = config_.battery < kCriticalCharge;
    wire_->send(flags);
  }
  if (due(local_due_)) wire_->send(local_position());
  if (due(odometry_due_)) wire_->send(odometry());
}

VehicleStatus Autopilot::status() const {
  VehicleStatus m;
  m.arming_state = armed_ ? VehicleStatus::kArmed : VehicleStatus::kDisarmed;
  m.nav_state = nav_state_;
  m.nav_state_user_intention = intention_;
  m.vehicle_type = VehicleStatus::kRotary;
  m.failsafe = failsafe_;
  m.system_id = m.component_id = 1;
  m.pre_flight_checks_pass = config_.battery >= kCriticalCharge;
  return m;
}

VehicleLocalPosition Autopilot::local_position() const {
  const LocalState state = local();
  VehicleLocalPosition m;
  m.timestamp_sample = stamp_us();
  m.xy_valid = m.z_valid = m.v_xy_valid = m.v_z_valid = m.heading_good_for_control = true;
  m.x = float(state.position.x());
  m.y = float(state.position.y());
  m.z = float(state.position.z());
  m.delta_xy = {float(delta_ned_.x()), float(delta_ned_.y())};
  m.delta_z = float(delta_ned_.z());
  m.delta_heading = float(delta_heading_);
  m.xy_reset_counter = xy_resets_;
  m.z_reset_counter = z_resets_;
  m.heading_reset_counter = heading_resets_;
  m.heading = float(yaw());
  return m;
}

VehicleOdometry Autopilot::odometry() const {
  const LocalState state = local();
  const Eigen::Quaterniond q(state.attitude);
  VehicleOdometry m;
  m.timestamp_sample = stamp_us();
  m.position = to_array(state.position);
  m.q = {float(q.w()), float(q.x()), float(q.y()), float(q.z())};
  m.velocity = to_array(state.velocity);
  m.angular_velocity = to_array(LocalFrame::body(airframe_.state().angular_velocity_base));
  const float variance = float(config_.position_deviation_m * config_.position_deviation_m);
  m.position_variance = {variance, variance, variance};
  m.orientation_variance = {kAngleVariance, kAngleVariance, kAngleVariance};
  m.velocity_variance = {kVelocityVariance, kVelocityVariance, kVelocityVariance};
  m.reset_counter = all_resets_;
  return m;
}

BatteryStatus Autopilot::battery() const {
  BatteryStatus m;
  m.connected = true;
  m.remaining = float(config_.battery);
  m.warning = std::uint8_t(config_.battery < kEmergency        ? 3
                           : config_.battery < kCriticalCharge ? 2
                           : config_.battery < kLow            ? 1
                                                               : 0);
  return m;
}

}  // namespace goshawk::px4_stand_in
