#include "goshawk/tracker/reference.hpp"

#include <algorithm>
#include <utility>

#include "clock_time.hpp"

namespace goshawk::tracker {
namespace {

constexpr double kShortestBrake_s = 0.5;
// A smooth step of the rate: it peaks at 3/2 of the mean deceleration.
constexpr double kBrakePeak = 1.5;
constexpr int kBisections = 40;

// How far along its path a brake gets, as a share of its duration; x in [0, 1].
double covered(double x) {
  return x - x * x * x + x * x * x * x / 2.0;
}

}  // namespace

Reference Reference::hold(const Vec3& position_map) {
  Reference reference;
  reference.hold_map_ = position_map;
  return reference;
}

Reference Reference::follow(std::shared_ptr<const CommittedTrajectory> committed,
                            std::int64_t start_ns) {
  Reference reference;
  reference.duration_s_ = committed->flown().duration_s();
  reference.start_ns_ = start_ns;
  reference.committed_ = std::move(committed);
  return reference;
}

void Reference::leave_by(const BezierPiece& curve, std::int64_t now_ns) {
  left_at_s_ = progress_s(now_ns);
  curve_ = curve;
  curve_ns_ = now_ns;
  brake_.reset();
}

void Reference::brake(std::int64_t now_ns, double deceleration_m_s2) {
  if (brake_ || at_rest(now_ns)) return;
  const double speed = at(now_ns).velocity.norm();
  const double duration_s = std::max(kShortestBrake_s, kBrakePeak * speed / deceleration_m_s2);
  brake_ = Brake{now_ns, path_time(now_ns).s, duration_s};
}

Reference::PathTime Reference::path_time(std::int64_t time_ns) const {
  if (!brake_ || time_ns <= brake_->begin_ns) return {seconds(path_start_ns(), time_ns), 1.0};
  // The rate falls from one to zero, without a jump of the acceleration: 1 - 3 x^2 + 2 x^3.
  const double T = brake_->duration_s;
  const double x = seconds(brake_->begin_ns, time_ns) / T;
  if (x >= 1.0) return {brake_->path_time_s + T / 2.0, 0.0};
  return {brake_->path_time_s + T * covered(x), 1.0 - x * x * (3.0 - 2.0 * x),
          -6.0 * x * (1.0 - x) / T, (12.0 * x - 6.0) / (T * T)};
}

FlatState Reference::on_path(double time_s) const {
  return curve_ ? curve_->sample(time_s) : committed_->flown().sample(time_s);
}

FlatState Reference::at(std::int64_t time_ns) const {
  if (rests_always()) return {.position = hold_map_};
  const PathTime t = path_time(time_ns);
  if (t.s < 0.0) {
    const FlatState start = on_path(0.0);
    return {start.position + t.s * start.velocity, t.rate * start.velocity};
  }
  if (t.s >= path_duration_s()) return {.position = on_path(path_duration_s()).position};
  // Chain rule: the path's derivatives by its own time, times those of that time.
  const FlatState path = on_path(t.s);
  return {path.position, t.rate * path.velocity,
          t.rate * t.rate * path.acceleration + t.rate_1_s * path.velocity,
          t.rate * t.rate * t.rate * path.jerk + 3.0 * t.rate * t.rate_1_s * path.acceleration +
              t.rate_1_s2 * path.velocity};
}

// When it passes a point of its path: the inverse of path_time().
double Reference::seconds_until(double path_time_s, std::int64_t from_ns) const {
  if (!brake_ || path_time_s <= brake_->path_time_s) {
    return path_time_s - seconds(path_start_ns(), from_ns);
  }
  const double share = (path_time_s - brake_->path_time_s) / brake_->duration_s;
  double low = 0.0, high = 1.0;
  for (int i = 0; i < kBisections; ++i) {
    const double middle = 0.5 * (low + high);
    (covered(middle) < share ? low : high) = middle;
  }
  return seconds(from_ns, brake_->begin_ns) + brake_->duration_s * low;
}

std::optional<Obstruction> Reference::find_obstruction(const FreeSpace& space, std::int64_t from_ns,
                                                       std::optional<std::int64_t> to_ns) const {
  if (rests_always() || at_rest(from_ns)) return {};
  const double end_s = brake_ ? brake_->path_time_s + brake_->duration_s / 2.0 : path_duration_s();
  const double from_s = path_time(from_ns).s;
  const double to_s = to_ns ? std::min(end_s, path_time(*to_ns).s) : end_s;
  auto found = curve_ ? goshawk::find_obstruction(space, *curve_, from_s, to_s)
                      : goshawk::find_obstruction(space, committed_->flown(), from_s, to_s);
  if (found) found->time_s = std::max(0.0, seconds_until(found->time_s, from_ns));
  return found;
}

bool Reference::at_rest(std::int64_t time_ns) const {
  if (rests_always()) return true;
  const PathTime t = path_time(time_ns);
  return t.rate == 0.0 || t.s >= path_duration_s();
}

double Reference::seconds_to_rest(std::int64_t from_ns) const {
  if (at_rest(from_ns)) return 0.0;
  const bool stops_before_the_end =
      brake_ && brake_->path_time_s + brake_->duration_s / 2.0 <= path_duration_s();
  return stops_before_the_end ? seconds(from_ns, brake_->begin_ns) + brake_->duration_s
                              : seconds_until(path_duration_s(), from_ns);
}

double Reference::progress_s(std::int64_t time_ns) const {
  if (!committed_) return 0.0;
  return std::clamp(curve_ ? left_at_s_ : path_time(time_ns).s, 0.0, duration_s_);
}

}  // namespace goshawk::tracker
