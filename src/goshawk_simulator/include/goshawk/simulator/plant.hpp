#pragma once

#include "goshawk/plant/plant_model.hpp"
#include "goshawk/plant/vehicle_parameters.hpp"
#include "goshawk/simulator/mixer.hpp"

namespace goshawk::simulator {

/// The equations of motion (thesis, Problem Formulation; Newton and Euler, quaternions in place of
/// Euler angles, which are singular at 90 degrees of pitch) with first-order motors, rotor drag
/// (linear, in the body's axes: Faessler, Franchi, Scaramuzza 2018) and body drag (quadratic).
class Plant {
 public:
  /// @pre parameters.check() ok
  explicit Plant(const plant::VehicleParameters& parameters);

  /// One Runge-Kutta step of fourth order; rotor commands and wind are constant in it. The
  /// quaternion comes back normalised.
  /// @param rotor_command_rad_s wanted rotor speeds @param wind_map [m/s] @param dt_s > 0
  plant::PlantState step(const plant::PlantState& state, const Vec4& rotor_command_rad_s,
                         const Vec3& wind_map, double dt_s) const;

  /// [m/s^2] of the centre of mass, gravity and all forces included (zero at hover)
  Vec3 acceleration_map(const plant::PlantState& state, const Vec3& wind_map) const;

  Vec4 rotor_thrust_n(const Vec4& rotor_speed_rad_s) const;
  /// Inverse of the above, for thrusts in [0, max_motor_thrust_n].
  Vec4 rotor_speed_rad_s(const Vec4& rotor_thrust_n) const;

  const plant::VehicleParameters& parameters() const { return parameters_; }
  const Mixer& mixer() const { return mixer_; }
  const Eigen::Matrix3d& inertia_kg_m2() const { return inertia_kg_m2_; }

 private:
  using Packed = Eigen::Matrix<double, 17, 1>;
  Packed derivative(const Packed& x, const Vec4& rotor_command_rad_s, const Vec3& wind_map) const;

  plant::VehicleParameters parameters_;
  Mixer mixer_;
  Eigen::Matrix3d inertia_kg_m2_;
  Eigen::Matrix3d inverse_inertia_;
};

/// Plant behind the interface that the autopilot knows.
/// @pre parameters.check() ok
std::unique_ptr<plant::PlantModel> make_rigid_body(const plant::VehicleParameters& parameters);

}  // namespace goshawk::simulator
