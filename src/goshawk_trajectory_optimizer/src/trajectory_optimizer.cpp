#include "goshawk/trajectory_optimizer/trajectory_optimizer.hpp"

#include <utility>

#include "goshawk/trajectory_optimizer/request_check.hpp"
#include "goshawk/trajectory_optimizer/yaw.hpp"
#include "strategies.hpp"

namespace goshawk::trajectory_optimizer {
namespace {

// When to arrive; nothing: as soon as the limits allow.
std::optional<double> arrival_s(const Task& task, const Flight& soonest) {
  if (task.request.duration_s > 0.0) return task.request.duration_s;
  const double extra = task.config.extra_time;
  if (extra > 0.0) return (1.0 + extra) * soonest.certified.duration_s();
  return {};
}

Result<Flight> answer(const Task& task) {
  auto soonest = fastest(task);
  if (!soonest) return no_flight(task);
  auto flight = within_vehicle(task, *std::move(soonest));
  if (!flight) return flight;
  if (const auto duration_s = arrival_s(task, *flight)) {
    return arrive_after(task, *duration_s, *std::move(flight));
  }
  return flight;
}

}  // namespace

TrajectoryOptimizer::TrajectoryOptimizer(const Config& config)
    : config_(config), workspace_(std::make_unique<Workspace>()) {}
TrajectoryOptimizer::TrajectoryOptimizer(TrajectoryOptimizer&&) noexcept = default;
TrajectoryOptimizer& TrajectoryOptimizer::operator=(TrajectoryOptimizer&&) noexcept = default;
TrajectoryOptimizer::~TrajectoryOptimizer() = default;

Result<TrajectoryOptimizer> TrajectoryOptimizer::create(const Config& config) {
  ParameterFaults faults;
  describe(config, faults);
  if (auto status = faults.status("the optimizer's config: "); !status) return status.error();
  return TrajectoryOptimizer(config);
}

Status TrajectoryOptimizer::reconfigure(const Config& config) {
  auto other = create(config);
  if (!other) return other.error();
  *this = *std::move(other);
  return success();
}

Result<Solution> TrajectoryOptimizer::optimise(const PlanRequest& request, const Corridor& corridor,
                                               const std::function<bool()>& out_of_time) {
  if (auto status = check_request(request, corridor); !status) return status.error();
  Effort effort;
  auto flight = answer({request, corridor, config_, *workspace_, effort, &out_of_time});
  if (!flight) return flight.error();
  auto yaw = plan_yaw(flight->certified.trajectory(), request, config_);
  return Solution{std::move(flight->certified), std::move(yaw), flight->jerk_cost,
                  effort.iterations, effort.solves};
}

std::string_view TrajectoryOptimizer::implementation() const {
  return config_.method == Method::fixed ? "bezier-fixed" : "bezier-scale";
}

}  // namespace goshawk::trajectory_optimizer
