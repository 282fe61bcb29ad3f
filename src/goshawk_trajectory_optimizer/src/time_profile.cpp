#include "goshawk/trajectory_optimizer/time_profile.hpp"

#include <algorithm>
#include <cmath>

namespace goshawk::trajectory_optimizer {
namespace {

// How fast a limit lets the vehicle go along a direction.
double along(const Vec3& direction, double limit, LimitNorm norm) {
  return norm == LimitNorm::euclidean ? limit : limit / direction.cwiseAbs().maxCoeff();
}

// sqrt(a R), R the radius of the circle that touches both segments within half of their length.
double corner_speed(const Vec3& before, const Vec3& after, double length, double a_max) {
  const double cosine = std::clamp(before.dot(after), -1.0, 1.0);
  const double half_tangent = std::sqrt((1.0 - cosine) / std::max(1.0 + cosine, 1e-12));
  return std::sqrt(a_max * length / (2.0 * std::max(half_tangent, 1e-9)));
}

}  // namespace

TimeProfile::TimeProfile(std::span<const Vec3> waypoints, const Limits& limits, double start_speed,
                         double goal_speed) {
  const std::size_t n = waypoints.size() - 1;
  segments_.resize(n);
  for (std::size_t k = 0; k < n; ++k) {
    Segment& s = segments_[k];
    const Vec3 step = waypoints[k + 1] - waypoints[k];
    s.from = waypoints[k];
    s.length = step.norm();
    s.direction = s.length > 0.0 ? Vec3(step / s.length) : Vec3::UnitX();
    s.v_max = along(s.direction, limits.v_max_m_s, limits.norm);
    s.a_max = along(s.direction, limits.a_max_m_s2, limits.norm);
  }
  segments_.front().v_in = std::min(start_speed, segments_.front().v_max);
  segments_.back().v_out = std::min(goal_speed, segments_.back().v_max);
  for (std::size_t k = 0; k + 1 < n; ++k) {
    Segment& a = segments_[k];
    Segment& b = segments_[k + 1];
    a.v_out = b.v_in = std::min(
        {a.v_max, b.v_max,
         corner_speed(a.direction, b.direction, std::min(a.length, b.length), limits.a_max_m_s2)});
  }
  const auto reachable = [](double v, const Segment& s) {
    return std::sqrt(v * v + 2.0 * s.a_max * s.length);
  };
  for (std::size_t k = 0; k < n; ++k) {
    segments_[k].v_out = std::min(segments_[k].v_out, reachable(segments_[k].v_in, segments_[k]));
    if (k + 1 < n) segments_[k + 1].v_in = segments_[k].v_out;
  }
  for (std::size_t k = n; k-- > 0;) {
    segments_[k].v_in = std::min(segments_[k].v_in, reachable(segments_[k].v_out, segments_[k]));
    if (k > 0) segments_[k - 1].v_out = segments_[k].v_in;
  }
  for (Segment& s : segments_) {
    const double peak2 = s.a_max * s.length + 0.5 * (s.v_in * s.v_in + s.v_out * s.v_out);
    s.v_peak = std::min(s.v_max, std::sqrt(peak2));
    if (!(s.v_peak > 0.0)) continue;  // no length, no time
    s.v_peak = std::max({s.v_peak, s.v_in, s.v_out});
    s.accelerate = (s.v_peak - s.v_in) / s.a_max;
    const double brake = (s.v_peak - s.v_out) / s.a_max;
    const double ramps =
        0.5 * (s.v_peak + s.v_in) * s.accelerate + 0.5 * (s.v_peak + s.v_out) * brake;
    s.cruise = std::max(0.0, s.length - ramps) / s.v_peak;
    s.duration = s.accelerate + s.cruise + brake;
  }
}

double TimeProfile::duration_s() const {
  double total = 0.0;
  for (const Segment& s : segments_) total += s.duration;
  return total;
}

FlatState TimeProfile::state(int segment, double t) const {
  const Segment& s = segments_[std::size_t(segment)];
  double way = 0.0;
  double speed = 0.0;
  if (t < s.accelerate) {
    speed = s.v_in + s.a_max * t;
    way = 0.5 * (s.v_in + speed) * t;
  } else if (t < s.accelerate + s.cruise) {
    speed = s.v_peak;
    way = 0.5 * (s.v_in + s.v_peak) * s.accelerate + s.v_peak * (t - s.accelerate);
  } else {
    const double left = std::max(0.0, s.duration - t);
    speed = std::min(s.v_peak, s.v_out + s.a_max * left);
    way = s.length - 0.5 * (s.v_out + speed) * left;
  }
  FlatState state;
  state.position = s.from + std::clamp(way, 0.0, s.length) * s.direction;
  state.velocity = speed * s.direction;
  return state;
}

double rest_to_rest_duration_s(double length, double v_max, double a_max) {
  return length <= v_max * v_max / a_max ? 2.0 * std::sqrt(length / a_max)
                                         : length / v_max + v_max / a_max;
}

}  // namespace goshawk::trajectory_optimizer
