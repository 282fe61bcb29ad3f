#pragma once

#include <algorithm>
#include <cmath>

#include "goshawk/core/certificate.hpp"
#include "goshawk/core/trajectory.hpp"

namespace goshawk::trajectory_optimizer {

/// The largest speed, acceleration and jerk of a piece's hull, in units of the limits.
struct Usage {
  double speed = 0.0;
  double acceleration = 0.0;
  double jerk = 0.0;
};

inline Usage usage_of(const BezierPiece& piece, const Limits& limits) {
  Usage u;
  const auto v = piece.velocity_points();
  const auto a = piece.acceleration_points();
  for (int j = 0; j < v.cols(); ++j) u.speed = std::max(u.speed, limits.speed_usage(v.col(j)));
  for (int j = 0; j < a.cols(); ++j) {
    u.acceleration = std::max(u.acceleration, limits.acceleration_usage(a.col(j)));
  }
  if (limits.j_max_m_s3 > 0.0) {
    u.jerk = piece.jerk_points().colwise().norm().maxCoeff() / limits.j_max_m_s3;
  }
  return u;
}

/// Of a piece that may use only this share of the acceleration limit.
inline Usage usage_of(const BezierPiece& piece, const Limits& limits, double a_factor) {
  Usage u = usage_of(piece, limits);
  u.acceleration /= a_factor;
  return u;
}

/// By what the durations of a flight from rest to rest must be multiplied, at least.
inline double time_factor(const Usage& u) {
  return std::max({u.speed, std::sqrt(u.acceleration), std::cbrt(u.jerk)});
}

}  // namespace goshawk::trajectory_optimizer
