#include "goshawk/trajectory_optimizer/yaw.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

namespace goshawk::trajectory_optimizer {
namespace {

constexpr double kStep_s = 0.05;
constexpr int kMostPoints = 100'000;
constexpr double kLeastSpeed_m_s = 0.05;   // slower, the direction of motion says nothing
constexpr double kLeastDistance_m = 0.05;  // nearer to the point, its direction says nothing

std::optional<double> direction(const Vec3& v, double least) {
  if (!(v.head<2>().norm() > least)) return {};
  return std::atan2(v.y(), v.x());
}

// The shorter way round.
double turn(double from, double to) {
  return std::remainder(to - from, 2.0 * std::numbers::pi);
}

Status check(const Trajectory& trajectory, const YawRequest& r) {
  if (auto status = trajectory.check(); !status) return status;
  if (!(std::isfinite(r.start_rad) && std::isfinite(r.fixed_rad) && is_finite(r.point_map))) {
    return fail(ErrorCode::invalid_input, "a yaw request is not finite");
  }
  if (!(std::isfinite(r.rate_max_rad_s) && r.rate_max_rad_s > 0.0)) {
    return fail(ErrorCode::invalid_limits,
                fmt::format("a yaw rate limit of {} rad/s: it must be finite and above zero",
                            r.rate_max_rad_s));
  }
  return success();
}

}  // namespace

std::optional<double> wanted_yaw_rad(const FlatState& state, const YawRequest& request) {
  switch (request.mode) {
    case YawMode::fixed:
      return request.fixed_rad;
    case YawMode::towards_point:
      return direction(request.point_map - state.position, kLeastDistance_m);
    case YawMode::along_motion:
      break;
  }
  return direction(state.velocity, kLeastSpeed_m_s);
}

double YawCurve::duration_s() const {
  return step_s * double(points_rad.size() - 2);
}

double YawCurve::yaw_rad(double t_s) const {
  const double u = std::clamp(t_s, 0.0, duration_s()) / step_s;
  const std::size_t k = std::min(std::size_t(u), points_rad.size() - 3);
  const double f = u - double(k);
  return 0.5 * ((1.0 - f) * (1.0 - f) * points_rad[k] +
                (1.0 + 2.0 * f * (1.0 - f)) * points_rad[k + 1] + f * f * points_rad[k + 2]);
}

double YawCurve::rate_rad_s(double t_s) const {
  const double u = std::clamp(t_s, 0.0, duration_s()) / step_s;
  const std::size_t k = std::min(std::size_t(u), points_rad.size() - 3);
  const double f = u - double(k);
  const double before = points_rad[k + 1] - points_rad[k];
  const double after = points_rad[k + 2] - points_rad[k + 1];
  return ((1.0 - f) * before + f * after) / step_s;
}

double YawCurve::rate_bound_rad_s() const {
  double most = 0.0;
  for (std::size_t k = 0; k + 1 < points_rad.size(); ++k) {
    most = std::max(most, std::abs(points_rad[k + 1] - points_rad[k]) / step_s);
  }
  return most;
}

Result<YawCurve> plan_yaw(const Trajectory& trajectory, const YawRequest& request) {
  if (auto status = check(trajectory, request); !status) return status.error();
  const double duration_s = trajectory.duration_s();
  const int steps = std::clamp(int(std::ceil(duration_s / kStep_s)), 1, kMostPoints);
  YawCurve curve;
  curve.step_s = duration_s / steps;
  const double most = request.rate_max_rad_s * curve.step_s * (1.0 - 1e-12);
  curve.points_rad = {request.start_rad, request.start_rad};  // begins at rest
  std::size_t piece = 0;
  double begin_s = 0.0;
  for (int k = 1; k <= steps; ++k) {
    const double t = duration_s * k / steps;
    while (piece + 1 < trajectory.pieces.size() &&
           t > begin_s + trajectory.pieces[piece].duration_s) {
      begin_s += trajectory.pieces[piece++].duration_s;
    }
    const BezierPiece& p = trajectory.pieces[piece];
    const auto goal = wanted_yaw_rad(p.sample(std::min(t - begin_s, p.duration_s)), request);
    const double now = curve.points_rad.back();
    const double step = goal ? std::clamp(turn(now, *goal), -most, most) : 0.0;
    curve.points_rad.push_back(now + step);
  }
  return curve;
}

}  // namespace goshawk::trajectory_optimizer
