#include "goshawk/navigator/schedule.hpp"

#include <algorithm>
#include <cmath>

namespace goshawk::navigator {

std::int64_t Leg::end_ns() const {
  return start_ns() + std::llround(committed.flown().duration_s() * 1e9);
}

bool Leg::stops_early(double tolerance_m) const {
  if (beyond_m > 0.0) return true;
  if (!committed.stop()) return false;
  const Trajectory& nominal = committed.nominal().trajectory();
  return (at(end_ns()).position - nominal.sample(nominal.duration_s()).position).norm() >
         tolerance_m;
}

FlatState Leg::at(std::int64_t time_ns) const {
  const Trajectory& flown = committed.flown();
  const double t_s = double(time_ns - start_ns()) * 1e-9;
  return flown.sample(std::clamp(t_s, 0.0, flown.duration_s()));
}

void Schedule::add(Leg leg) {
  std::erase_if(legs_, [&](const Leg& other) {
    return leg.continues ? other.start_ns() > leg.start_ns() : other.start_ns() >= leg.start_ns();
  });
  legs_.push_back(std::move(leg));
}

void Schedule::drop_refused(std::uint64_t id) {
  const auto refused = std::ranges::find(legs_, id, &Leg::id);
  const auto unanswered =
      std::find_if(legs_.begin(), refused, [](const Leg& leg) { return !leg.accepted; });
  legs_.erase(unanswered, legs_.end());
}

bool Schedule::drop_later_stop(std::uint64_t id) {
  const auto leg = std::ranges::find(legs_, id, &Leg::id);
  if (leg == legs_.end() || leg->accepted) return false;
  const auto next = leg + 1;
  const bool follows = leg->continues && leg != legs_.begin();
  const bool leads = next != legs_.end() && next->continues;
  if (!follows && !leads) return false;
  if (!follows) next->continues = false;
  legs_.erase(leg);
  return true;
}

void Schedule::forget_before(std::int64_t now_ns) {
  const auto next =
      std::ranges::find_if(legs_, [&](const Leg& leg) { return leg.start_ns() > now_ns; });
  if (next - legs_.begin() <= 1) return;
  auto kept = next - 1;
  while (kept != legs_.begin() && kept->continues && !kept->accepted) --kept;
  legs_.erase(legs_.begin(), kept);
}

const Leg* Schedule::at(std::int64_t time_ns) const {
  const Leg* flown = nullptr;
  for (const Leg& leg : legs_) {
    if (leg.start_ns() <= time_ns) flown = &leg;
  }
  return flown;
}

Leg* Schedule::find(std::uint64_t id) {
  const auto leg = std::ranges::find(legs_, id, &Leg::id);
  return leg == legs_.end() ? nullptr : &*leg;
}

std::int64_t Schedule::until_ns(const Leg& leg) const {
  const auto next = &leg - legs_.data() + 1;
  const bool is_last = std::size_t(next) == legs_.size();
  return is_last ? leg.end_ns() : std::min(leg.end_ns(), legs_[std::size_t(next)].start_ns());
}

}  // namespace goshawk::navigator
