#pragma once

#include "goshawk/core/result.hpp"
#include "goshawk/core/vehicle.hpp"

namespace goshawk::simulator {

/// The physics of one quadrotor: four rotors in an X, at equal distance from the centre of mass.
/// The defaults are a vehicle of 1 kg and 34 cm (rotor axis to rotor axis) with a thrust-to-weight
/// ratio of 2.86. Frame `base_link` (FLU).
struct VehicleParameters {
  double mass_kg = 1.0;
  double inertia_xx_kg_m2 = 0.008;
  double inertia_yy_kg_m2 = 0.008;
  double inertia_zz_kg_m2 = 0.014;
  double inertia_xy_kg_m2 = 0.0;
  double inertia_xz_kg_m2 = 0.0;
  double inertia_yz_kg_m2 = 0.0;
  double arm_length_m = 0.17;                 // centre of mass to each rotor's axis
  double max_motor_thrust_n = 7.0;            // of one motor
  double thrust_coefficient_n_s2 = 8.5e-6;    // thrust = coefficient * (rotor speed)^2
  double torque_coefficient_nm_s2 = 1.36e-7;  // reaction torque = coefficient * (rotor speed)^2
  double motor_time_constant_s = 0.03;  // rotor speed follows its command as a first-order lag
  double linear_drag_xy_kg_s = 0.25;    // rotor drag, along body x and y
  double linear_drag_z_kg_s = 0.15;     // rotor drag, along body z
  double quadratic_drag_kg_m = 0.02;    // body drag, F = -c |v| v

  Eigen::Matrix3d inertia_kg_m2() const;
  double weight_n() const { return mass_kg * kGravity_m_s2; }
  double max_thrust_n() const { return 4.0 * max_motor_thrust_n; }
  double max_rotor_speed_rad_s() const;

  /// @return invalid_parameter with every value that no real vehicle can have: not finite, mass or
  /// a coefficient not above zero, drag below zero, an inertia that is not positive definite or
  /// whose principal moments break the triangle inequality, full thrust that does not lift the
  /// weight.
  Status check() const;
};

}  // namespace goshawk::simulator
