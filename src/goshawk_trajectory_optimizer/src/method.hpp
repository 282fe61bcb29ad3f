#pragma once

#include <optional>

#include "goshawk/trajectory_optimizer/active_set_solver.hpp"
#include "goshawk/trajectory_optimizer/plan.hpp"
#include "goshawk/trajectory_optimizer/spline_solver.hpp"
#include "goshawk/trajectory_optimizer/trajectory_optimizer.hpp"

namespace goshawk::trajectory_optimizer {

/// The three methods over one solver and its memory.
class TrajectoryOptimizer::Method {
 public:
  explicit Method(const Config& config) : config_(config) {}

  const Config& config() const { return config_; }
  Result<Solution> answer(const Request& request);
  Result<Solution> stop(const Polytope& free_space, const FlatState& start, const Limits& limits);

 private:
  Result<Solution> soonest_flight(const Request& request);
  /// The smoothest trajectory of this duration, which is no shorter than the soonest.
  Result<Solution> arrive(const Request& request, double duration_s, Solution soonest);
  /// Slows the pieces that ask more thrust or tilt than the vehicle has.
  Result<Solution> within_vehicle(const Request& request, Solution soonest);
  Result<Solution> arrive_smoothly(const Request& request, double duration_s);
  Result<Solution> scale(const Request& request);
  Result<Solution> fixed(const Request& request);
  Result<Solution> thesis(const Request& request);
  Result<Solution> rival(const Request& request);

  void scale_moving(const Request& request, Plan& plan);
  /// What a coarse solve is for: the time in each polytope, or the durations of the pieces by their
  /// use of the limits.
  enum class Refinement { switches, balance };
  void refine(const Request& request, Plan& plan, int refinements,
              Refinement refinement = Refinement::switches);
  /// Time and shape together, once: the plan becomes the solution and kappa its time scale.
  /// @param coarse good enough to see which pieces need more time, not to fly
  bool solve_scale(const Request& request, Plan& plan, double reach_m, bool coarse,
                   double end_slack, double& kappa);
  /// Least jerk with the plan's durations.
  bool solve_fixed(const Request& request, Plan& plan);
  /// Fixed durations, longer and longer, until a plan is certified.
  void try_longer(const Request& request, const Plan& plan);
  /// Gives each polytope its time, by what that is worth.
  double move_switches(const Request& request, Plan& plan, double beyond_m);
  /// Takes time from pieces that stay below their limits.
  void balance(const Request& request, Plan& plan) const;
  /// Keeps the plan if it is certified and better than what is kept.
  bool consider(const Request& request, const Plan& plan);
  /// @param least factor of the durations, where the limits allow more
  void slow_to_limits(const Request& request, Plan& plan, double least) const;
  Solution finish();
  bool stopped() const { return last_.status == SplineSolver::Status::stopped; }
  Error failure(const Request& request) const;

  Config config_;
  SplineSolver solver_;
  ActiveSetSolver active_set_;
  SplineProblem problem_;
  Units units_;
  std::vector<double> slopes_;
  std::optional<Solution> best_;
  Plan best_plan_;
  double best_cost_ = 0.0;
  bool outside_ = false;  // the plan last considered leaves its polytopes
  int iterations_ = 0;
  int solves_ = 0;
  SplineSolver::Outcome last_;
};

}  // namespace goshawk::trajectory_optimizer
