#pragma once

#include "goshawk/plant/plant_model.hpp"

namespace goshawk::mujoco {

/// The quadrotor as a MuJoCo model (Todorov, Erez, Tassa 2012): one body with a free joint, and a
/// motor at each rotor's site that pushes along the body's z axis and twists about it. Rigid-body
/// dynamics and integration (semi-implicit, two steps in each of the autopilot's) are MuJoCo's;
/// drag is applied to the body as an external force, and the rotors' lag is solved exactly. It
/// shares the parameters with simulator::Plant, but no equation of motion.
/// @throws std::runtime_error if MuJoCo refuses the model: a bug, because parameters are checked
/// @pre parameters.check() ok
std::unique_ptr<plant::PlantModel> make_mujoco_plant(const plant::VehicleParameters& parameters);

}  // namespace goshawk::mujoco
