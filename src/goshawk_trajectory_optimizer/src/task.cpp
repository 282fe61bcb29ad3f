#include "goshawk/trajectory_optimizer/task.hpp"

#include <algorithm>
#include <cmath>

#include "goshawk/trajectory_optimizer/limit_usage.hpp"

namespace goshawk::trajectory_optimizer {
namespace {

constexpr SplineSolver::Settings kCoarse{
    .gap = 0.5, .feasibility = 3e-2, .limit_feasibility = 3e-2, .dual_feasibility = 0.5};
constexpr SplineSolver::Settings kFine{
    .gap = 1e-3, .feasibility = 1e-8, .limit_feasibility = 1e-8, .dual_feasibility = 1e-3};
// From rest to rest the durations are set to what the limits need afterwards.
constexpr double kCoarseLimits = 0.1;
constexpr double kFineLimits = 1e-3;

SplineSolver::Settings accuracy(const Task& task, bool coarse) {
  SplineSolver::Settings settings = coarse ? kCoarse : kFine;
  if (from_rest_to_rest(task.request)) settings.limit_feasibility = coarse ? kCoarseLimits : kFineLimits;
  settings.max_iterations = task.config.max_iterations;
  settings.stop = task.out_of_time;
  return settings;
}

// One of the solvers on the workspace's problem.
template <typename Solver>
void run(Solver& solver, const SplineSolver::Settings& settings, const Task& task) {
  task.effort.last = solver.solve(task.workspace.problem, settings);
  task.effort.iterations += task.effort.last.iterations;
}

}  // namespace

bool solve_fixed(const Task& task, Plan& plan) {
  Workspace& w = task.workspace;
  SplineSolver::Outcome& last = task.effort.last;
  ++task.effort.solves;
  last = {};
  Units units;
  if (!make_problem(task.request, task.corridor, plan, {.scale = false}, w.problem, units)) {
    last.status = SplineSolver::Status::infeasible;
    return false;
  }
  const SplineSolver::Settings settings{task.config.max_iterations, 1e-7, 1e-9, 1e-9, 1e-6,
                                        task.out_of_time};
  bool decided = false;
  if (ActiveSetSolver::suits(w.problem)) {
    run(w.active_set, settings, task);
    decided = ActiveSetSolver::decided(last);
  }
  if (!decided) run(w.interior_point, settings, task);
  if (last.status != SplineSolver::Status::solved) return false;
  const auto& knots = decided ? w.active_set.knots() : w.interior_point.knots();
  take_solution(task.request, knots, units, 1.0, plan);
  return true;
}

std::optional<double> solve_scale(const Task& task, const ScaleSettings& settings, Plan& plan) {
  Workspace& w = task.workspace;
  const ProblemSettings of_problem{.scale = true,
                                   .time_weight = settings.coarse ? kCoarseTimeWeight : kTimeWeight,
                                   .reach_m = settings.reach_m,
                                   .end_slack = settings.end_slack};
  Units units;
  if (!make_problem(task.request, task.corridor, plan, of_problem, w.problem, units)) return {};
  run(w.interior_point, accuracy(task, settings.coarse), task);
  ++task.effort.solves;
  const SplineSolver::Outcome& last = task.effort.last;
  if (last.status != SplineSolver::Status::solved || !(last.eta > 0.0)) return {};
  const double kappa = std::sqrt(last.eta);
  take_solution(task.request, w.interior_point.knots(), units, kappa, plan);
  // Exact: the shape is feasible at any longer duration.
  if (from_rest_to_rest(task.request)) slow_to_limits(task.request.limits, 0.0, plan);
  return kappa;
}

void slow_to_limits(const Limits& limits, double least, Plan& plan) {
  double factor = least;
  for (std::size_t k = 0; k < plan.durations_s.size(); ++k) {
    factor = std::max(factor, time_factor(usage_of(plan.piece(k), limits, plan.a_factor(k))));
  }
  factor *= 1.0 + 1e-12;
  plan.stretch(factor);
  for (FlatState& knot : plan.knots) {
    knot.velocity /= factor;
    knot.acceleration /= factor * factor;
  }
}

}  // namespace goshawk::trajectory_optimizer
