#pragma once

#include <memory>
#include <vector>

#include "goshawk/trajectory_optimizer/spline_problem.hpp"
#include "goshawk/trajectory_optimizer/spline_solver.hpp"

namespace goshawk::trajectory_optimizer {

/// Dual active-set method for a SplineProblem with fixed durations (Goldfarb and Idnani, A
/// numerically stable dual method for solving strictly convex quadratic programs, 1983). From the
/// smoothest spline without constraints it makes the most violated constraint active, one after
/// another, and lets go of those whose multipliers come to zero. The Hessian is the same for all
/// three axes and is factored once, block-tridiagonal with 3 x 3 blocks. Limits that are no planes
/// are cut by the half-spaces that touch them (Kelley, 1960). Where few constraints bind it needs
/// less time than SplineSolver; the work grows with the cube of their number.
/// A solver keeps its memory: nothing is allocated in a solve no larger than an earlier one, and no
/// answer depends on an earlier one.
class ActiveSetSolver {
 public:
  using Settings = SplineSolver::Settings;  // of which max_iterations plays no part
  using Status = SplineSolver::Status;
  using Outcome = SplineSolver::Outcome;  // an iteration: a constraint more or less

  ActiveSetSolver();
  ActiveSetSolver(ActiveSetSolver&&) noexcept;
  ActiveSetSolver& operator=(ActiveSetSolver&&) noexcept;
  ~ActiveSetSolver();

  /// The solution is in knots(). infeasible is proved: by constraints of which a combination with
  /// multipliers not below zero cannot hold (Farkas), or a bound on the jerk that the acceleration
  /// limits do not allow. @pre the problem's sizes agree, problem.scale is false
  Outcome solve(const SplineProblem& problem, const Settings& settings);

  /// Whether to try at all: fixed durations and at most 100 pieces. A rule of the problem alone.
  static bool suits(const SplineProblem& problem);
  /// Whether an outcome is final; if not, SplineSolver finds the same optimum.
  static bool decided(const Outcome& outcome);

  const std::vector<Knot>& knots() const { return solution_; }
  /// Constraints that bind at the solution.
  int binding() const;

 private:
  struct Memory;
  void iterate(const Settings& settings, Outcome& out);

  std::unique_ptr<Memory> memory_;
  std::vector<Knot> solution_;
};

}  // namespace goshawk::trajectory_optimizer
