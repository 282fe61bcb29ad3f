#include "goshawk/tracker/reference.hpp"

#include <algorithm>
#include <utility>

#include "clock_time.hpp"

namespace goshawk::tracker {
namespace {

constexpr double kShortestBrake_s = 0.5;

}  // namespace

double CommittedTrajectory::yaw_at(double t_s) const {
  if (yaw_points_rad.empty()) return yaw_rad;
  const std::size_t spans = yaw_points_rad.size() - 2;
  const double u = std::clamp(t_s / yaw_step_s, 0.0, double(spans));
  const std::size_t k = std::min(std::size_t(u), spans - 1);
  const double f = u - double(k);
  const double before = yaw_points_rad[k + 1] - yaw_points_rad[k];
  const double after = yaw_points_rad[k + 2] - yaw_points_rad[k + 1];
  const double knot = 0.5 * (yaw_points_rad[k] + yaw_points_rad[k + 1]);
  return knot + f * before + 0.5 * f * f * (after - before);
}

Reference Reference::hold(const Vec3& position_map) {
  Reference reference;
  reference.hold_map_ = position_map;
  return reference;
}

Reference Reference::follow(CommittedTrajectory committed) {
  Reference reference;
  reference.duration_s_ = committed.trajectory.duration_s();
  reference.committed_ = std::move(committed);
  return reference;
}

void Reference::brake(std::int64_t now_ns, double deceleration_m_s2) {
  if (!committed_ || braking() || at_rest(now_ns)) return;
  const double speed = at(now_ns).velocity.norm();
  brake_ =
      Brake{now_ns, path_time(now_ns).s, std::max(kShortestBrake_s, speed / deceleration_m_s2)};
}

void Reference::stop(const BezierPiece& curve, std::int64_t now_ns) {
  const double path_time_s = stop_ ? stop_->path_time_s : progress_s(now_ns);
  stop_ = Stop{now_ns, path_time_s, curve};
}

Reference::PathTime Reference::path_time(std::int64_t time_ns) const {
  if (!brake_ || time_ns <= brake_->begin_ns) {
    return {seconds(committed_->start_time_ns, time_ns), 1.0, 0.0};
  }
  // The rate falls linearly from one to zero.
  const double u = seconds(brake_->begin_ns, time_ns);
  const double T = brake_->duration_s;
  if (u >= T) return {brake_->path_time_s + T / 2.0, 0.0, 0.0};
  return {brake_->path_time_s + u - u * u / (2.0 * T), 1.0 - u / T, -1.0 / T};
}

FlatState Reference::at(std::int64_t time_ns) const {
  if (stop_) {
    const double t = std::max(0.0, seconds(stop_->begin_ns, time_ns));
    if (t < stop_->curve.duration_s) return stop_->curve.sample(t);
    return {.position = stop_->curve.control_points.col(5)};
  }
  if (!committed_) return {.position = hold_map_};
  const PathTime t = path_time(time_ns);
  const auto& pieces = committed_->trajectory.pieces;
  if (t.s < 0.0) {
    const FlatState start = pieces.front().sample(0.0);
    return {start.position + t.s * start.velocity, t.rate * start.velocity};
  }
  if (t.s >= duration_s_) return {.position = pieces.back().control_points.col(5)};
  // Chain rule: the path's derivatives by its own time, times those of that time.
  const FlatState on_path = committed_->trajectory.sample(t.s);
  return {
      on_path.position, t.rate * on_path.velocity,
      t.rate * t.rate * on_path.acceleration + t.rate_1_s * on_path.velocity,
      t.rate * t.rate * t.rate * on_path.jerk + 3.0 * t.rate * t.rate_1_s * on_path.acceleration};
}

bool Reference::at_rest(std::int64_t time_ns) const {
  if (stop_) return seconds(stop_->begin_ns, time_ns) >= stop_->curve.duration_s;
  if (!committed_) return true;
  const PathTime t = path_time(time_ns);
  return t.rate == 0.0 || t.s >= duration_s_;
}

double Reference::progress_s(std::int64_t time_ns) const {
  const double s = !committed_ ? 0.0 : stop_ ? stop_->path_time_s : path_time(time_ns).s;
  return std::clamp(s, 0.0, duration_s_);
}

}  // namespace goshawk::tracker
