#include "goshawk/core/thrust.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "goshawk/core/vehicle.hpp"

namespace goshawk {
namespace {

ThrustUse worse(const ThrustUse& a, const ThrustUse& b) {
  return {std::max(a.thrust_most_m_s2, b.thrust_most_m_s2),
          std::min(a.thrust_least_m_s2, b.thrust_least_m_s2), std::max(a.tilt_rad, b.tilt_rad)};
}

constexpr ThrustUse kNothing{0.0, std::numeric_limits<double>::infinity(), 0.0};

}  // namespace

double ThrustLimits::safe_acceleration_m_s2() const {
  double safe = std::numeric_limits<double>::infinity();
  if (thrust_max_m_s2 > 0.0) safe = std::min(safe, thrust_max_m_s2 - kGravity_m_s2);
  if (thrust_min_m_s2 > 0.0) safe = std::min(safe, kGravity_m_s2 - thrust_min_m_s2);
  if (tilt_max_rad > 0.0) safe = std::min(safe, kGravity_m_s2 * std::sin(tilt_max_rad));
  return safe;
}

ThrustUse thrust_of(const BezierPiece& piece) {
  const auto points = piece.acceleration_points();
  ThrustUse use = kNothing;
  for (int j = 0; j < points.cols(); ++j) {
    const Vec3 f = points.col(j) + Vec3(0.0, 0.0, kGravity_m_s2);
    use = worse(use, {f.norm(), f.z(), std::atan2(f.head<2>().norm(), f.z())});
  }
  return use;
}

ThrustUse thrust_of(const Trajectory& trajectory) {
  ThrustUse use = kNothing;
  for (const BezierPiece& piece : trajectory.pieces) use = worse(use, thrust_of(piece));
  return use;
}

bool respects(const ThrustUse& use, const ThrustLimits& limits) {
  constexpr double kRounding = 1e-6;
  return (limits.thrust_max_m_s2 <= 0.0 ||
          use.thrust_most_m_s2 <= limits.thrust_max_m_s2 + kRounding) &&
         (limits.thrust_min_m_s2 <= 0.0 ||
          use.thrust_least_m_s2 >= limits.thrust_min_m_s2 - kRounding) &&
         (limits.tilt_max_rad <= 0.0 || use.tilt_rad <= limits.tilt_max_rad + kRounding);
}

}  // namespace goshawk
