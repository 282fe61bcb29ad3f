#include "goshawk/simulator/quadrotor.hpp"
#include "goshawk/stage/plant_component.hpp"

namespace goshawk::simulator {
namespace {

class SimulatorComponent : public stage::PlantComponent<Quadrotor> {
 public:
  explicit SimulatorComponent(runtime::Node& node) : PlantComponent(node, make_rigid_body) {}
};

}  // namespace
}  // namespace goshawk::simulator

GOSHAWK_REGISTER_COMPONENT(goshawk::simulator::SimulatorComponent,
                           goshawk::simulator::SimulatorComponent::Config)
