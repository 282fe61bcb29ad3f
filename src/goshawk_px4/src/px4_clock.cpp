#include "goshawk/px4/px4_clock.hpp"

#include <algorithm>
#include <utility>

namespace goshawk::px4 {
namespace {

constexpr std::int64_t kWindow_ns = 5'000'000'000;  // clocks drift by less than 1 ms in it
constexpr std::int64_t kStep_ns = 500'000'000;      // later than this is no delay any more

}  // namespace

std::int64_t Px4Clock::read(std::uint64_t stamp_us, std::int64_t received_ns) {
  const std::int64_t offset_ns = received_ns - std::int64_t(stamp_us) * 1000;
  if (!started_) begin(offset_ns, received_ns);
  const std::int64_t known_ns = std::min(least_ns_, last_least_ns_);
  const std::int64_t change_ns = offset_ns - known_ns;
  if (change_ns > kStep_ns || change_ns < -kStep_ns) {
    step_s_ = -double(change_ns) * 1e-9;
    begin(offset_ns, received_ns);
  }
  if (received_ns - window_begin_ns_ >= kWindow_ns) {
    last_least_ns_ = std::exchange(least_ns_, offset_ns);
    window_begin_ns_ = received_ns;
  }
  least_ns_ = std::min(least_ns_, offset_ns);
  const std::int64_t least_ns = std::min(least_ns_, last_least_ns_);
  return received_ns - (offset_ns - least_ns);
}

std::optional<double> Px4Clock::take_step() {
  return std::exchange(step_s_, std::nullopt);
}

void Px4Clock::begin(std::int64_t offset_ns, std::int64_t received_ns) {
  started_ = true;
  least_ns_ = last_least_ns_ = offset_ns;
  window_begin_ns_ = received_ns;
}

}  // namespace goshawk::px4
