#include "goshawk/mujoco/mujoco_plant.hpp"
#include "goshawk/simulator/quadrotor.hpp"
#include "goshawk/stage/plant_component.hpp"

namespace goshawk::mujoco {
namespace {

/// The simulator's autopilot, wind and sensors around MuJoCo's plant.
class MujocoComponent : public stage::PlantComponent<simulator::Quadrotor> {
 public:
  explicit MujocoComponent(runtime::Node& node) : PlantComponent(node, make_mujoco_plant) {}
};

}  // namespace
}  // namespace goshawk::mujoco

GOSHAWK_REGISTER_COMPONENT(goshawk::mujoco::MujocoComponent,
                           goshawk::mujoco::MujocoComponent::Config)
