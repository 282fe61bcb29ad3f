#pragma once

#include <functional>
#include <string>
#include <utility>

#include "goshawk/conversions/plan.hpp"
#include "goshawk/runtime/component.hpp"
#include "goshawk/stage/intake.hpp"

namespace goshawk::stage {

/// The component of a stage that makes trajectories: corridor -> trajectory.
///
/// @tparam Optimizer create(), reconfigure(), implementation(), and optimise(), whose answer has a
///         certified trajectory, the curve of yaw if there is one, and what it took. A parameter of
///         the template, so that this package knows no optimizer
template <typename Optimizer, typename Config>
class OptimizerComponent : public runtime::Component {
 public:
  explicit OptimizerComponent(runtime::Node& node)
      : node_(node),
        optimizer_(make_optimizer(
            node.parameters<Config>([this](const Config& c) { return reconfigure(c); }))),
        reporter_(node, StageRole::trajectory_optimizer, implementation()),
        publisher_(node.advertise<Answer>("trajectory", runtime::Qos::reliable_last())),
        corridors_(node, reporter_, "corridor",
                   std::bind_front(&OptimizerComponent::on_corridor, this)) {
    reporter_.ready("optimises with " + implementation());
  }

 private:
  using Answer = goshawk_msgs::msg::BezierTrajectory;

  static Optimizer make_optimizer(const Config& config) {
    auto optimizer = Optimizer::create(config);
    if (!optimizer) throw runtime::StartupFault(optimizer.error());
    return *std::move(optimizer);
  }

  std::string implementation() const { return std::string(optimizer_.implementation()); }

  Status reconfigure(const Config& config) {
    if (auto status = optimizer_.reconfigure(config); !status) return status;
    reporter_.set_implementation(implementation());
    return success();
  }

  auto optimise(const goshawk_msgs::msg::Corridor& m, const PlanRequest& request)
      -> decltype(std::declval<Optimizer&>().optimise(request, Corridor{})) {
    const auto corridor = conversions::from_msg(m);
    if (!corridor) return corridor.error();
    return optimizer_.optimise(request, *corridor,
                               [&] { return !check_deadline(request, node_.monotonic_ns()); });
  }

  void on_corridor(const goshawk_msgs::msg::Corridor& m, const PlanRequest& request,
                   Timing timing) {
    const auto [solution, compute_ns] = timed([&] { return optimise(m, request); });
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

  template <typename Solution>
  void publish(const goshawk_msgs::msg::Corridor& corridor, const Solution& solution,
               std::int64_t compute_ns) {
    Answer m;
    m.request(corridor.request());
    m.implementation(implementation());
    m.map_version(corridor.map_version());
    m.pieces(conversions::to_msg(solution.trajectory()));
    m.polytopes(corridor.polytopes());
    m.certificate(conversions::to_msg(solution.certified.certificate()));
    if (solution.yaw) conversions::fill_yaw(*solution.yaw, m);
    m.compute_ns(compute_ns);
    m.header(conversions::make_header(node_.now_ns()));
    reporter_.send(publisher_, m, corridor.request().id());
  }

  runtime::Node& node_;
  Optimizer optimizer_;
  StageReporter reporter_;
  runtime::Publisher<Answer> publisher_;
  Intake<goshawk_msgs::msg::Corridor> corridors_;
};

}  // namespace goshawk::stage
