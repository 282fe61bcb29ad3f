#include <functional>

#include "goshawk/runtime/component.hpp"
#include "goshawk/stage/intake.hpp"
#include "goshawk/trajectory_optimizer/config.hpp"
#include "goshawk/trajectory_optimizer/trajectory_optimizer.hpp"
#include "goshawk/trajectory_optimizer/yaw.hpp"

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
        config_(node.parameters<Config>([this](const Config& c) { return reconfigure(c); })),
        optimizer_(make_optimizer(config_)),
        reporter_(node, StageRole::trajectory_optimizer, std::string(optimizer_.implementation())),
        publisher_(node.advertise<msg::BezierTrajectory>("trajectory", Qos::reliable_last())),
        corridors_(node, reporter_, "corridor",
                   std::bind_front(&TrajectoryOptimizerComponent::on_corridor, this)) {
    reporter_.ready("optimises with " + std::string(optimizer_.implementation()));
  }

 private:
  Status reconfigure(const Config& config) {
    if (auto status = optimizer_.reconfigure(config); !status) return status;
    config_ = config;
    reporter_.set_implementation(std::string(optimizer_.implementation()));
    return success();
  }

  void on_corridor(const msg::Corridor& m, const PlanRequest& request, Timing timing) {
    auto [solution, compute_ns] = timed([&]() -> Result<Solution> {
      const auto corridor = conversions::from_msg(m);
      if (!corridor) return corridor.error();
      const Query query{.duration_s = request.duration_s,
                        .out_of_time = [&] { return !check_deadline(request, node_.now_ns()); }};
      return optimizer_.optimise(*corridor, request.start, request.goal, request.limits, query);
    });
    timing.compute_ns = compute_ns;
    if (!solution) return reporter_.failed(request.id, solution.error(), timing);
    publish(m, request, *solution, compute_ns);
    reporter_.answered(request.id, timing,
                       {{"pieces", double(solution->trajectory.pieces.size())},
                        {"iterations", double(solution->iterations)},
                        {"duration_s", solution->trajectory.duration_s()},
                        {"length_m", solution->trajectory.length_m()},
                        {"jerk_cost", solution->jerk_cost},
                        {"start_excess_s", solution->certificate.start_excess_s}});
  }

  void publish(const msg::Corridor& corridor, const PlanRequest& request, const Solution& solution,
               std::int64_t compute_ns) {
    msg::BezierTrajectory m;
    m.request(corridor.request());
    m.implementation(std::string(optimizer_.implementation()));
    m.map_version(corridor.map_version());
    m.pieces(conversions::to_msg(solution.trajectory));
    m.polytopes(corridor.polytopes());
    m.certificate(conversions::to_msg(solution.certificate));
    if (auto status = add_yaw(request, solution.trajectory, m); !status) {
      return reporter_.failed(request.id, status.error());
    }
    m.compute_ns(compute_ns);
    m.header(conversions::make_header(node_.now_ns()));
    reporter_.send(publisher_, m, request.id);
  }

  // A vehicle that flies looks where it was told to; one at rest where its last flight ended. The
  // tracker, which knows better, catches up.
  Status add_yaw(const PlanRequest& request, const Trajectory& trajectory,
                 msg::BezierTrajectory& m) {
    if (config_.yaw == "none") return success();
    YawRequest yaw{.mode = config_.yaw == "fixed"          ? YawMode::fixed
                           : config_.yaw == "along_motion" ? YawMode::along_motion
                                                           : YawMode::towards_point,
                   .start_rad = yaw_rad_,
                   .fixed_rad = request.goal_yaw_rad,
                   .point_map = Vec3(config_.yaw_point_x_m, config_.yaw_point_y_m, 0.0),
                   .rate_max_rad_s = config_.yaw_rate_max_rad_s};
    if (!request.start.velocity.isZero(0.0) && yaw.mode != YawMode::fixed) {
      yaw.start_rad = wanted_yaw_rad(request.start, yaw).value_or(yaw_rad_);
    }
    const auto curve = plan_yaw(trajectory, yaw);
    if (!curve) return curve.error();
    yaw_rad_ = curve->yaw_rad(curve->duration_s());
    m.yaw_step(curve->step_s);
    m.yaw_points(curve->points_rad);
    return success();
  }

  Node& node_;
  Config config_;
  double yaw_rad_ = 0.0;  // [rad] where the last trajectory ends
  TrajectoryOptimizer optimizer_;
  StageReporter reporter_;
  Publisher<msg::BezierTrajectory> publisher_;
  Intake<msg::Corridor> corridors_;
};

}  // namespace
}  // namespace goshawk::trajectory_optimizer

GOSHAWK_REGISTER_COMPONENT(goshawk::trajectory_optimizer::TrajectoryOptimizerComponent,
                           goshawk::trajectory_optimizer::Config)
