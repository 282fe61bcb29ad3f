#include "goshawk/core/yaw_curve.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace goshawk {
namespace {

// The span of a curve that a time falls into: between the points k and k + 2.
struct Place {
  double fraction;  // of the span
  double knot;      // [rad] at the beginning of the span
  double before;    // [rad] from point k to point k + 1
  double after;     // [rad] from point k + 1 to point k + 2
};

Place place(const YawCurve& curve, double t_s) {
  const std::size_t spans = curve.points_rad.size() - 2;
  const double u = std::clamp(t_s / curve.step_s, 0.0, double(spans));
  const std::size_t k = std::min(std::size_t(u), spans - 1);
  const double* p = curve.points_rad.data() + k;
  return {u - double(k), 0.5 * (p[0] + p[1]), p[1] - p[0], p[2] - p[1]};
}

}  // namespace

Status YawCurve::check() const {
  if (points_rad.size() < 3) {
    return fail(
        ErrorCode::invalid_input,
        fmt::format("a yaw curve has {} points: it needs three or more", points_rad.size()));
  }
  if (!(step_s > 0.0 && std::isfinite(step_s))) {
    return fail(ErrorCode::invalid_input,
                fmt::format("a yaw curve has a step of {:.3g} s: it must be finite and above zero",
                            step_s));
  }
  if (std::ranges::all_of(points_rad, [](double v) { return std::isfinite(v); })) return success();
  return fail(ErrorCode::invalid_input, "a yaw curve has a point that is not finite");
}

double YawCurve::yaw_rad(double t_s) const {
  const Place at = place(*this, t_s);
  const double f = at.fraction;
  return at.knot + f * at.before + 0.5 * f * f * (at.after - at.before);
}

double YawCurve::rate_rad_s(double t_s) const {
  if (t_s < 0.0 || t_s > duration_s()) return 0.0;
  const Place at = place(*this, t_s);
  return ((1.0 - at.fraction) * at.before + at.fraction * at.after) / step_s;
}

}  // namespace goshawk
