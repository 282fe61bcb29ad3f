#include "goshawk/guard/flown.hpp"

#include <algorithm>
#include <cmath>

namespace goshawk::guard {
namespace {

constexpr double kElsewhere_m = 0.02;
constexpr std::int64_t kSettled_ns =
    300'000'000;  // after a commit begins, the tracker has answered

}  // namespace

std::int64_t Flown::end_ns(const CommittedTrajectory& leg) const {
  return leg.start_time_ns() + std::llround(leg.flown().duration_s() * 1e9);
}

const CommittedTrajectory* Flown::leg_at(std::int64_t time_ns) const {
  const CommittedTrajectory* found = nullptr;
  for (const auto& leg : legs_) {
    if (leg.start_time_ns() <= time_ns) found = &leg;
  }
  return found;
}

void Flown::add(CommittedTrajectory committed) {
  // As in the tracker, what waits for a later time gives way. What begins at the same time stays
  // until the tracker has taken the new one, which it may refuse.
  std::erase_if(legs_, [&](const CommittedTrajectory& leg) {
    return leg.start_time_ns() > committed.start_time_ns();
  });
  legs_.push_back(std::move(committed));
}

bool Flown::tracker_is_silent(std::int64_t now_ns) const {
  return heard_ns_ && double(now_ns - *heard_ns_) * 1e-9 > kTrackerSilent_s;
}

void Flown::hear(const Tracking& tracking, std::int64_t now_ns) {
  heard_ns_ = now_ns;
  if (tracking.mode == Tracking::Mode::brakes || tracking.mode == Tracking::Mode::none) lose();
  if (tracking.mode != Tracking::Mode::holds) return;
  hovers_map_ = tracking.reference_map;
  forget_flown(now_ns);
  // It holds elsewhere than where a commit has it: after odometry was lost, say.
  const auto* leg = leg_at(now_ns);
  if (leg == nullptr || now_ns - leg->start_time_ns() < kSettled_ns) return;
  if ((at(now_ns)->position - *hovers_map_).norm() > kElsewhere_m) legs_.clear();
}

bool Flown::answer(std::uint64_t id, bool accepted, std::int64_t now_ns) {
  const auto leg = std::ranges::find(legs_, id, &CommittedTrajectory::id);
  if (leg == legs_.end()) return false;
  if (accepted) {
    accepted_ = std::max(accepted_, id);
    forget_flown(now_ns);
    return false;
  }
  const bool was_flown = id <= accepted_;
  if (was_flown) {
    lose();
  } else {
    legs_.erase(leg, legs_.end());  // what begins on it falls with it
  }
  return was_flown;
}

void Flown::lose() {
  legs_.clear();
  hovers_map_.reset();
}

std::optional<FlatState> Flown::at(std::int64_t time_ns) const {
  if (const auto* leg = leg_at(time_ns)) {
    const Trajectory& flown = leg->flown();
    const double t_s = double(time_ns - leg->start_time_ns()) * 1e-9;
    if (t_s < flown.duration_s()) return flown.sample(std::max(0.0, t_s));
    return FlatState{.position = flown.pieces.back().control_points.col(5)};
  }
  if (hovers_map_) return FlatState{.position = *hovers_map_};
  return {};
}

bool Flown::rests_from(std::int64_t time_ns) const {
  return std::ranges::all_of(
      legs_, [&](const CommittedTrajectory& leg) { return end_ns(leg) <= time_ns; });
}

const CommittedTrajectory* Flown::newest(std::int64_t now_ns) const {
  if (legs_.empty() || end_ns(legs_.back()) <= now_ns) return nullptr;
  return &legs_.back();
}

// What a later one that the tracker has taken has replaced by now.
void Flown::forget_flown(std::int64_t now_ns) {
  std::size_t first = 0;
  for (std::size_t i = 0; i < legs_.size(); ++i) {
    if (legs_[i].start_time_ns() <= now_ns && legs_[i].id() <= accepted_) first = i;
  }
  legs_.erase(legs_.begin(), legs_.begin() + std::ptrdiff_t(first));
}

}  // namespace goshawk::guard
