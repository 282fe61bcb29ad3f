#pragma once

#include <span>
#include <string>

#include "goshawk/core/limits.hpp"
#include "goshawk/core/polytope.hpp"
#include "goshawk/core/trajectory.hpp"

namespace goshawk {

/// The largest violation of each family of constraints, computed from the control points alone;
/// zero or below if a family holds. With position <= 0, velocity <= 0 and acceleration <= 0 the
/// hull property proves the whole curve safe and within limits (StartAllowance included). A family
/// that meets a NaN, an invalid polytope, an invalid limit or a duration that is not above zero is
/// NaN, and then the certificate does not hold.
struct Certificate {
  double position_m = 0.0;         // control points outside their polytope, max of A c - b
  double validity_s = 0.0;         // pieces outside their polytope's interval; 0: no piece has one
  double velocity_m_s = 0.0;       // velocity control points above v_max
  double acceleration_m_s2 = 0.0;  // acceleration control points above a_max
  double jerk_m_s3 = 0.0;          // jerk control points above j_max; 0: there is no such limit
  double continuity_position_m = 0.0;  // jumps between pieces
  double continuity_velocity_m_s = 0.0;
  double continuity_acceleration_m_s2 = 0.0;
  double start_m = 0.0;  // largest of position, velocity, acceleration error
  double goal_m = 0.0;   // the same at the end
  // Not violations, but what the start's allowance was used for; 0: nothing.
  double start_excess_m_s = 0.0;   // largest velocity control point above v_max
  double start_excess_m_s2 = 0.0;  // largest acceleration control point above a_max
  double start_excess_s = 0.0;     // from then on all is within the limits

  /// Every family within its tolerance: 1e-6 in its own unit.
  bool holds(double tolerance = 1e-6) const;
  /// Names the family that is violated most, for a sentence.
  std::string worst() const;
};

/// @param polytopes their intervals count from the start of the trajectory
/// @param start, goal the states that the trajectory was asked to begin and end with
/// @pre at least one piece; each piece's polytope index within the span (else throws)
Certificate measure(const Trajectory& trajectory, std::span<const Polytope> polytopes,
                    const Limits& limits, const FlatState& start, const FlatState& goal);

}  // namespace goshawk
