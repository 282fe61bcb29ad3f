#pragma once

#include <optional>
#include <vector>

#include "goshawk/core/result.hpp"
#include "goshawk/core/trajectory.hpp"

namespace goshawk::trajectory_optimizer {

enum class YawMode { along_motion, fixed, towards_point };

struct YawRequest {
  YawMode mode = YawMode::along_motion;
  double start_rad = 0.0;         // where the vehicle looks now; map, from x to y
  double fixed_rad = 0.0;         // fixed only
  Vec3 point_map = Vec3::Zero();  // [m] towards_point only
  double rate_max_rad_s = 1.5;    // > 0
};

/// The fourth flat output: a uniform quadratic B-spline of yaw over time. Its rate is the linear
/// interpolation of the differences of its control points, so these prove the rate limit for all
/// times, as the hull of a Bezier curve does.
struct YawCurve {
  double step_s = 0.0;             // [s] between knots
  std::vector<double> points_rad;  // unwrapped: they may leave (-pi, pi]

  double duration_s() const;
  /// @param t_s is clamped to [0, duration_s()]. @pre three points or more
  double yaw_rad(double t_s) const;
  double rate_rad_s(double t_s) const;
  /// [rad/s] of the whole curve
  double rate_bound_rad_s() const;
};

/// Where a request looks from a state, in (-pi, pi]; nothing where it does not say: motion that is
/// slow or vertical, a point right above or below.
std::optional<double> wanted_yaw_rad(const FlatState& state, const YawRequest& request);

/// Turns from the start's yaw towards what is asked for as fast as the rate allows, the shorter way
/// round, and then follows it. Where the vehicle moves up, down or hardly at all, or is over the
/// point, yaw stays.
/// @return invalid_input (no trajectory, not finite), invalid_limits (rate not above zero)
Result<YawCurve> plan_yaw(const Trajectory& trajectory, const YawRequest& request);

}  // namespace goshawk::trajectory_optimizer
