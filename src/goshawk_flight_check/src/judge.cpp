#include "judge.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace goshawk::flight_check {

namespace {

Eigen::Quaterniond unit(const Quaternion& q) {
  return Eigen::Quaterniond(q).normalized();
}

}  // namespace

Motion::Motion(std::span<const Sample> track, double reach_m, double drift_m_s) : track_(track) {
  moved_m_.reserve(track.size());
  moved_m_.push_back(0.0);
  for (std::size_t i = 1; i < track.size(); ++i) {
    const double angle_rad =
        unit(track[i - 1].q_map_base).angularDistance(unit(track[i].q_map_base));
    const double straight_m = (track[i].position_map - track[i - 1].position_map).norm();
    const double drift_m = drift_m_s * (track[i].t_s - track[i - 1].t_s);
    moved_m_.push_back(moved_m_.back() + straight_m + angle_rad * reach_m + drift_m);
  }
}

Motion::Step Motion::step(double place) const {
  const auto sample = std::min(std::size_t(place), track_.size() - 1);
  return {sample, sample + 1 < track_.size() ? place - double(sample) : 0.0};
}

double Motion::moved_m(double place) const {
  const auto [i, part] = step(place);
  return part > 0.0 ? moved_m_[i] + part * (moved_m_[i + 1] - moved_m_[i]) : moved_m_[i];
}

Pose Motion::pose(double place) const {
  const auto [i, part] = step(place);
  const Sample& a = track_[i];
  if (part <= 0.0) return {a.position_map, unit(a.q_map_base)};
  const Sample& b = track_[i + 1];
  return {a.position_map + part * (b.position_map - a.position_map),
          unit(a.q_map_base).slerp(part, unit(b.q_map_base))};
}

double Motion::t_s(double place) const {
  const auto [i, part] = step(place);
  return part > 0.0 ? track_[i].t_s + part * (track_[i + 1].t_s - track_[i].t_s) : track_[i].t_s;
}

double Motion::between(double from, double to) const {
  const double first = std::floor(from) + 1.0;
  const double last = std::ceil(to) - 1.0;
  if (first > last) return (from + to) / 2.0;
  const double half_m = (moved_m(from) + moved_m(to)) / 2.0;
  const auto begin = moved_m_.begin() + std::ptrdiff_t(first);
  const auto found = std::lower_bound(begin, moved_m_.begin() + std::ptrdiff_t(last), half_m);
  return double(found - moved_m_.begin());
}

Judge::Judge(Measure measure, const Motion& motion, double tolerance_m, double below_m)
    : measure_(std::move(measure)), motion_(motion), tolerance_m_(tolerance_m), below_m_(below_m) {
  verdict_.clearance_m = kInfinity;
  verdict_.clearance_t_s = motion.t_s(0.0);
  verdict_.clearance_place_map = motion.pose(0.0).position_map;
}

Verdict Judge::run() {
  const Measured first = measure(0.0, kInfinity);
  if (first.distance_m() <= 0.0) {
    record_contact(first);
  } else if (motion_.end() > 0.0) {
    const double last = motion_.end();
    search(first, measure(last, first.distance_m() + motion_.moved_m(0.0, last)));
  }
  return verdict_;
}

// Looks strictly between two places, the earlier part first, and at the later one. @pre no contact
// at a, nor before it
void Judge::search(const Measured& a, const Measured& b) {
  const double moved_m = motion_.moved_m(a.place, b.place);
  const double least_m = (a.distance_m() + b.distance_m() - moved_m) / 2.0;
  if (b.distance_m() > 0.0 && least_m >= smallest_that_matters_m()) return;
  const double place = motion_.between(a.place, b.place);
  const bool too_short =
      moved_m <= ClearanceMeter::kContact_m / 10.0 || place <= a.place || place >= b.place;
  if (too_short) {
    if (b.distance_m() <= 0.0) record_contact(b);
    return;
  }
  const Measured middle = measure(place, a.distance_m() + motion_.moved_m(a.place, place));
  search(a, middle);
  if (!verdict_.touched) search(middle, b);
}

/// [m] a clearance that is not below this cannot change the verdict. Where the flight comes close,
/// the tolerance shrinks with the clearance, so that contact or none is always decided.
double Judge::smallest_that_matters_m() const {
  const double smallest_m = std::min(verdict_.clearance_m, below_m_);
  return smallest_m - std::min(tolerance_m_, smallest_m / 2.0);
}

Judge::Measured Judge::measure(double place, double at_most_m) {
  const Clearance found = measure_(motion_.pose(place), motion_.t_s(place), at_most_m);
  ++verdict_.queries;
  if (found.distance_m > 0.0 && found.distance_m < verdict_.clearance_m) {
    verdict_.clearance_m = found.distance_m;
    verdict_.clearance_t_s = motion_.t_s(place);
    verdict_.clearance_place_map = found.obstacle_map;
  }
  return {place, found};
}

void Judge::record_contact(const Measured& at) {
  verdict_.touched = true;
  verdict_.clearance_m = 0.0;
  verdict_.clearance_t_s = motion_.t_s(at.place);
  verdict_.clearance_place_map = at.clearance.obstacle_map;
}

}  // namespace goshawk::flight_check
