#include "goshawk/baselines/baseline_optimizer.hpp"

#include "goshawk/baselines/polynomial_baselines.hpp"
#include "goshawk/baselines/thesis_form.hpp"
#include "goshawk/trajectory_optimizer/request_check.hpp"

namespace goshawk::baselines {
namespace {

using trajectory_optimizer::Solution;
using trajectory_optimizer::Task;

constexpr double kTolerance_m = 1e-7;  // a tenth of the certificate's

bool stays_inside(const Polytope& polytope, const BezierPiece& piece) {
  for (int j = 0; j < piece.control_points.cols(); ++j) {
    if (!(polytope.violation(piece.control_points.col(j)) <= kTolerance_m)) return false;
  }
  return true;
}

Result<Trajectory> rechecked_minimum_jerk(const Task& task) {
  const auto is_free = [&](const BezierPiece& piece) {
    return stays_inside(task.corridor.polytopes[std::size_t(piece.polytope)], piece);
  };
  auto answer = rechecked_polynomial(task.corridor.waypoints_map, task.request.start,
                                     task.request.goal, task.request.limits, is_free);
  if (!answer) return answer.error();
  task.effort.solves = answer->plans;
  return std::move(answer->trajectory);
}

}  // namespace

Result<BaselineOptimizer> BaselineOptimizer::create(const Config& config) {
  ParameterFaults faults;
  describe(config, faults);
  if (auto status = faults.status("the baseline's config: "); !status) return status.error();
  return BaselineOptimizer(config);
}

Status BaselineOptimizer::reconfigure(const Config& config) {
  auto other = create(config);
  if (!other) return other.error();
  *this = *std::move(other);
  return success();
}

Result<Trajectory> BaselineOptimizer::plan(const Task& task) {
  switch (config_.method) {
    case Method::thesis:
      return thesis_form(task);
    case Method::minimum_jerk:
      return rechecked_minimum_jerk(task);
    case Method::minimum_snap:
      break;
  }
  task.effort.solves = 1;
  return minimum_snap(task.corridor.waypoints_map, task.request.start, task.request.goal,
                      task.request.limits);
}

Result<Solution> BaselineOptimizer::optimise(const PlanRequest& request, const Corridor& corridor,
                                             const std::function<bool()>& out_of_time) {
  if (auto status = trajectory_optimizer::check_request(request, corridor); !status) {
    return status.error();
  }
  if (request.duration_s != 0.0) {
    return fail(ErrorCode::invalid_input,
                "baselines take no duration: ask for none, or use trajectory_optimizer");
  }
  const trajectory_optimizer::Config defaults;
  trajectory_optimizer::Effort effort;
  auto trajectory = plan({request, corridor, defaults, workspace_, effort, &out_of_time});
  if (!trajectory) return trajectory.error();
  const double jerk_cost = trajectory->jerk_cost();
  auto certified = certify(*std::move(trajectory), corridor.polytopes, request.limits,
                           request.start, request.goal);
  if (!certified) {
    return fail(certified.code(),
                certified.error().message + ": use trajectory_optimizer instead of a baseline");
  }
  return Solution{*std::move(certified), {}, jerk_cost, effort.iterations, effort.solves};
}

std::string_view BaselineOptimizer::implementation() const {
  switch (config_.method) {
    case Method::thesis:
      return "bezier-thesis";
    case Method::minimum_jerk:
      return "polynomial-minimum-jerk";
    case Method::minimum_snap:
      break;
  }
  return "polynomial-minimum-snap";
}

}  // namespace goshawk::baselines
