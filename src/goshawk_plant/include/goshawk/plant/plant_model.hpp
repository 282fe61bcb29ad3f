#pragma once

#include <functional>
#include <memory>

#include "goshawk/plant/vehicle_parameters.hpp"

namespace goshawk::plant {

/// Twelve states of the body and four of the rotors.
struct PlantState {
  RigidBodyState body;
  Vec4 rotor_speed_rad_s = Vec4::Zero();
};

/// What moves when rotors turn: all that an autopilot knows of a simulated plant. goshawk_simulator
/// has one, goshawk_mujoco another; the autopilot, the wind and the sensors are the same for both.
/// The same calls give the same bits.
class PlantModel {
 public:
  virtual ~PlantModel() = default;

  virtual void reset(const PlantState& state) = 0;
  /// @param rotor_command_rad_s wanted rotor speeds, constant over the step, like the wind
  /// @param wind_map [m/s] @param dt_s > 0
  virtual void step(const Vec4& rotor_command_rad_s, const Vec3& wind_map, double dt_s) = 0;
  virtual const PlantState& state() const = 0;
  /// [m/s^2] of the centre of mass, gravity and all forces included (zero at hover)
  virtual Vec3 acceleration_map(const Vec3& wind_map) const = 0;
  /// For reports: how it integrates.
  virtual const char* name() const = 0;
};

/// @pre parameters.check() ok
using PlantFactory = std::function<std::unique_ptr<PlantModel>(const VehicleParameters&)>;

}  // namespace goshawk::plant
