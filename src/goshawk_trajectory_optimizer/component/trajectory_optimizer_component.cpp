#include <functional>

#include "goshawk/runtime/component.hpp"
#include "goshawk/stage/intake.hpp"
#include "goshawk/trajectory_optimizer/config.hpp"
#include "goshawk/trajectory_optimizer/trajectory_optimizer.hpp"

namespace goshawk::trajectory_optimizer {
namespace {

using namespace goshawk::runtime;
using namespace goshawk::stage;
namespace msg = goshawk_msgs::msg;

TrajectoryOptimizer make_optimizer(const Config& config) {
  auto optimizer = TrajectoryOptimizer::create(config);
  if (!optimizer) throw StartupFault(optimizer.error());
  return *std::move(optimizer);
}

/// corridor -> trajectory
class TrajectoryOptimizerComponent : public Component {
 public:
  explicit TrajectoryOptimizerComponent(Node& node)
      : node_(node),
        optimizer_(make_optimizer(
            node.parameters<Config>([this](const Config& c) { return reconfigure(c); }))),
        reporter_(node, StageRole::trajectory_optimizer, std::string(optimizer_.implementation())),
        publisher_(node.advertise<msg::BezierTrajectory>("trajectory", Qos::reliable_last())),
        corridors_(node, reporter_, "corridor",
                   std::bind_front(&TrajectoryOptimizerComponent::on_corridor, this)) {
    reporter_.ready("optimises with " + std::string(optimizer_.implementation()));
  }

 private:
  Status reconfigure(const Config& config) {
    if (auto status = optimizer_.reconfigure(config); !status) return status;
    reporter_.set_implementation(std::string(optimizer_.implementation()));
    return success();
  }

  void on_corridor(const msg::Corridor& m, const PlanRequest& request, Timing timing) {
    auto [solution, compute_ns] = timed([&]() -> Result<Solution> {
      const auto corridor = conversions::from_msg(m);
      if (!corridor) return corridor.error();
      return optimizer_.optimise(request, *corridor,
                                 [&] { return !check_deadline(request, node_.monotonic_ns()); });
    });
    timing.compute_ns = compute_ns;
    if (!solution) return reporter_.failed(request.id, solution.error(), timing);
    publish(m, *solution, compute_ns);
    const Trajectory& trajectory = solution->trajectory();
    reporter_.answered(request.id, timing,
                       {{"pieces", double(trajectory.pieces.size())},
                        {"iterations", double(solution->iterations)},
                        {"duration_s", trajectory.duration_s()},
                        {"length_m", trajectory.length_m()},
                        {"jerk_cost", solution->jerk_cost},
                        {"start_excess_s", solution->certified.certificate().start_excess_s}});
  }

  void publish(const msg::Corridor& corridor, const Solution& solution, std::int64_t compute_ns) {
    msg::BezierTrajectory m;
    m.request(corridor.request());
    m.implementation(std::string(optimizer_.implementation()));
    m.map_version(corridor.map_version());
    m.pieces(conversions::to_msg(solution.trajectory()));
    m.polytopes(corridor.polytopes());
    m.certificate(conversions::to_msg(solution.certified.certificate()));
    if (solution.yaw) conversions::fill_yaw(*solution.yaw, m);
    m.compute_ns(compute_ns);
    m.header(conversions::make_header(node_.now_ns()));
    reporter_.send(publisher_, m, corridor.request().id());
  }

  Node& node_;
  TrajectoryOptimizer optimizer_;
  StageReporter reporter_;
  Publisher<msg::BezierTrajectory> publisher_;
  Intake<msg::Corridor> corridors_;
};

}  // namespace
}  // namespace goshawk::trajectory_optimizer

GOSHAWK_REGISTER_COMPONENT(goshawk::trajectory_optimizer::TrajectoryOptimizerComponent,
                           goshawk::trajectory_optimizer::Config)
