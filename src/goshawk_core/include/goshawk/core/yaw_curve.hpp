#pragma once

#include <vector>

#include "goshawk/core/result.hpp"

namespace goshawk {

/// Heading over time, the fourth flat output: a uniform quadratic B-spline. Its rate is the linear
/// interpolation of the differences of its control points, so these prove a rate limit for all
/// times, as the hull of a Bezier curve does.
struct YawCurve {
  double step_s = 0.0;             // [s] between knots, > 0
  std::vector<double> points_rad;  // three or more; map, from x to y; may leave (-pi, pi]

  /// @return invalid_input: fewer than three points, a step not above zero, or not finite
  Status check() const;

  double duration_s() const { return step_s * double(points_rad.size() - 2); }
  /// @param t_s [s] since the start, clamped to [0, duration_s()] @pre check() ok
  double yaw_rad(double t_s) const;
  double rate_rad_s(double t_s) const;  // 0 outside of [0, duration_s()]
};

}  // namespace goshawk
