#pragma once

#include "goshawk/plant/plant_model.hpp"

namespace goshawk::mujoco {

/// The quadrotor as MuJoCo (Todorov, Erez, Tassa 2012) sees it: one body with a free joint, and a
/// motor at each rotor's site that pushes along the body's z axis and twists about it. Rigid-body
/// dynamics and integration (semi-implicit, two steps in each of the autopilot's) are MuJoCo's;
/// drag is applied to the body from outside, and the rotors' lag is solved exactly. It shares the
/// parameters with simulator::Plant, and no equation of motion.
/// @throws std::runtime_error where MuJoCo refuses the model: a bug, as parameters are checked
/// @pre parameters.check() ok
std::unique_ptr<plant::PlantModel> make_mujoco_plant(const plant::VehicleParameters& parameters);

}  // namespace goshawk::mujoco
