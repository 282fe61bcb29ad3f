#pragma once

#include <span>

#include "goshawk/core/polytope.hpp"
#include "goshawk/core/trajectory.hpp"

namespace goshawk {

/// What a velocity or acceleration limit bounds: its Euclidean length, each component apart, or its
/// horizontal length and its vertical component apart.
enum class LimitNorm { euclidean, per_axis, horizontal_vertical };

struct Limits {
  double v_max_m_s = 2.0;   // [m/s] > 0
  double a_max_m_s2 = 2.0;  // [m/s^2] > 0
  LimitNorm norm = LimitNorm::euclidean;
  double j_max_m_s3 = 0.0;           // [m/s^3] of the jerk's Euclidean length; 0: no limit
  double v_max_vertical_m_s = 0.0;   // [m/s] horizontal_vertical only; 0: v_max_m_s
  double a_max_vertical_m_s2 = 0.0;  // [m/s^2] horizontal_vertical only; 0: a_max_m_s2

  /// @return invalid_limits, naming every limit that is not finite and above zero (j_max_m_s3 and
  /// the vertical ones: not finite or negative)
  Status check() const;

  /// How much of a limit is used: 1 at the limit. NaN where the vector or the limit is.
  double speed_usage(const Vec3& velocity) const;
  double acceleration_usage(const Vec3& acceleration) const;
};

/// What a start above a limit is allowed until it is back under it. Nothing where the start is
/// within the limits. Pieces that begin before `until_s` are held against these factors of the
/// limits, all others against the limits.
struct StartAllowance {
  double speed = 1.0;         // of the speed limit
  double acceleration = 1.0;  // of the acceleration limit
  double until_s = 0.0;       // [s] from the start of the trajectory

  /// The speed of the start, and a tenth of a second of its acceleration more (a vehicle that is
  /// speeding up cannot brake at once); its acceleration; and twice the time that braking takes,
  /// and half a second.
  static StartAllowance of(const FlatState& start, const Limits& limits);
};

/// The largest violation of each family of constraints, computed from the control points alone;
/// zero or below where a family holds. With position <= 0, velocity <= 0 and acceleration <= 0 the
/// hull property proves the whole curve safe and within limits (StartAllowance included). A family
/// that meets a NaN, an invalid polytope, an invalid limit or a duration that is not above zero is
/// NaN, and then the certificate does not hold.
struct Certificate {
  double position_m = 0.0;         // control points outside their polytope, max of A c - b
  double velocity_m_s = 0.0;       // velocity control points above v_max
  double acceleration_m_s2 = 0.0;  // acceleration control points above a_max
  double joint_position_m = 0.0;   // jumps between pieces
  double joint_velocity_m_s = 0.0;
  double joint_acceleration_m_s2 = 0.0;
  double start_m = 0.0;    // largest of position, velocity, acceleration error
  double goal_m = 0.0;     // likewise at the end
  double jerk_m_s3 = 0.0;  // jerk control points above j_max; 0 where there is no such limit
  // Not violations, but what the start's allowance was used for; 0 where there is none.
  double start_excess_m_s = 0.0;   // largest velocity control point above v_max
  double start_excess_m_s2 = 0.0;  // largest acceleration control point above a_max
  double start_excess_s = 0.0;     // from then on all is within the limits

  /// Every family within its tolerance: 1e-6 in its own unit.
  bool holds(double tolerance = 1e-6) const;
  /// Names the family that is violated most, for a sentence.
  std::string worst() const;
};

/// @param start, goal the states that the trajectory was asked to begin and end with
/// @pre at least one piece; each piece's polytope index within the span (else throws)
Certificate certify(const Trajectory& trajectory, std::span<const Polytope> polytopes,
                    const Limits& limits, const FlatState& start, const FlatState& goal);

}  // namespace goshawk
