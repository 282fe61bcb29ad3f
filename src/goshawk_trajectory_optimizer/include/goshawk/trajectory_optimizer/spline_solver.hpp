#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "goshawk/trajectory_optimizer/spline_problem.hpp"

namespace goshawk::trajectory_optimizer {

/// Primal-dual interior-point method for SplineProblem: Mehrotra's predictor-corrector on rows that
/// are linear (faces) or smooth and convex (limits), one slack and one multiplier each (Nocedal and
/// Wright, Numerical Optimization, chapter 19). The Newton system, reduced to the knots, is
/// block-tridiagonal with one border; the work of an iteration is linear in pieces and faces. A
/// solver keeps its memory: nothing is allocated in a solve no larger than an earlier one, and no
/// answer depends on an earlier one.
class SplineSolver {
 public:
  struct Settings {
    int max_iterations = 60;
    double gap = 1e-8;                // relative duality gap
    double feasibility = 1e-9;        // largest violation of a face
    double limit_feasibility = 1e-9;  // of a limit, relative and squared
    double dual_feasibility = 1e-7;   // dual residual, relative
    /// Asked before each iteration; true ends the solve. Empty: never.
    const std::function<bool()>* stop = nullptr;
  };
  enum class Status { solved, infeasible, iteration_limit, stopped, numerical_trouble };
  struct Outcome {
    Status status = Status::numerical_trouble;
    int iterations = 0;
    double objective = 0.0;
    double gap = 0.0;              // s'z
    double primal_residual = 0.0;  // largest |f(x) + s|
    double dual_residual = 0.0;    // largest |gradient of the Lagrangian|, relative to the cost's
    double eta = 1.0;
  };

  SplineSolver();
  SplineSolver(SplineSolver&&) noexcept;
  SplineSolver& operator=(SplineSolver&&) noexcept;
  ~SplineSolver();

  /// The solution is in knots() and the outcome's eta. @pre the problem's sizes agree
  Outcome solve(const SplineProblem& problem, const Settings& settings);

  const std::vector<Knot>& knots() const { return solution_; }

  /// What the durations are worth: the derivative of the least cost by the logarithm of each
  /// piece's duration, by the multipliers of the last problem (envelope theorem). It is as exact
  /// as the solve was. @pre a solve went before; ends that do not move with eta
  void time_slopes(std::vector<double>& slopes) const;

  /// The Lagrangian f(x) + z'g(x) of the last problem with its final multipliers, anywhere: its
  /// gradient is zero at a solution. For tests by finite differences. @pre a solve went before
  double lagrangian(const std::vector<Knot>& knots, double eta);

 private:
  struct Memory;
  void iterate(const Settings& settings, Outcome& out);
  bool needs_more_time(const SplineProblem& problem, const Settings& settings, Outcome& out);

  std::unique_ptr<Memory> memory_;
  SplineProblem relaxed_;
  std::vector<Knot> solution_;
};

}  // namespace goshawk::trajectory_optimizer
