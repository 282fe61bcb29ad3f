#pragma once

#include "goshawk/plant/vehicle_parameters.hpp"

namespace goshawk::simulator {

/// [N] the force of the rotors that accelerates the vehicle so, as far as tilt and motors allow; a
/// share of the thrust is kept for attitude control. The vertical part is served first: losing
/// height is worse than braking later.
/// @param acceleration_map [m/s^2], gravity not included
Vec3 limited_force(const plant::VehicleParameters& parameters, double max_tilt_rad,
                   const Vec3& acceleration_map);

}  // namespace goshawk::simulator
