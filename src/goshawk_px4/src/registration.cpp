#include "goshawk/px4/registration.hpp"

#include <fmt/format.h>

#include "goshawk/px4_wire/codec.hpp"

namespace goshawk::px4 {
namespace {

constexpr std::string_view kName = "Goshawk";
constexpr std::int64_t kAskAgain_ns = 1'000'000'000;
constexpr std::int64_t kForgotten_ns = 4'000'000'000;
constexpr std::int64_t kConfigure_ns = 100'000'000;
constexpr int kRepeat = 5;  // before 1.18 nobody confirms

}  // namespace

Registration::Registration(const Config& config, std::uint64_t seed)
    : release_(config.release),
      setpoint_type_(config.setpoint == SetpointLevel::trajectory ? SetpointConfig::kTrajectory
                                                                  : SetpointConfig::kAttitude),
      request_id_(seed) {}

void Registration::step(std::int64_t now_ns, Link& link) {
  if (mode_ && now_ns - heard_ns_ > kForgotten_ns) forget();
  if (mode_ || (asked_ns_ && now_ns - *asked_ns_ < kAskAgain_ns)) return;
  asked_ns_ = now_ns;
  ++tries_;
  RegisterExtComponentRequest request;
  request.request_id = ++request_id_;
  request.name = characters_of<25>(kName);
  request.px4_ros2_api_version = release_ >= Release::v1_18 ? 2 : 1;
  link.send(request);
}

Status Registration::hear(const RegisterExtComponentReply& reply, std::int64_t now_ns) {
  if (mode_ || reply.request_id != request_id_ || text_of(reply.name) != kName) return success();
  if (!reply.success || reply.mode_id < int(nav_state::kExternal1) ||
      reply.mode_id > int(nav_state::kExternal8)) {
    return fail(
        ErrorCode::not_permitted,
        "PX4 refuses to register the mode Goshawk: it is armed, or its eight slots are full; "
        "disarm it, or stop other programs that bring modes");
  }
  mode_ = std::uint8_t(reply.mode_id);
  check_id_ = std::uint8_t(reply.arming_check_id);
  heard_ns_ = now_ns;
  configured_ = false;
  return success();
}

void Registration::hear(const ArmingCheckRequest& request, bool can_run, std::int64_t now_ns,
                        Link& link) {
  if (!mode_) return;
  if ((request.valid_registrations_mask >> check_id_ & 1u) == 0) return forget();
  heard_ns_ = now_ns;
  ArmingCheckReply reply;
  reply.request_id = request.request_id;
  reply.registration_id = check_id_;
  reply.can_arm_and_run = can_run;
  link.send(reply);
}

void Registration::hear(const SetpointConfigReply& reply) {
  if (mode_ && reply.source_id == *mode_ && reply.type == setpoint_type_ && reply.result == 0) {
    configured_ = true;
  }
}

void Registration::configure(std::int64_t now_ns, Link& link) {
  if (!mode_ || configured_) return;
  if (configured_ns_ && now_ns - *configured_ns_ < kConfigure_ns) return;
  configured_ns_ = now_ns;
  if (release_ >= Release::v1_18) {
    SetpointConfig config;
    config.type = setpoint_type_;
    config.source_id = *mode_;
    config.should_apply = true;
    return link.send(config);
  }
  VehicleControlMode config;
  config.source_id = *mode_;
  const bool position = setpoint_type_ == SetpointConfig::kTrajectory;
  config.position = config.velocity = config.altitude = config.climb_rate = config.acceleration =
      position;
  link.send(config);
  configured_ = ++unconfirmed_ >= kRepeat;
}

void Registration::forget() {
  mode_.reset();
  asked_ns_.reset();
  tries_ = 0;
}

}  // namespace goshawk::px4
