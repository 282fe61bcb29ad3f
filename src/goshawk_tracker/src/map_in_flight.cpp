#include <fmt/format.h>

#include <algorithm>

#include "clock_time.hpp"
#include "goshawk/core/stop_part.hpp"
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

// From the last that waits to what is flown now: each until the next that is left begins.
void Tracker::check_flight(std::int64_t now_ns) {
  const VoxelGrid& grid = *map_.grid();
  const std::uint64_t newest = newest_id();
  std::optional<std::int64_t> until_ns;
  for (std::size_t i = queue_.size(); i-- > 0;) {
    const std::int64_t from_ns = std::max(now_ns, queue_[i].start_ns());
    const bool is_last = i + 1 == queue_.size();
    const auto found = queue_[i].find_obstruction(map_.space(), from_ns, until_ns);
    if (found && !(is_last && stop_sooner(queue_[i], from_ns))) {
      drop_queued(i, fail(ErrorCode::trajectory_blocked, to_text(grid, *found)), newest);
      until_ns.reset();
    } else {
      until_ns = queue_[i].start_ns();
    }
  }
  const auto found = reference_.find_obstruction(map_.space(), now_ns, until_ns);
  if (found && !(queue_.empty() && stop_sooner(reference_, now_ns))) {
    stop_before(*found, newest, now_ns);
  }
}

// What has a stop part leads on into the unknown, and is planned for again and again: it goes on as
// far as the newest map allows, and a better plan may come meanwhile. Its stop part then begins
// sooner, on the same nominal part. @return whether there is such a stop
bool Tracker::stop_sooner(Reference& flown, std::int64_t from_ns) {
  if (!flown.follows() || !flown.committed().stop()) return false;
  const CommittedTrajectory& c = flown.committed();
  const double from_s = std::max(0.0, flown.progress_s(from_ns));
  if (from_s >= c.stop()->after_s) return false;
  auto stop = latest_stop(c.nominal(), map_.space(), from_s);
  if (!stop || !*stop) return false;
  auto sooner = CommittedTrajectory::make({.id = c.id(),
                                           .nominal = c.nominal(),
                                           .stop = *std::move(stop),
                                           .start_time_ns = c.start_time_ns(),
                                           .map_version = map_.grid()->version,
                                           .yaw_rad = c.yaw_rad(),
                                           .yaw_curve = c.yaw_curve()});
  if (!sooner) return false;
  const std::int64_t start_ns = flown.start_ns();
  flown =
      Reference::follow(std::make_shared<const CommittedTrajectory>(*std::move(sooner)), start_ns);
  return true;
}

// With those behind it, which begin on it. The one before it goes on, and ends at rest.
void Tracker::drop_queued(std::size_t first, const Error& why, std::uint64_t newest) {
  lost_ = fail(why.code, fmt::format("trajectory {} is dropped before its start: {}",
                                     queue_[first].committed().id(), why.message));
  lost_id_ = newest;
  queue_.erase(queue_.begin() + std::ptrdiff_t(first), queue_.end());
}

void Tracker::stop_before(const Obstruction& found, std::uint64_t newest, std::int64_t now_ns) {
  const VoxelGrid& grid = *map_.grid();
  queue_.clear();
  const bool is_free = stop_on_free_way(now_ns);
  lost_ = fail(ErrorCode::trajectory_blocked,
               fmt::format("trajectory {} is blocked {:.3g} s ahead: {}; {}", followed_id(),
                           found.time_s, to_text(grid, found),
                           is_free ? "braking before it"
                                   : "no stop within the limits keeps clear of it: braking on the "
                                     "way that meets it last"));
  lost_id_ = newest;
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
    const auto found = braked.find_obstruction(map_.space(), now_ns);
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
  const Error verdict = fail(ErrorCode::collision, "the second opinion finds it touching: " + why);
  const std::uint64_t newest = newest_id();
  for (std::size_t i = 0; i < queue_.size(); ++i) {
    if (queue_[i].committed().id() == id) return drop_queued(i, verdict, newest);
  }
  if (!reference_.follows() || followed_id() != id || reference_.at_rest(now_ns)) return;
  lost_ = fail(verdict.code, fmt::format("trajectory {} is braked for: {}", id, verdict.message));
  lost_id_ = newest;
  queue_.clear();
  reference_.brake(now_ns, config_.stop_acceleration_m_s2);
}

}  // namespace goshawk::tracker
