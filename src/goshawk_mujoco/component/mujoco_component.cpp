#include "goshawk/mujoco/mujoco_plant.hpp"
#include "goshawk/simulator/plant_component.hpp"

namespace goshawk::mujoco {
namespace {

class MujocoComponent : public simulator::PlantComponent {
 public:
  explicit MujocoComponent(runtime::Node& node) : PlantComponent(node, make_mujoco_plant) {}
};

}  // namespace
}  // namespace goshawk::mujoco

GOSHAWK_REGISTER_COMPONENT(goshawk::mujoco::MujocoComponent, goshawk::simulator::ComponentConfig)
