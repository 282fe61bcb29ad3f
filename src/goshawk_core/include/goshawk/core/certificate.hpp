#pragma once

#include <span>

#include "goshawk/core/polytope.hpp"
#include "goshawk/core/trajectory.hpp"

namespace goshawk {

/// What a velocity or acceleration limit bounds: its Euclidean length, or each component apart.
enum class LimitNorm { euclidean, per_axis, horizontal_vertical };

struct Limits {
  double v_max_m_s = 2.0;   // [m/s] > 0
  double a_max_m_s2 = 2.0;  // [m/s^2] > 0
  LimitNorm norm = LimitNorm::euclidean;

  /// @return invalid_limits, naming every limit that is not finite and above zero
  Status check() const;
};

/// The largest violation of each family of constraints, computed from the control points alone;
/// zero or below where a family holds. With position <= 0, velocity <= 0 and acceleration <= 0 the
/// hull property proves the whole curve safe and within limits. A family that meets a NaN, an
/// invalid polytope, an invalid limit or a duration that is not above zero is NaN, and then the
/// certificate does not hold.
struct Certificate {
  double position_m = 0.0;         // control points outside their polytope, max of A c - b
  double velocity_m_s = 0.0;       // velocity control points above v_max
  double acceleration_m_s2 = 0.0;  // acceleration control points above a_max
  double joint_position_m = 0.0;   // jumps between pieces
  double joint_velocity_m_s = 0.0;
  double joint_acceleration_m_s2 = 0.0;
  double start_m = 0.0;  // largest of position, velocity, acceleration error
  double goal_m = 0.0;   // likewise at the end

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
