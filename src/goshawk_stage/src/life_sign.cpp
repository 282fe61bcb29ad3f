#include "goshawk/stage/life_sign.hpp"

#include <cstdlib>

#include "goshawk/conversions/status.hpp"

namespace goshawk::stage {
namespace {

constexpr double kPeriod_s = 0.5;
constexpr std::int64_t kTold_ns = 10'000'000;  // a smaller step moves no start by more

}  // namespace

LifeSign::LifeSign(runtime::Node& node, StageReporter& reporter,
                   const goshawk_msgs::msg::NavigatorState& state)
    : node_(node),
      reporter_(reporter),
      state_(state),
      alive_(node.advertise<goshawk_msgs::msg::NavigatorState>("navigator_alive",
                                                               runtime::Qos::state())) {
  node.every(kPeriod_s, [this] { send(); });
}

void LifeSign::before_commit() {
  const std::int64_t offset_ns = node_.now_ns() - node_.monotonic_ns();
  if (std::abs(offset_ns - sent_offset_ns_) > kTold_ns) send();
}

void LifeSign::send() {
  sent_offset_ns_ = node_.now_ns() - node_.monotonic_ns();
  auto message = state_;
  message.header(conversions::make_header(node_.now_ns()));
  reporter_.send(alive_, message);
}

}  // namespace goshawk::stage
