#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "goshawk/trajectory_optimizer/active_set_solver.hpp"
#include "goshawk/trajectory_optimizer/config.hpp"
#include "goshawk/trajectory_optimizer/plan_problem.hpp"
#include "goshawk/trajectory_optimizer/spline_solver.hpp"

namespace goshawk::trajectory_optimizer {

/// Memory that is reused from request to request. No answer depends on what it holds.
struct Workspace {
  SplineSolver interior_point;
  ActiveSetSolver active_set;
  SplineProblem problem;
  std::vector<double> slopes;
};

/// What the solves of one request took, and how the last one ended.
struct Effort {
  int solves = 0;
  int iterations = 0;
  SplineSolver::Outcome last;

  bool stopped() const { return last.status == SplineSolver::Status::stopped; }
};

/// One request while it is being answered: what every strategy works with.
struct Task {
  const PlanRequest& request;
  const Corridor& corridor;
  const Config& config;
  Workspace& workspace;
  Effort& effort;
  const std::function<bool()>* out_of_time = nullptr;  // asked before each iteration; null: never
};

/// The squared duration beside the mean squared jerk, each in units of the trapezoid's: enough for
/// nearly the least time, not so much that the jerk is left to chance.
inline constexpr double kTimeWeight = 300.0;
inline constexpr double kCoarseTimeWeight = 100.0;  // of the solves before the last

/// Least jerk with the durations of a plan, all faces included.
/// @param plan its knots become the solution's
/// @return false if there is no solution: effort.last tells why
bool solve_fixed(const Task& task, Plan& plan);

/// Time and shape together (SplineProblem with scale), once.
struct ScaleSettings {
  double reach_m = 0.0;    // faces farther than this from the guess are left out
  bool coarse = false;     // accurate enough to locate where time is lacking, not to fly
  double end_slack = 0.0;  // of the speed limit at a moving end: make_problem()
};
/// @param plan its knots and durations become the solution's; from rest to rest, the durations are
///   exactly what the limits need
/// @return the factor that the durations were multiplied by before that; nothing without a solution
std::optional<double> solve_scale(const Task& task, const ScaleSettings& settings, Plan& plan);

/// The same curve between rests, no faster than the limits allow.
/// @param least smallest factor of the durations
void slow_to_limits(const Limits& limits, double least, Plan& plan);

}  // namespace goshawk::trajectory_optimizer
