#include "goshawk/tracker/commit_gate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "clock_time.hpp"

namespace goshawk::tracker {

std::optional<std::uint64_t> CommitGate::put(Commit commit) {
  const auto old = std::exchange(waiting_, std::move(commit));
  return old ? std::optional(old->trajectory.id()) : std::nullopt;
}

void CommitGate::hear(std::uint64_t id, const Error& outcome) {
  if (second_opinion_ == SecondOpinion::off || id == 0) return;
  const auto known = std::ranges::find(opinions_, id, &Opinion::id);
  if (known == opinions_.end()) {
    opinions_[next_opinion_] = {id, outcome};
    next_opinion_ = (next_opinion_ + 1) % opinions_.size();
  } else if (known->outcome.code != ErrorCode::collision) {
    known->outcome = outcome;
  }
}

bool CommitGate::waits_for_map(std::optional<std::uint64_t> map_version) const {
  return map_version ? *map_version < waiting_->trajectory.map_version() : require_map_;
}

const CommitGate::Opinion* CommitGate::opinion() const {
  const auto known = std::ranges::find(opinions_, waiting_->trajectory.id(), &Opinion::id);
  return known == opinions_.end() ? nullptr : &*known;
}

Status CommitGate::verdict() const {
  const Opinion* known = opinion();
  const std::uint64_t id = waiting_->trajectory.id();
  if (known != nullptr && known->outcome.code == ErrorCode::collision) {
    return fail(ErrorCode::collision,
                fmt::format("trajectory {} refused: the second opinion finds it touching: {}", id,
                            known->outcome.message));
  }
  if (second_opinion_ != SecondOpinion::require) return success();
  if (known == nullptr) {
    return fail(ErrorCode::stage_silent,
                fmt::format("trajectory {} refused: flight_check did not judge it within {:.3g} s; "
                            "is it running, in this domain and namespace?",
                            id, second_opinion_wait_s_));
  }
  if (known->outcome.code == ErrorCode::ok) return success();
  return fail(known->outcome.code,
              fmt::format("trajectory {} refused: flight_check could not judge it: {}", id,
                          known->outcome.message));
}

std::optional<CommitGate::Release> CommitGate::release(bool has_odometry,
                                                       std::optional<std::uint64_t> map_version,
                                                       std::int64_t now_ns) {
  if (!waiting_ || !has_odometry) return {};
  const double waited_s = seconds(waiting_->came_ns, now_ns);
  if (waits_for_map(map_version) && waited_s < map_wait_s_) return {};
  const Opinion* known = opinion();
  const bool is_judged = known != nullptr && (known->outcome.code == ErrorCode::ok ||
                                              known->outcome.code == ErrorCode::collision);
  if (second_opinion_ == SecondOpinion::require && !is_judged &&
      waited_s < second_opinion_wait_s_) {
    return {};
  }
  Status decision = verdict();
  return Release{*std::exchange(waiting_, {}), std::move(decision)};
}

}  // namespace goshawk::tracker
