#include "goshawk/baselines/baseline_optimizer.hpp"

#include "goshawk/baselines/polynomial_baselines.hpp"
#include "goshawk/baselines/thesis_form.hpp"
#include "goshawk/trajectory_optimizer/request_check.hpp"

namespace goshawk::baselines {
namespace {

using trajectory_optimizer::Query;
using trajectory_optimizer::Request;
using trajectory_optimizer::Solution;
using trajectory_optimizer::Task;

constexpr double kTolerance_m = 1e-7;  // a tenth of the certificate's

bool stays_inside(const Polytope& polytope, const BezierPiece& piece) {
  for (int j = 0; j < piece.control_points.cols(); ++j) {
    if (!(polytope.violation(piece.control_points.col(j)) <= kTolerance_m)) return false;
  }
  return true;
}

Result<Trajectory> polynomial(const Request& request, int& plans) {
  const auto& polytopes = request.corridor.polytopes;
  auto answer =
      rechecked_polynomial(request.corridor.waypoints_map, request.start, request.goal,
                           request.limits, [&](const BezierPiece& piece) {
                             return stays_inside(polytopes[std::size_t(piece.polytope)], piece);
                           });
  if (!answer) return answer.error();
  plans = answer->plans;
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

Result<Trajectory> BaselineOptimizer::plan(const Task& task) const {
  const Request& request = task.request;
  if (config_.method == "thesis") return thesis_form(task);
  if (config_.method == "polynomial") return polynomial(request, task.effort.solves);
  task.effort.solves = 1;
  return minimum_snap(request.corridor.waypoints_map, request.start, request.goal, request.limits);
}

Result<Solution> BaselineOptimizer::optimise(const Corridor& corridor, const FlatState& start,
                                             const FlatState& goal, const Limits& limits,
                                             const Query& query) {
  if (auto status = trajectory_optimizer::check_request(corridor, start, goal, limits); !status) {
    return status.error();
  }
  if (query.duration_s != 0.0) {
    return fail(ErrorCode::invalid_input,
                "baselines take no duration: ask for none, or use trajectory_optimizer");
  }
  const Request request{corridor, start, goal, limits, 0.0, &query.out_of_time};
  const trajectory_optimizer::Config defaults;
  trajectory_optimizer::Effort effort;
  auto trajectory = plan({request, defaults, workspace_, effort});
  if (!trajectory) return trajectory.error();
  const Certificate certificate = certify(*trajectory, corridor.polytopes, limits, start, goal);
  if (!certificate.holds()) {
    return fail(ErrorCode::not_certified, "the baseline's trajectory is not certified (" +
                                              certificate.worst() + "): use trajectory_optimizer");
  }
  const int pieces = int(trajectory->pieces.size());
  const double jerk_cost = trajectory->jerk_cost();
  return Solution{*std::move(trajectory), certificate, effort.iterations,
                  effort.solves,          pieces,      jerk_cost};
}

std::string_view BaselineOptimizer::implementation() const {
  if (config_.method == "thesis") return "bezier-thesis";
  return config_.method == "polynomial" ? "polynomial-rechecked" : "polynomial-minimum-snap";
}

}  // namespace goshawk::baselines
