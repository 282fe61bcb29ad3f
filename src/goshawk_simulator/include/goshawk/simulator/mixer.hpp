#pragma once

#include "goshawk/plant/vehicle_parameters.hpp"

namespace goshawk::simulator {

/// Force and torque of the four rotors on the body. Frame `base_link`.
struct Wrench {
  double thrust_n = 0.0;  // along z
  Vec3 torque_base_nm = Vec3::Zero();
};

/// Converts between the four rotor thrusts and the wrench. Rotor order: front left, rear left, rear
/// right, front right; neighbours turn in opposite senses.
class Mixer {
 public:
  /// @pre parameters.check() ok
  explicit Mixer(const plant::VehicleParameters& parameters);

  Wrench wrench(const Vec4& rotor_thrust_n) const;

  /// Rotor thrusts in [0, max_motor_thrust_n] that give the wanted wrench if the motors can. If
  /// they cannot, roll and pitch torque come first (without them the vehicle tumbles), then
  /// collective thrust, then yaw torque, which may reduce thrust by at most a tenth of a motor's
  /// maximum. After Faessler, Falanga, Scaramuzza 2017 (RA-L), section on saturation.
  /// @pre wanted is finite
  Vec4 allocate(const Wrench& wanted) const;

 private:
  double max_n_;
  double lever_m_;           // distance of each rotor's axis from the body's x and y axes
  double yaw_per_thrust_m_;  // reaction torque for a newton of thrust
};

}  // namespace goshawk::simulator
