#include "goshawk/baselines/baseline_optimizer.hpp"
#include "goshawk/stage/optimizer_component.hpp"

namespace goshawk::baselines {
namespace {

/// In the place of trajectory_optimizer.
using BaselineOptimizerComponent = stage::OptimizerComponent<BaselineOptimizer, Config>;

}  // namespace
}  // namespace goshawk::baselines

GOSHAWK_REGISTER_COMPONENT(goshawk::baselines::BaselineOptimizerComponent,
                           goshawk::baselines::Config)
