#include "goshawk/stage/optimizer_component.hpp"
#include "goshawk/trajectory_optimizer/config.hpp"
#include "goshawk/trajectory_optimizer/trajectory_optimizer.hpp"

namespace goshawk::trajectory_optimizer {
namespace {

using TrajectoryOptimizerComponent = stage::OptimizerComponent<TrajectoryOptimizer, Config>;

}  // namespace
}  // namespace goshawk::trajectory_optimizer

GOSHAWK_REGISTER_COMPONENT(goshawk::trajectory_optimizer::TrajectoryOptimizerComponent,
                           goshawk::trajectory_optimizer::Config)
