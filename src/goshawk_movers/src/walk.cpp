#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "goshawk/movers/motion.hpp"
#include "yaw.hpp"

namespace goshawk::movers {
namespace {

constexpr double kFastest_m_s = 100.0;
constexpr double kFarthest_m = 1e6;
constexpr double kLongest_s = 1e6;
constexpr double kSamePoint_m = 1e-3;

std::string fault_of(const WalkParameters& p) {
  const auto within = [](double value, double lo, double hi) { return value >= lo && value <= hi; };
  if (p.points_map.size() < 2) return "it has fewer than two points";
  for (const Vec3& point : p.points_map) {
    if (!is_finite(point) || point.cwiseAbs().maxCoeff() > kFarthest_m) {
      return "a point is not within 1e6 m";
    }
  }
  for (std::size_t i = 1; i < p.points_map.size(); ++i) {
    if ((p.points_map[i] - p.points_map[i - 1]).norm() < kSamePoint_m) {
      return fmt::format("point {} is the same as the one before: use pauses to stand still",
                         i + 1);
    }
  }
  if (p.repeat == Repeat::loop &&
      (p.points_map.front() - p.points_map.back()).norm() < kSamePoint_m) {
    return "the last point is the first: a loop returns there by itself";
  }
  if (!p.pauses_s.empty() && p.pauses_s.size() != p.points_map.size()) {
    return fmt::format("there are {} pauses, but {} points", p.pauses_s.size(),
                       p.points_map.size());
  }
  for (const double pause_s : p.pauses_s) {
    if (!within(pause_s, 0.0, kLongest_s)) return "a pause is outside of 0 to 1e6 s";
  }
  if (!within(p.speed_m_s, 1e-3, kFastest_m_s)) return "speed is outside of 0.001 to 100 m/s";
  if (!within(p.acceleration_m_s2, 0.0, 1e3)) return "acceleration is outside of 0 to 1000 m/s^2";
  const bool turns = within(p.turn_rate_rad_s, 1e-2, 30.0) || p.turn_rate_rad_s == 0.0;
  return turns ? "" : "turn_rate is neither 0 nor within 0.01 to 30 rad/s";
}

struct Progress {
  double s_m, v_m_s;
};

// How far along a way of length_m, from rest to rest if the acceleration is limited.
Progress progress(double t_s, double length_m, double speed, double a) {
  if (a == 0.0) return {std::min(speed * t_s, length_m), speed};
  const double top = std::min(speed, std::sqrt(a * length_m));
  const double ramp_s = top / a;
  const double end_s = 2.0 * ramp_s + (length_m - top * ramp_s) / top;
  if (t_s < ramp_s) return {0.5 * a * t_s * t_s, a * t_s};
  const double left_s = std::max(0.0, end_s - t_s);
  if (left_s < ramp_s) return {length_m - 0.5 * a * left_s * left_s, a * left_s};
  return {0.5 * top * ramp_s + top * (t_s - ramp_s), top};
}

}  // namespace

Result<Walk> Walk::create(const WalkParameters& p) {
  if (const std::string fault = fault_of(p); !fault.empty()) {
    return fail(ErrorCode::invalid_input, fault);
  }
  Walk walk;
  walk.speed_m_s_ = p.speed_m_s;
  walk.acceleration_m_s2_ = p.acceleration_m_s2;
  walk.turn_rate_rad_s_ = p.turn_rate_rad_s;
  walk.repeats_ = p.repeat != Repeat::once;
  auto points = p.points_map;
  auto pauses_s = p.pauses_s.empty() ? std::vector<double>(points.size(), 0.0) : p.pauses_s;
  if (p.repeat == Repeat::back_and_forth) {
    for (std::size_t i = points.size() - 2; i >= 1; --i) {
      points.push_back(points[i]);
      pauses_s.push_back(pauses_s[i]);
    }
  }
  walk.fill(p, points, pauses_s, walk.repeats_);
  return walk;
}

void Walk::fill(const WalkParameters& p, const std::vector<Vec3>& points,
                const std::vector<double>& pauses_s, bool repeats) {
  const std::size_t n = points.size(), ways = repeats ? n : n - 1;
  std::vector<double> yaws(ways, 0.0);
  for (std::size_t i = 0; i < ways && p.turn_rate_rad_s > 0.0; ++i) {
    const Vec3 way = points[(i + 1) % n] - points[i];
    const bool level = way.head<2>().squaredNorm() > 0.0;
    // Straight up it keeps its heading.
    yaws[i] = level ? std::atan2(way.y(), way.x()) : i > 0 ? yaws[i - 1] : 0.0;
  }
  double yaw = repeats ? yaws.back() : yaws.front();
  for (std::size_t i = 0; i < ways; ++i) {
    const Vec3& from = points[i];
    const Vec3& to = points[(i + 1) % n];
    add({from, from, yaw, 0.0}, pauses_s[i]);
    const double turn = shorter_turn(yaw, yaws[i]);
    if (turn != 0.0) add({from, from, yaw, turn}, std::abs(turn) / p.turn_rate_rad_s);
    yaw = yaws[i];
    add({from, to, yaw, 0.0}, duration_s((to - from).norm()));
  }
}

double Walk::duration_s(double length_m) const {
  if (acceleration_m_s2_ == 0.0) return length_m / speed_m_s_;
  const double top = std::min(speed_m_s_, std::sqrt(acceleration_m_s2_ * length_m));
  return length_m / top + top / acceleration_m_s2_;
}

void Walk::add(const Phase& phase, double duration_s) {
  if (duration_s == 0.0) return;
  phases_.push_back(phase);
  end_s_.push_back((end_s_.empty() ? 0.0 : end_s_.back()) + duration_s);
}

BoxState Walk::at(double t_s) const {
  const double period = period_s();
  const bool stands = !repeats_ && (t_s < 0.0 || t_s >= period);
  const double t =
      repeats_ ? t_s - period * std::floor(t_s / period) : std::clamp(t_s, 0.0, period);
  const auto found = std::ranges::upper_bound(end_s_, t);
  const std::size_t i = std::min(std::size_t(found - end_s_.begin()), phases_.size() - 1);
  const Phase& phase = phases_[i];
  const double begin_s = i > 0 ? end_s_[i - 1] : 0.0, passed_s = t - begin_s;
  BoxState state{.position_map = phase.from, .q_map_box = from_yaw(phase.yaw_rad)};
  if (phase.turn_rad != 0.0) {
    const double duration_s = end_s_[i] - begin_s;
    const double part = std::min(1.0, passed_s / duration_s);
    state.q_map_box = from_yaw(phase.yaw_rad + part * phase.turn_rad);
    if (!stands) state.angular_velocity_map.z() = phase.turn_rad / duration_s;
  } else if (phase.from != phase.to) {
    const Vec3 way = phase.to - phase.from;
    const double length = way.norm();
    const auto [s, v] = progress(passed_s, length, speed_m_s_, acceleration_m_s2_);
    state.position_map += s / length * way;
    if (!stands) state.velocity_map = v / length * way;
  }
  return state;
}

}  // namespace goshawk::movers
