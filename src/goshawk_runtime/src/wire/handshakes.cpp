#include "handshakes.hpp"

#include <algorithm>

#include "handshake_datagrams.hpp"
#include "submessage.hpp"

namespace goshawk::runtime::wire {
namespace {

// A greeting may be lost on a network: it is repeated if no answer has come after so long.
constexpr std::int64_t kAgain_ns = 3'000'000'000;
// All ways out of this process are used within so long: announcements go through each.
constexpr std::int64_t kSending_ns = 1'000'000'000;

}  // namespace

void Handshakes::begin(const Prefix& own) {
  const std::lock_guard lock(mutex_);
  own_ = own;
}

std::optional<Handshakes::Prefix> Handshakes::own() const {
  const std::lock_guard lock(mutex_);
  return own_;
}

void Handshakes::discovered(const Prefix& other, const Locators& at) {
  const std::lock_guard lock(mutex_);
  others_[other] = Other{.at = at};
  next_ns_ = 0;
}

void Handshakes::authorized(const Prefix& other) {
  const std::lock_guard lock(mutex_);
  const auto found = others_.find(other);
  if (found != others_.end()) found->second.is_authorized = true;
}

bool Handshakes::left(const Prefix& other) {
  const std::lock_guard lock(mutex_);
  const auto node = others_.extract(other);
  return !node.empty() && node.mapped().is_leaving;
}

// Before it is read.
bool Handshakes::must_forget(Other& other, Bytes datagram) const {
  if (is_farewell(datagram)) return true;
  if (other.is_authorized && is_greeting(datagram, *own_)) return true;
  const auto message = handshake_message(datagram, *own_);
  if (!message) return false;
  other.is_heard = true;
  if (!message->is_request) return false;
  const bool is_other = other.request && *other.request != message->number;
  other.request = message->number;
  return is_other;
}

Handshakes::Intake Handshakes::take_in(Bytes datagram) {
  const std::lock_guard lock(mutex_);
  if (!own_) return {};
  Prefix sender;
  std::ranges::copy(datagram.subspan(kHeader - kPrefix, kPrefix), sender.begin());
  const auto found = others_.find(sender);
  if (found == others_.end()) return {.passes = !is_farewell(datagram)};
  Other& other = found->second;
  if (other.is_leaving) return {.passes = false};
  if (is_announcement(datagram)) other.announcement.assign(datagram.begin(), datagram.end());
  if (!must_forget(other, datagram)) return {};
  other.is_leaving = true;
  if (other.announcement.empty()) return {.passes = false};  // its lease ends by itself
  return {.passes = false, .instead = make_brief(other.announcement)};
}

std::vector<Handshakes::Greeting> Handshakes::greetings(const void* way, std::int64_t now_ns) {
  const std::lock_guard lock(mutex_);
  std::vector<Greeting> due;
  if (!own_ || now_ns < next_ns_) return due;
  next_ns_ = now_ns + kAgain_ns;
  for (auto& [prefix, other] : others_) {
    const bool is_first = other.greeted_ns == 0;
    if (!is_first && (other.is_authorized || other.is_heard)) continue;
    if (is_first || now_ns - other.greeted_ns >= kAgain_ns) {
      other.greeted_ns = now_ns;
      other.ways.clear();
    }
    const bool is_being_sent = now_ns - other.greeted_ns < kSending_ns;
    next_ns_ = std::min(next_ns_, is_being_sent ? now_ns : other.greeted_ns + kAgain_ns);
    if (std::ranges::find(other.ways, way) != other.ways.end()) continue;
    other.ways.push_back(way);
    due.push_back({prefix, other.at});
  }
  return due;
}

}  // namespace goshawk::runtime::wire
