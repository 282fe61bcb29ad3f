#pragma once

#include "goshawk/core/vehicle.hpp"
#include "goshawk/simulator/mixer.hpp"

namespace goshawk::simulator {

/// Gains of the onboard attitude loop. They multiply the inertia, so that they mean the same for
/// every vehicle: angular acceleration for an error in angle and in rate.
struct AttitudeGains {
  double tilt_1_s2 = 250.0;  // roll and pitch
  double tilt_rate_1_s = 25.0;
  double yaw_1_s2 = 30.0;
  double yaw_rate_1_s = 9.0;
};

/// PD control on the rotation group, as an autopilot runs onboard: torque from the rotation that
/// is left to the wanted attitude (twice the vector part of its quaternion, the short way round)
/// and from the difference to the wanted body rates, plus the gyroscopic term. The error is
/// bounded and smooth up to half a turn (Lee, Leok, McClamroch 2010; Brescianini et al. 2013).
/// @pre state and wanted are finite, quaternions of unit length
Wrench attitude_control(const AttitudeGains& gains, const Eigen::Matrix3d& inertia_kg_m2,
                        const RigidBodyState& state, const AttitudeSetpoint& wanted);

}  // namespace goshawk::simulator
