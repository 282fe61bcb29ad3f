#include <fmt/format.h>

#include <algorithm>

#include "clock_time.hpp"
#include "goshawk/tracker/tracker.hpp"

// What the tracker does when the map, or the second opinion, says no to what it flies.

namespace goshawk::tracker {

void Tracker::set_map(std::shared_ptr<const VoxelGrid> grid, std::int64_t now_ns) {
  guard_.set_map(grid);
  map_.set_map(std::move(grid));
  stays_ = false;  // another map, another answer
  if (!within_bound(now_ns) || !has_state_) return;
  landing_ ? check_landing(now_ns) : check_flight(now_ns);
}

// What waits, each to its end; then what is flown until the next of them.
void Tracker::check_flight(std::int64_t now_ns) {
  const VoxelGrid& grid = *map_.grid();
  for (const Reference& queued : queue_) {
    const auto found = queued.find_obstruction(grid, std::max(now_ns, queued.start_ns()));
    if (!found) continue;
    drop_queued(queued.committed().id(), ErrorCode::trajectory_blocked, to_text(grid, *found));
    break;
  }
  const auto until_ns = queue_.empty() ? std::nullopt : std::optional(queue_.front().start_ns());
  if (const auto found = reference_.find_obstruction(grid, now_ns, until_ns)) {
    stop_before(*found, now_ns);
  }
}

// With those behind it, which begin on it. The one before it goes on, and ends at rest.
void Tracker::drop_queued(std::uint64_t id, ErrorCode code, const std::string& why) {
  const auto first = std::ranges::find(queue_, id, [](const Reference& queued) {
    return queued.committed().id();
  });
  lost_ = fail(code, fmt::format("trajectory {} is dropped before its start: {}", id, why));
  lost_id_ = queue_.back().committed().id();
  queue_.erase(first, queue_.end());
}

void Tracker::stop_before(const Obstruction& found, std::int64_t now_ns) {
  const VoxelGrid& grid = *map_.grid();
  const std::uint64_t id = newest_id();
  const std::uint64_t flown_id = followed_id();
  queue_.clear();
  const bool is_free = stop_on_free_way(now_ns);
  lost_ = fail(ErrorCode::trajectory_blocked,
               fmt::format("trajectory {} is blocked {:.3g} s ahead: {}; {}", flown_id,
                           found.time_s, to_text(grid, found),
                           is_free ? "braking before it"
                                   : "no stop within the limits keeps clear of it: braking as late "
                                     "into it as possible"));
  lost_id_ = id;
}

// Along the path, gently and then harder; then where plan_stop() finds a way. Of those that are not
// free the one that stays free for the longest time.
// @return whether it is free
bool Tracker::stop_on_free_way(std::int64_t now_ns) {
  std::optional<Reference> best;
  double best_s = -1.0;
  for (const double deceleration :
       {config_.brake_acceleration_m_s2, config_.stop_acceleration_m_s2}) {
    if (!reference_.follows()) break;
    Reference braked = reference_;
    braked.brake(now_ns, deceleration);
    const auto found = braked.find_obstruction(*map_.grid(), now_ns);
    if (!found) {
      reference_ = std::move(braked);
      return true;
    }
    if (found->time_s < best_s) continue;
    best_s = found->time_s;
    best = std::move(braked);
  }
  const Stop stop = plan_stop_from(reference_.at(now_ns), now_ns, now_ns);
  if (!stop.enters_s || *stop.enters_s > best_s) {
    reference_.leave_by(stop.curve, now_ns);
  } else {
    reference_ = *std::move(best);
  }
  return !stop.enters_s;
}

void Tracker::veto(std::uint64_t id, const std::string& why, std::int64_t now_ns) {
  if (!within_bound(now_ns)) return;
  const std::string sentence = "the second opinion finds it touching: " + why;
  const auto has_id = [&](const Reference& queued) { return queued.committed().id() == id; };
  if (std::ranges::any_of(queue_, has_id)) {
    return drop_queued(id, ErrorCode::collision, sentence);
  }
  if (!reference_.follows() || followed_id() != id || reference_.at_rest(now_ns)) return;
  lost_ = fail(ErrorCode::collision,
               fmt::format("trajectory {} is braked for: {}", id, sentence));
  lost_id_ = newest_id();
  queue_.clear();
  reference_.brake(now_ns, config_.stop_acceleration_m_s2);
}

}  // namespace goshawk::tracker
