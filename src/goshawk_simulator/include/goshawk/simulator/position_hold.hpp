#pragma once

#include "goshawk/core/vehicle.hpp"
#include "goshawk/plant/vehicle_parameters.hpp"

namespace goshawk::simulator {

/// What an autopilot does when offboard control is lost: it brakes, then hovers where the vehicle
/// came to rest, with the yaw it had. Braking is as hard as max_tilt_rad and the motors
/// allow (a margin of thrust is kept for attitude control).
class PositionHold {
 public:
  /// @pre parameters.check() ok; 0 < max_tilt_rad < pi/2
  PositionHold(const plant::VehicleParameters& parameters, double max_tilt_rad);

  /// Brakes from here on, then hovers where that ends.
  void engage(const RigidBodyState& state);
  /// Hovers at this point.
  void engage_at(const Vec3& position_map, double yaw_rad);

  /// Lowers the point of hover by step_m, but not below floor_map_m.
  void lower(double step_m, double floor_map_m);

  /// @param disturbance_map [m/s^2] what wind and drag do to the vehicle; compensated
  AttitudeSetpoint step(const RigidBodyState& state, const Vec3& disturbance_map = Vec3::Zero());

  bool braking() const { return braking_; }
  /// [m] point of hover; while braking, the place of engagement
  const Vec3& position_map() const { return position_map_; }

 private:
  plant::VehicleParameters parameters_;
  double max_tilt_rad_;
  bool braking_ = false;
  Vec3 position_map_ = Vec3::Zero();
  double yaw_rad_ = 0.0;
};

}  // namespace goshawk::simulator
