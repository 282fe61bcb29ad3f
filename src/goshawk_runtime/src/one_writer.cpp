#include "one_writer.hpp"

#include <algorithm>

namespace goshawk::runtime {
namespace {

constexpr std::size_t kMostRefused = 64;  // a stranger may come back under ever new names

}  // namespace

void OneWriter::found(const Participant& writer) {
  const auto at = std::ranges::find(matched_, writer, &std::pair<Participant, int>::first);
  if (at == matched_.end()) {
    matched_.emplace_back(writer, 1);
  } else {
    ++at->second;
  }
}

void OneWriter::lost(const Participant& writer) {
  const auto at = std::ranges::find(matched_, writer, &std::pair<Participant, int>::first);
  if (at != matched_.end() && --at->second <= 0) matched_.erase(at);
}

bool OneWriter::is_matched(const Participant& writer) const {
  return std::ranges::find(matched_, writer, &std::pair<Participant, int>::first) != matched_.end();
}

bool OneWriter::was_refused(const Participant& writer) const {
  return std::ranges::find(refused_, writer) != refused_.end();
}

// The first time: this process itself, else of those that live and rank highest the first.
void OneWriter::choose(const Participant& speaker, const IsAlive& is_alive) {
  if (is_matched(own_)) {
    chosen_ = own_;
    return;
  }
  int best = -1;
  chosen_ = speaker;
  for (const auto& [writer, count] : matched_) {
    if (rank(writer) <= best || !is_alive(writer)) continue;
    best = rank(writer);
    chosen_ = writer;
  }
}

bool OneWriter::admits(const Participant& writer, std::int64_t now_ns, const IsAlive& is_alive) {
  if (!chosen_) choose(writer, is_alive);
  if (*chosen_ == writer) {
    died_ns_ = 0;
    return true;
  }
  const bool outranks = *chosen_ != own_ && rank(writer) > rank(*chosen_);
  if (!outranks && is_alive(*chosen_)) {
    died_ns_ = 0;
    if (!was_refused(writer)) refused_.push_back(writer);
    if (refused_.size() > kMostRefused) refused_.pop_front();
    return false;
  }
  if (died_ns_ == 0) died_ns_ = now_ns;
  if (!outranks && was_refused(writer) && now_ns - died_ns_ < kGrace_ns) return false;
  chosen_ = writer;
  refused_.clear();
  died_ns_ = 0;
  return true;
}

}  // namespace goshawk::runtime
