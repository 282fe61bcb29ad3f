#pragma once

#include "goshawk/core/trajectory.hpp"
#include "goshawk/core/vehicle.hpp"
#include "goshawk/tracker/config.hpp"
#include "goshawk/tracker/disturbance_observer.hpp"

namespace goshawk::tracker {

/// Position and velocity errors to thrust, attitude and body rates.
///
/// `pd` (thesis, Simulation): the wanted acceleration is the trajectory's, plus position and
/// velocity errors times their gains; flatness turns it into thrust and attitude, and the
/// trajectory's jerk into body rates.
/// `geometric` (Lee, Leok, McClamroch 2010): thrust is only the part of the wanted force along the
/// body's real z axis, and body rates follow the wanted force with its feedback part.
class PositionController {
 public:
  /// What to fly: `now` belongs to the state's own time, `ahead` to when the command acts.
  struct Target {
    FlatState now;
    FlatState ahead;
    double yaw_rad = 0.0;
    double yaw_rate_rad_s = 0.0;
  };

  /// @pre check(config) ok
  explicit PositionController(const Config& config);

  /// @param dt_s [s] since the state of the previous call; 0 for the same state again
  /// @pre everything finite; unit quaternion
  AttitudeSetpoint step(const RigidBodyState& state, const Target& target, double dt_s);

  /// [m/s^2] what the disturbance observer has learnt
  const Vec3& disturbance_map() const { return observer_.disturbance_map(); }
  void reset();
  /// The next state does not follow on the last one; what was learnt of the wind is kept.
  void interrupt() { observer_.interrupt(); }

 private:
  Vec3 feedback(const Vec3& position_error, const Vec3& velocity_error) const;
  Vec3 limited(Vec3 specific_force) const;
  Vec3 modelled_acceleration(const RigidBodyState& state) const;

  bool geometric_;
  double mass_kg_;
  double min_force_m_s2_;  // thrust bounds over the mass
  double max_force_m_s2_;
  double max_slope_;  // tangent of the steepest tilt
  double max_position_error_m_;
  double max_feedback_m_s2_;
  double max_body_rate_rad_s_;
  Vec3 position_gain_1_s2_;
  Vec3 velocity_gain_1_s_;
  Vec3 drag_1_s_;  // over the mass
  DisturbanceObserver observer_;
  double last_force_m_s2_ = kGravity_m_s2;
};

}  // namespace goshawk::tracker
