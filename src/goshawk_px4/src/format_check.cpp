#include "goshawk/px4/format_check.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "goshawk/px4_wire/codec.hpp"

namespace goshawk::px4 {
namespace {

constexpr std::int64_t kPatience_ns = 300'000'000;

}  // namespace

template <typename Message>
void FormatCheck::add() {
  const auto definition = definition_of(Message::kType, release_);
  topics_.push_back(
      {"fmu/" + std::string(Message::kTopic), Message::kType, definition.layout.hash()});
}

FormatCheck::FormatCheck(const Config& config) : release_(config.release) {
  add<VehicleStatus>();
  add<VehicleOdometry>();
  add<VehicleLocalPosition>();
  add<VehicleLandDetected>();
  add<BatteryStatus>();
  add<FailsafeFlags>();
  add<VehicleCommandAck>();
  add<VehicleCommand>();
  add<TrajectorySetpoint>();
  if (config.setpoint == SetpointLevel::attitude) add<VehicleAttitudeSetpoint>();
  if (config.mode == ModeKind::offboard) {
    add<OffboardControlMode>();
    return;
  }
  add<RegisterExtComponentRequest>();
  add<RegisterExtComponentReply>();
  add<ArmingCheckRequest>();
  add<ArmingCheckReply>();
  if (config.release >= Release::v1_18) {
    add<SetpointConfig>();
    add<SetpointConfigReply>();
  } else {
    add<VehicleControlMode>();
  }
}

void FormatCheck::step(std::int64_t now_ns, Link& link) {
  if (done() || (asked_ns_ && now_ns - *asked_ns_ < kPatience_ns)) return;
  asked_ns_ = now_ns;
  ++tries_;
  MessageFormatRequest request;
  request.topic_name = characters_of<50>("/" + topic());
  link.send(request);
}

Status FormatCheck::hear(const MessageFormatResponse& response) {
  if (done() || text_of(response.topic_name) != "/" + topic()) return success();
  const Topic& asked = topics_[next_];
  const std::string release(to_word(release_));
  if (!response.success) {
    return fail(
        ErrorCode::invalid_parameter,
        fmt::format("PX4 has no topic {}: it is no PX4 {}, or that topic was left out of its "
                    "build (dds_topics.yaml)",
                    asked.name, release));
  }
  if (response.message_hash != asked.hash) {
    std::vector<std::string_view> others;
    for (const Release other : releases_with(asked.type, response.message_hash)) {
      others.push_back(to_word(other));
    }
    return fail(
        ErrorCode::invalid_parameter,
        fmt::format("PX4's {} has another layout than release {}: {}", asked.type, release,
                    others.empty()
                        ? std::string("it is of no release from 1.15 to 1.18: flash one of these")
                        : fmt::format("set px4_release to {}", fmt::join(others, " or "))));
  }
  ++next_;
  tries_ = 0;
  asked_ns_.reset();
  return success();
}

}  // namespace goshawk::px4
