#include "goshawk/stage/sender_clock.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace goshawk::stage {
namespace {

constexpr std::size_t kWindow = 8;                 // messages
constexpr std::int64_t kEarly_ns = 20'000'000;     // time servers agree better than this
constexpr std::int64_t kLate_ns = 100'000'000;     // a message may be as long on its way
constexpr std::int64_t kSet_ns = 1'000'000'000;    // no message is late by as much: a clock was set
constexpr std::int64_t kSteady_ns = 300'000'000;   // as long, nothing is late by the same
constexpr std::int64_t kMost_ns = 10'000'000'000;  // compensated: more is a clock nobody has set

bool agrees(std::int64_t age_ns) {
  return age_ns >= -kEarly_ns && age_ns <= kLate_ns;
}

}  // namespace

void SenderClock::hear(std::int64_t stamp_ns, std::int64_t now_ns) {
  // What came before the sender's clock was set says nothing of the clock that it has now.
  if (!heard_.empty()) {
    const Heard& last = heard_.back();
    const std::int64_t leap_ns = (stamp_ns - last.stamp_ns) - (now_ns - last.now_ns);
    if (std::abs(leap_ns) > kSet_ns) heard_.clear();
  }
  heard_.push_back({stamp_ns, now_ns});
  if (heard_.size() > kWindow) heard_.pop_front();
  forget_other_clock();
}

// A small step back looks like lateness, but only for one message.
void SenderClock::forget_other_clock() {
  const Heard& newest = heard_.back();
  const auto later_ns = [&](const Heard& h) {  // by how much the newest is later than this one
    return (newest.now_ns - newest.stamp_ns) - (h.now_ns - h.stamp_ns);
  };
  const auto other = std::find_if(heard_.rbegin(), heard_.rend(), [&](const Heard& h) {
    return std::abs(later_ns(h)) > kEarly_ns;
  });
  if (other == heard_.rend() || later_ns(*other) <= kLate_ns) return;
  const auto first = other.base();  // of those that tell the newest one's clock
  if (newest.now_ns - first->now_ns >= kSteady_ns) heard_.erase(heard_.begin(), first);
}

std::int64_t SenderClock::skew_ns(std::int64_t wall_ns, std::int64_t now_ns,
                                  std::int64_t sent_ns) const {
  if (heard_.empty() || agrees(wall_ns - sent_ns)) return 0;
  const auto age_ns = [&](const Heard& h) { return h.now_ns + (wall_ns - now_ns) - h.stamp_ns; };
  // The newest one first: after either clock was set, the older ones are of another time.
  if (agrees(age_ns(heard_.back()))) return 0;
  const std::int64_t quickest_ns = age_ns(*std::ranges::min_element(heard_, {}, age_ns));
  return agrees(quickest_ns) ? 0 : -quickest_ns;
}

Status SenderClock::check(std::int64_t skew_ns, const char* sender) {
  if (std::abs(skew_ns) <= kMost_ns) return success();
  return fail(
      ErrorCode::clock_set,
      fmt::format("clock skew: the clock of {}'s host is {:.3g} s {} this host's, more than "
                  "the {:.3g} s that are compensated: set both clocks (chrony, timedatectl)",
                  sender, std::abs(double(skew_ns)) * 1e-9, skew_ns > 0 ? "ahead of" : "behind",
                  double(kMost_ns) * 1e-9));
}

}  // namespace goshawk::stage
