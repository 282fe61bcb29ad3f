#include "goshawk/obstacle_tracker_lab/score.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace goshawk::obstacle_tracker {
namespace {

constexpr double kMoves_m_s = 0.2;
constexpr double kOnIt_m = 0.1;  // how far a point lies off a box that it was measured on
constexpr double kSame_m = 1.0;  // between the centre of a thing and of what was told of it

double mean(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / double(values.size());
}

double p95(std::vector<double> values) {
  if (values.empty()) return std::nan("");
  std::ranges::sort(values);
  return values[std::min(values.size() - 1, std::size_t(0.95 * double(values.size())))];
}

}  // namespace

Score::Score(std::vector<movers::Mover> truth, int points_needed)
    : truth_(std::move(truth)), points_needed_(points_needed), things_(truth_.size()) {}

int Score::points_on(std::size_t mover, std::span<const Vec3> points, double time_s) const {
  const movers::OrientedBox box = truth_[mover].box_at(time_s);
  const double reach_m = truth_[mover].reach_m() + kOnIt_m;
  return int(std::ranges::count_if(points, [&](const Vec3& p) {
    return (p - box.center_map).squaredNorm() < reach_m * reach_m && box.distance_m(p) < kOnIt_m;
  }));
}

void Score::follow_motion(std::size_t mover, double time_s) {
  Thing& thing = things_[mover];
  const bool moves = truth_[mover].at(time_s).velocity_map.norm() > kMoves_m_s;
  if (moves && !thing.moves) thing.moves_since_s = time_s, thing.waits = true;
  if (!moves && thing.moves && thing.waits) ++never_told_, thing.waits = false;
  thing.moves = moves;
}

void Score::compare(std::size_t mover, const TrackedObstacle& o, double time_s) {
  Thing& thing = things_[mover];
  if (thing.id != 0 && thing.id != o.box.id) ++switches_;
  thing.id = o.box.id;
  if (thing.waits) delays_s_.push_back(time_s - thing.moves_since_s), thing.waits = false;
  if (!thing.moves) return;
  const movers::BoxState state = truth_[mover].at(time_s);
  position_m_.push_back((o.box.position_map - state.position_map).norm());
  velocity_m_s_.push_back((o.box.velocity_map - state.velocity_map).norm());
  ++bounds_;
  for (std::size_t i = 0; i < kHorizons_s.size(); ++i) {
    const double h = kHorizons_s[i];
    const Vec3 there = truth_[mover].at(time_s + h).position_map;
    const double off = (o.box.position_map + h * o.box.velocity_map - there).norm();
    inside_[i] += off <= o.bound_m + h * o.bound_rate_m_s ? 1 : 0;
  }
}

void Score::add(std::span<const Vec3> points, std::span<const TrackedObstacle> told,
                double time_s) {
  std::vector<char> is_thing(told.size(), 0);
  for (std::size_t m = 0; m < truth_.size(); ++m) {
    follow_motion(m, time_s);
    const Vec3 place = truth_[m].at(time_s).position_map;
    double best_m = kSame_m;
    std::size_t best = told.size();
    for (std::size_t i = 0; i < told.size(); ++i) {
      const double apart_m = (told[i].box.position_map - place).norm();
      if (apart_m < best_m && is_thing[i] == 0) best_m = apart_m, best = i;
    }
    const bool visible = things_[m].moves && points_on(m, points, time_s) >= points_needed_;
    visible_ += visible ? 1 : 0;
    if (best == told.size()) continue;
    found_ += visible ? 1 : 0;
    is_thing[best] = 1;
    compare(m, told[best], time_s);
  }
  told_ += std::int64_t(told.size());
  false_ += std::ranges::count(is_thing, 0);
}

Figures Score::figures() const {
  Figures f;
  f.recall = double(found_) / double(visible_);
  f.precision = 1.0 - double(false_) / double(told_);
  f.false_told = false_, f.told = told_, f.switches = switches_;
  f.position_error_m = mean(position_m_), f.position_p95_m = p95(position_m_);
  f.velocity_error_m_s = mean(velocity_m_s_), f.velocity_p95_m_s = p95(velocity_m_s_);
  f.delays_s = delays_s_, f.never_told = never_told_;
  for (std::size_t i = 0; i < kHorizons_s.size(); ++i) {
    f.in_bound[i] = double(inside_[i]) / double(bounds_);
  }
  return f;
}

}  // namespace goshawk::obstacle_tracker
