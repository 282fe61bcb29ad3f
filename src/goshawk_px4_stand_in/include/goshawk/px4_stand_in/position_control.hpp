#pragma once

#include "goshawk/core/vehicle.hpp"
#include "goshawk/px4_wire/commands.hpp"

namespace goshawk::px4_stand_in {

/// The vehicle as PX4 believes it to be. NED, FRD.
struct LocalState {
  Vec3 position = Vec3::Zero();                            // [m]
  Vec3 velocity = Vec3::Zero();                            // [m/s]
  Eigen::Matrix3d attitude = Eigen::Matrix3d::Identity();  // FRD to NED
};

/// Specific force [m/s^2] and the attitude whose -z lies along it. NED, FRD.
struct Thrust {
  double acceleration_m_s2 = 0.0;
  Eigen::Matrix3d attitude = Eigen::Matrix3d::Identity();
};

/// PX4's multicopter position controller with its default gains (MPC_XY_P, MPC_Z_P,
/// MPC_XY_VEL_*_ACC, MPC_Z_VEL_*_ACC without the differential part) and limits: position and
/// velocity errors become an acceleration, which becomes thrust and tilt. NaN: not controlled.
class PositionControl {
 public:
  void reset() { integral_.setZero(); }
  /// @param hover_thrust of 0 to 1 that carries the weight
  Thrust step(const LocalState& state, const px4::TrajectorySetpoint& setpoint, double hover_thrust,
              double dt_s);

 private:
  Vec3 integral_ = Vec3::Zero();  // [m/s^2]
};

}  // namespace goshawk::px4_stand_in
