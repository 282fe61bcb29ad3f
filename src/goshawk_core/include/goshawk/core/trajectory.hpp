#pragma once

#include <vector>

#include "goshawk/core/result.hpp"
#include "goshawk/core/vector.hpp"

namespace goshawk {

/// The flat state of the vehicle at one moment. Frame `map`.
struct FlatState {
  Vec3 position = Vec3::Zero();      // [m]
  Vec3 velocity = Vec3::Zero();      // [m/s]
  Vec3 acceleration = Vec3::Zero();  // [m/s^2]
  Vec3 jerk = Vec3::Zero();          // [m/s^3]

  bool is_finite() const {
    return position.allFinite() && velocity.allFinite() && acceleration.allFinite() &&
           jerk.allFinite();
  }
};

/// @return [m, m/s, m/s^2] the largest of how far positions, velocities and accelerations are
/// apart; NaN if any is
double largest_difference(const FlatState& a, const FlatState& b);

/// A quintic Bezier curve over [0, duration_s]; by the hull property it and its derivatives stay
/// inside the convex hull of their control points. Frame `map`.
struct BezierPiece {
  Points3<6> control_points = Points3<6>::Zero();  // [m] one column each
  double duration_s = 0.0;                         // [s] > 0
  int polytope = 0;                                // index of the polytope it stays in

  /// Control points of the derivatives (thesis, Bezier Curve Representation, corrected: docs/method.md).
  Points3<5> velocity_points() const;      // [m/s]
  Points3<4> acceleration_points() const;  // [m/s^2]
  Points3<3> jerk_points() const;          // [m/s^3]

  /// @param t_s [s] in [0, duration_s]
  FlatState sample(double t_s) const;

  /// The same curve up to t_s (de Casteljau's algorithm). @param t_s [s] in (0, duration_s]
  BezierPiece until(double t_s) const;

  /// The one quintic with these ends (position, velocity, acceleration; jerk is not used).
  static BezierPiece between(const FlatState& start, const FlatState& end, double duration_s);
};

/// Pieces one after another. Frame `map`.
struct Trajectory {
  std::vector<BezierPiece> pieces;

  double duration_s() const;
  /// [m] arc length, by Gauss-Legendre quadrature of the speed, 8 points a piece
  double length_m() const;
  /// [m^2/s^5] integral of the squared norm of the jerk
  double jerk_cost() const;

  /// @param t_s [s] @pre pieces not empty; t_s in [0, duration_s()] up to rounding (throws else:
  /// what to do beyond the end is the caller's decision)
  FlatState sample(double t_s) const;

  /// The same trajectory up to t_s. @pre as sample(), and t_s > 0
  Trajectory until(double t_s) const;

  /// Fastest speed and largest acceleration on the curve itself, not its hull, over equal steps of
  /// each piece. @pre samples_per_piece >= 1 (else throws)
  struct Peaks {
    double speed_m_s = 0.0;
    double acceleration_m_s2 = 0.0;
  };
  Peaks peaks(int samples_per_piece = 64) const;

  /// At least one piece, everything finite, durations above zero.
  Status check() const;
};

}  // namespace goshawk
