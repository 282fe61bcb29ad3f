#pragma once

#include "goshawk/core/trajectory.hpp"

namespace goshawk {

/// What a multirotor can do: thrust along its own axis, over its mass, and how far that axis may
/// tilt. Zero: not limited.
struct ThrustLimits {
  double thrust_max_m_s2 = 0.0;  // [m/s^2]
  double thrust_min_m_s2 = 0.0;  // [m/s^2]
  double tilt_max_rad = 0.0;     // [rad] below pi / 2

  bool none() const {
    return thrust_max_m_s2 <= 0.0 && thrust_min_m_s2 <= 0.0 && tilt_max_rad <= 0.0;
  }
  /// The largest acceleration that respects all of them in every direction; negative if even
  /// hovering does not.
  double safe_acceleration_m_s2() const;
};

/// Bounds over a piece, by differential flatness (Mellinger and Kumar, "Minimum Snap Trajectory
/// Generation and Control for Quadrotors", ICRA 2011): the thrust over the mass is f = a + g e_z.
/// f lies in the hull of its control points, and the three conditions are convex (or, for the
/// least thrust, bounded by the vertical part), so the points prove them for the whole curve.
struct ThrustUse {
  double thrust_most_m_s2 = 0.0;
  double thrust_least_m_s2 = 0.0;  // of the vertical part
  double tilt_rad = 0.0;           // above pi / 2 if f points down
};
ThrustUse thrust_of(const BezierPiece& piece);
ThrustUse thrust_of(const Trajectory& trajectory);

bool respects(const ThrustUse& use, const ThrustLimits& limits);

}  // namespace goshawk
