#include "writer_guard.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <chrono>

namespace goshawk::runtime {
namespace {

// Who was alive a moment ago still is: a flood of strangers' messages asks the system seldom.
constexpr std::int64_t kStillAlive_ns = 10'000'000;
// Each stranger is named once; of more than these, one a second.
constexpr std::size_t kMostNamed = 16;
constexpr std::int64_t kSayEvery_ns = 1'000'000'000;
// A stopped process stays the writer for so long, although nothing is heard from it.
constexpr double kStopped_s = 60.0;

std::int64_t steady_ns() {
  return std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

Participant participant_of(const rtps::GuidPrefix_t& prefix) {
  Participant participant;
  std::ranges::transform(prefix.value, participant.begin(),
                         [](auto octet) { return static_cast<std::byte>(octet); });
  return participant;
}

WriterGuard::WriterGuard(Context::Impl& context, const OnRefused& on_refused)
    : context_(context),
      on_refused_(on_refused),
      own_(participant_of(context.participant->guid().guidPrefix)),
      // The process itself comes first, in each part of a group.
      rank_([&context, own = own_](const Participant& p) {
        if (p == own) return 2;
        return context.listener.has_nodes(p) ? 1 : 0;
      }),
      writers_(own_, rank_) {}

void WriterGuard::found(const Participant& writer) {
  const std::lock_guard lock(mutex_);
  writers_.found(writer);
}

void WriterGuard::lost(const Participant& writer) {
  const std::lock_guard lock(mutex_);
  writers_.lost(writer);
}

bool WriterGuard::is_matched(const Participant& writer) {
  const std::lock_guard lock(mutex_);
  return writers_.is_matched(writer);
}

OneWriter& WriterGuard::chooser(std::uint8_t part) {
  return part == 0 ? writers_ : parts_.try_emplace(part, own_, rank_).first->second;
}

// On loopback a process lives as long as its port is taken, whether it is heard or not. Elsewhere
// discovery tells.
bool WriterGuard::lives(const Participant& writer) const {
  if (writer == own_) return true;
  if (context_.senders->has_ended(writer)) return false;
  const auto port = context_.senders->port_of(writer);
  if (writers_.is_matched(writer)) return !port || wire::is_taken(*port);
  return port && wire::is_taken(*port) && context_.listener.fell_silent(writer, kStopped_s);
}

bool WriterGuard::is_alive(const Participant& writer) {
  const std::int64_t now_ns = steady_ns();
  if (writer == lived_ && now_ns - lived_ns_ < kStillAlive_ns) return true;
  if (!lives(writer)) return false;
  lived_ = writer;
  lived_ns_ = now_ns;
  return true;
}

bool WriterGuard::admits(const Participant& writer, std::uint8_t part, const std::string& topic) {
  std::optional<Error> said;
  {
    const std::lock_guard lock(mutex_);
    OneWriter& one = chooser(part);
    if (one.admits(writer, steady_ns(), [this](const auto& w) { return is_alive(w); })) return true;
    said = count_refusal(writer, *one.chosen(), topic);
  }
  if (said) on_refused_(*said);
  return false;
}

bool WriterGuard::admits_now(const Participant& writer) {
  const std::lock_guard lock(mutex_);
  return writers_.admits(writer, steady_ns(), [this](const auto& w) { return is_alive(w); });
}

std::optional<Error> WriterGuard::count_refusal(const Participant& writer,
                                                const Participant& chosen,
                                                const std::string& topic) {
  const std::int64_t now_ns = steady_ns();
  const bool is_new = std::ranges::find(named_, writer) == named_.end() &&
                      (named_.size() < kMostNamed || now_ns - said_ns_ > kSayEvery_ns);
  if (!std::has_single_bit(++refusals_) && !is_new) return {};
  if (is_new) named_.push_back(writer);
  if (named_.size() > kMostNamed) named_.pop_front();
  said_ns_ = now_ns;
  const auto& known = context_.listener;
  return fail(ErrorCode::second_writer,
              fmt::format("{} is written by {}: what {} writes on it is ignored ({} messages so "
                          "far); stop one of them",
                          topic, chosen == own_ ? "this process itself" : known.describe(chosen),
                          known.describe(writer), refusals_));
}

void MatchListener::on_subscription_matched(dds::DataReader*,
                                            const dds::SubscriptionMatchedStatus& status) {
  const auto writer = participant_of(rtps::iHandle2GUID(status.last_publication_handle).guidPrefix);
  if (status.current_count_change > 0) {
    guard_->found(writer);
  } else if (status.current_count_change < 0) {
    guard_->lost(writer);
  }
}

}  // namespace goshawk::runtime
