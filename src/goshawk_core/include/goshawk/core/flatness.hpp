#pragma once

#include "goshawk/core/vehicle.hpp"

namespace goshawk {

/// Differential flatness of the quadrotor (thesis, Problem Formulation; Mellinger and Kumar 2011):
/// the body's z axis lies along the specific force that the trajectory asks of the rotors, and
/// yaw turns it about there. Body rates follow from the force's derivative.
/// @param specific_force_map [m/s^2] acceleration without gravity, drag compensated; not zero, and
///        not horizontal at right angles to the heading
/// @param specific_force_rate_map [m/s^3] its derivative
/// @param yaw_rad, yaw_rate_rad_s heading of the body's x axis in the map (the first of the Euler
///        angles z, y, x, as in yaw_of), and its derivative
/// @return thrust [N] for mass_kg, attitude, and body rates in the axes of that attitude
AttitudeSetpoint thrust_attitude_of(const Vec3& specific_force_map,
                                    const Vec3& specific_force_rate_map, double yaw_rad,
                                    double yaw_rate_rad_s, double mass_kg);

/// @return the same angle in [-pi, pi]
double wrapped(double angle_rad);

}  // namespace goshawk
