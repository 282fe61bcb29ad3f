#pragma once

#include <concepts>
#include <type_traits>

#include "goshawk/core/parameter.hpp"
#include "goshawk/core/result.hpp"
#include "goshawk/core/vehicle.hpp"

namespace goshawk::plant {

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

  /// @return invalid_parameter with every value that no real vehicle can have: not finite, mass or
  /// a coefficient not above zero, drag below zero, an inertia that is not positive definite or
  /// whose principal moments break the triangle inequality, full thrust that does not lift the
  /// weight.
  Status check() const;
};

template <typename Self, typename Visitor>
requires std::same_as<std::remove_const_t<Self>, VehicleParameters>
void describe(Self& v, Visitor&& visit) {
  const auto positive = Range::positive();
  const Range any_drag{0.0, 100.0};
  visit("mass_kg", v.mass_kg, "kg", "mass of the vehicle", positive);
  visit("inertia_xx_kg_m2", v.inertia_xx_kg_m2, "kg m^2", "moment of inertia about x", positive);
  visit("inertia_yy_kg_m2", v.inertia_yy_kg_m2, "kg m^2", "moment of inertia about y", positive);
  visit("inertia_zz_kg_m2", v.inertia_zz_kg_m2, "kg m^2", "moment of inertia about z", positive);
  visit("inertia_xy_kg_m2", v.inertia_xy_kg_m2, "kg m^2", "entry xy of the inertia", Anything{});
  visit("inertia_xz_kg_m2", v.inertia_xz_kg_m2, "kg m^2", "entry xz of the inertia", Anything{});
  visit("inertia_yz_kg_m2", v.inertia_yz_kg_m2, "kg m^2", "entry yz of the inertia", Anything{});
  visit("arm_length_m", v.arm_length_m, "m", "centre of mass to each rotor's axis", positive);
  visit("max_motor_thrust_n", v.max_motor_thrust_n, "N", "full thrust of one motor", positive);
  visit("thrust_coefficient_n_s2", v.thrust_coefficient_n_s2, "N s^2",
        "thrust of a rotor for its speed in rad/s squared", positive);
  visit("torque_coefficient_nm_s2", v.torque_coefficient_nm_s2, "N m s^2",
        "reaction torque of a rotor for its speed in rad/s squared", positive);
  visit("motor_time_constant_s", v.motor_time_constant_s, "s",
        "lag of the rotor speed behind its command", Range{0.002, 10.0});
  visit("linear_drag_xy_kg_s", v.linear_drag_xy_kg_s, "kg/s",
        "rotor drag along body x and y, for the speed through the air", any_drag);
  visit("linear_drag_z_kg_s", v.linear_drag_z_kg_s, "kg/s", "rotor drag along body z", any_drag);
  visit("quadratic_drag_kg_m", v.quadratic_drag_kg_m, "kg/m",
        "body drag, for the speed through the air squared", any_drag);
}

}  // namespace goshawk::plant
