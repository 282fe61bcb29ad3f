#include "goshawk/px4_stand_in/external_mode.hpp"

namespace goshawk::px4_stand_in {
namespace {

constexpr std::int64_t kEvery_ns = 300'000'000;
constexpr std::int64_t kMissed_ns = 50'000'000;
constexpr std::int8_t kCheckId = 0;

}  // namespace

int ExternalMode::most_misses() const {
  if (!replied_) return 11;
  return release_ == px4::Release::v1_15 ? 3 : 4;
}

void ExternalMode::hear(const px4::RegisterExtComponentRequest& m, bool armed, Wire& wire) {
  px4::RegisterExtComponentReply reply;
  reply.request_id = m.request_id;
  reply.name = m.name;
  reply.px4_ros2_api_version = release_ >= px4::Release::v1_18 ? 2 : 1;
  reply.success = !armed && !registered_ && m.register_arming_check && m.register_mode;
  if (reply.success) {
    registered_ = true;
    unresponsive_ = can_run_ = replied_ = awaited_ = false;
    misses_ = 0;
    reply.arming_check_id = kCheckId;
    reply.mode_id = std::int8_t(mode());
  }
  wire.send(reply);
}

void ExternalMode::hear(const px4::UnregisterExtComponent& m, bool armed) {
  if (!armed && m.mode_id == std::int8_t(mode())) registered_ = false;
}

void ExternalMode::hear(const px4::ArmingCheckReply& m) {
  if (!registered_ || m.registration_id != kCheckId || m.request_id != request_id_) return;
  awaited_ = false;
  replied_ = true;
  misses_ = 0;
  unresponsive_ = false;
  can_run_ = m.can_arm_and_run;
}

void ExternalMode::step(std::int64_t now_ns, Wire& wire) {
  if (registered_ && awaited_ && asked_ns_ && now_ns - *asked_ns_ >= kMissed_ns) {
    awaited_ = false;
    if (++misses_ >= most_misses()) unresponsive_ = true;
  }
  if (asked_ns_ && now_ns - *asked_ns_ < kEvery_ns) return;
  asked_ns_ = now_ns;
  awaited_ = registered_;
  px4::ArmingCheckRequest request;
  request.request_id = ++request_id_;
  request.valid_registrations_mask = registered_ ? 1u << kCheckId : 0u;
  wire.send(request);
}

}  // namespace goshawk::px4_stand_in
