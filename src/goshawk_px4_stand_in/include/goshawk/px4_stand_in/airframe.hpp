#pragma once

#include "goshawk/core/result.hpp"
#include "goshawk/px4_stand_in/config.hpp"
#include "goshawk/simulator/quadrotor.hpp"

namespace goshawk::px4_stand_in {

/// The vehicle behind the stand-in: our quadrotor's physics in the air, and a ground to stand on.
/// Frame `map`.
class Airframe {
 public:
  static constexpr double kStep_s = 0.004;

  /// @return invalid_parameter with every fault of the configuration
  static Result<Airframe> create(const Config& config);

  /// One step of kStep_s. On the ground the motors may turn, but it stays where it is.
  void step(const AttitudeSetpoint& command);
  /// Leaves the ground. @pre on_ground()
  void lift_off();
  /// Motors off in the air: it falls.
  void cut() { cut_ = true; }

  bool on_ground() const { return on_ground_; }
  const RigidBodyState& state() const { return on_ground_ ? standing_ : quadrotor_.state(); }
  /// [m/s] with which it last touched the ground
  double touched_m_s() const { return touched_m_s_; }
  double mass_kg() const { return quadrotor_.config().vehicle.mass_kg; }

 private:
  Airframe(simulator::Quadrotor quadrotor, const Config& config);

  simulator::Quadrotor quadrotor_;
  double ground_z_m_;
  RigidBodyState standing_;
  bool on_ground_ = true;
  bool cut_ = false;
  double touched_m_s_ = 0.0;
};

}  // namespace goshawk::px4_stand_in
