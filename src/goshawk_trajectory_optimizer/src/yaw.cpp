#include "goshawk/trajectory_optimizer/yaw.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace goshawk::trajectory_optimizer {
namespace {

constexpr double kStep_s = 0.05;
constexpr int kMostPoints = 100'000;
constexpr double kLeastSpeed_m_s = 0.05;   // slower, motion has no clear direction
constexpr double kLeastDistance_m = 0.05;  // nearer, the point has no clear direction

std::optional<double> direction(const Vec3& v, double least) {
  if (!(v.head<2>().norm() > least)) return {};
  return std::atan2(v.y(), v.x());
}

// The shorter way round.
double turn(double from, double to) {
  return std::remainder(to - from, 2.0 * std::numbers::pi);
}

/// The states of a trajectory at times that do not fall.
class Walk {
 public:
  explicit Walk(const Trajectory& trajectory) : trajectory_(trajectory) {}

  FlatState at(double t_s) {
    const auto& pieces = trajectory_.pieces;
    while (piece_ + 1 < pieces.size() && t_s > begin_s_ + pieces[piece_].duration_s) {
      begin_s_ += pieces[piece_++].duration_s;
    }
    const BezierPiece& piece = pieces[piece_];
    return piece.sample(std::min(t_s - begin_s_, piece.duration_s));
  }

 private:
  const Trajectory& trajectory_;
  std::size_t piece_ = 0;
  double begin_s_ = 0.0;
};

}  // namespace

std::optional<double> wanted_yaw_rad(const FlatState& state, const PlanRequest& request,
                                     const Config& config) {
  switch (config.yaw) {
    case YawMode::fixed:
      return request.goal_yaw_rad;
    case YawMode::along_motion:
      return direction(state.velocity, kLeastSpeed_m_s);
    case YawMode::towards_point: {
      const Vec3 point(config.yaw_point_x_m, config.yaw_point_y_m, 0.0);
      return direction(point - state.position, kLeastDistance_m);
    }
    case YawMode::none:
      break;
  }
  return {};
}

std::optional<YawCurve> plan_yaw(const Trajectory& trajectory, const PlanRequest& request,
                                 const Config& config) {
  if (config.yaw == YawMode::none) return {};
  const double duration_s = trajectory.duration_s();
  const int steps = std::clamp(int(std::ceil(duration_s / kStep_s)), 1, kMostPoints);
  YawCurve curve;
  curve.step_s = duration_s / steps;
  const double most = config.yaw_rate_max_rad_s * curve.step_s * (1.0 - 1e-12);
  // The curve begins in the middle of its first two points, with their difference as its rate.
  const double first = std::clamp(request.start_yaw_rate_rad_s * curve.step_s, -most, most);
  curve.points_rad = {request.start_yaw_rad - 0.5 * first, request.start_yaw_rad + 0.5 * first};
  Walk walk(trajectory);
  for (int k = 1; k <= steps; ++k) {
    const auto goal = wanted_yaw_rad(walk.at(duration_s * k / steps), request, config);
    const double now = curve.points_rad.back();
    const double step = goal ? std::clamp(turn(now, *goal), -most, most) : 0.0;
    curve.points_rad.push_back(now + step);
  }
  return curve;
}

}  // namespace goshawk::trajectory_optimizer
