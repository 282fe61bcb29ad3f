#include "goshawk/simulator/plant_component.hpp"

namespace goshawk::simulator {
namespace {

class SimulatorComponent : public PlantComponent {
 public:
  explicit SimulatorComponent(runtime::Node& node) : PlantComponent(node, make_rigid_body) {}
};

}  // namespace
}  // namespace goshawk::simulator

GOSHAWK_REGISTER_COMPONENT(goshawk::simulator::SimulatorComponent,
                           goshawk::simulator::ComponentConfig)
