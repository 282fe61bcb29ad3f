#include "goshawk/trajectory_optimizer/spline_solver.hpp"

#include <algorithm>
#include <cmath>

#include "spline_memory.hpp"

namespace goshawk::trajectory_optimizer {
namespace {

constexpr double kStepFraction = 0.995;  // of the way to the boundary

// Farkas: for any x', z'f(x') >= z'(f(x) + s) - s'z + (f'z)'(x' - x), as each f is convex. Where
// that is above zero for every x' within reach of x, no x' within reach satisfies f(x') <= 0.
bool proves_infeasible(const SplineState& s) {
  constexpr double kReach = 1e4;  // in the problem's units, in which a piece is about 1
  return s.proof - s.gap > kReach * s.multiplier_residual;
}

}  // namespace

SplineSolver::SplineSolver() : memory_(std::make_unique<Memory>()) {}
SplineSolver::SplineSolver(SplineSolver&&) noexcept = default;
SplineSolver& SplineSolver::operator=(SplineSolver&&) noexcept = default;
SplineSolver::~SplineSolver() = default;

SplineSolver::Outcome SplineSolver::solve(const SplineProblem& problem, const Settings& settings) {
  Outcome out;
  memory_->load(problem);
  if (memory_->constant_point_violated) {
    out.status = Status::infeasible;
    return out;
  }
  memory_->start();
  iterate(settings, out);
  const bool gave_up =
      out.status == Status::numerical_trouble || out.status == Status::iteration_limit;
  if (gave_up && !problem.scale && needs_more_time(problem, settings, out)) {
    out.status = Status::infeasible;
    return out;
  }
  solution_.resize(problem.knots.size());
  for (int k = 0; k <= problem.pieces(); ++k) solution_[std::size_t(k)] = memory_->knot(k);
  return out;
}

// Relaxes the limits of a problem with fixed durations by an unknown eta, which always has an
// answer inside the polytopes, and bounds the least eta from below. Above 1: infeasible. What is
// only just infeasible needs an exact bound.
bool SplineSolver::needs_more_time(const SplineProblem& problem, const Settings& settings,
                                   Outcome& out) {
  struct Accuracy {
    double smooth;  // what the jerk may add to eta within the limits
    double gap;
  };
  // Jerk points are differences of acceleration points: |j| <= 6 a_max / T, in every norm here
  // up to sqrt(3).
  double jerk_bound = 0.0;
  for (std::size_t k = 0; k < problem.durations.size(); ++k) {
    const double T = problem.durations[k];
    jerk_bound += 0.5 * T * std::pow(6.0 * std::sqrt(3.0) * problem.a_max[k] / T, 2);
  }
  relaxed_ = problem;
  relaxed_.scale = true;
  relaxed_.time_weight = 1.0;
  relaxed_.start_rate.setZero();
  relaxed_.goal_rate.setZero();
  for (const Accuracy accuracy : {Accuracy{1e-3, 1e-3}, Accuracy{1e-7, 1e-8}}) {
    relaxed_.jerk_weight = accuracy.smooth / jerk_bound;
    memory_->load(relaxed_);
    memory_->start();
    Settings coarse = settings;
    coarse.gap = accuracy.gap;
    coarse.feasibility = 1e-6;
    coarse.limit_feasibility = accuracy.gap;
    coarse.dual_feasibility = 0.1 * accuracy.gap;
    Outcome relaxed;
    iterate(coarse, relaxed);
    out.iterations += relaxed.iterations;
    if (relaxed.status != Status::solved) return false;
    const SplineState& s = memory_->state;
    constexpr double kReach = 10.0;  // of unknowns that could do better, at the dual residual
    const double slope = kReach * s.dual_residual;
    if (s.objective + s.proof - s.gap > 1.0 + accuracy.smooth + slope) return true;
    if (s.eta < 1.0 - 10.0 * accuracy.gap) return false;
  }
  return false;
}

double SplineSolver::lagrangian(const std::vector<Knot>& knots, double eta) {
  SplineState& s = memory_->state;
  memory_->set_knots(knots);
  s.eta = eta;
  spline_kernels().linearise(s);
  return s.objective + s.proof - s.gap;  // z'g = z'(g + s) - z's
}

void SplineSolver::iterate(const Settings& settings, Outcome& out) {
  SplineState& s = memory_->state;
  const SplineKernels& kernels = spline_kernels();
  const auto converged = [&] {
    // The bound on the optimum below is the objective plus z'f(x), and z'f(x) = proof - gap.
    const double gap = std::max(s.gap, s.gap - s.proof);
    return s.face_violation <= settings.feasibility &&
           s.limit_violation <= settings.limit_feasibility &&
           gap <= settings.gap * std::abs(s.objective) + 1e-14;
  };
  double first_gap = 0.0;
  for (;; ++out.iterations) {
    kernels.linearise(s);
    out.objective = s.objective;
    out.gap = s.gap;
    out.primal_residual = s.primal_residual;
    out.dual_residual = s.dual_residual;
    out.eta = s.eta;
    if (converged() && s.dual_residual <= settings.dual_feasibility) {
      out.status = Status::solved;
      return;
    }
    first_gap = out.iterations == 0 ? s.gap : first_gap;
    if (!(s.gap < 1e6 * (first_gap + 1e-6))) break;  // multipliers without bound
    if (proves_infeasible(s)) {
      out.status = Status::infeasible;
      return;
    }
    if (out.iterations >= settings.max_iterations) {
      out.status = Status::iteration_limit;
      return;
    }
    if (settings.stop != nullptr && *settings.stop && (*settings.stop)()) {
      out.status = Status::stopped;
      return;
    }
    if (!kernels.factor(s)) break;
    const double reach = kernels.predict(s);
    // s'z where the predictor ends, as ds's + dz'z = -s'z.
    const double ahead = (1.0 - reach) * s.gap + reach * reach * s.product;
    const double sigma = std::pow(std::clamp(ahead / s.gap, 0.0, 1.0), 3);
    const double step = std::min(1.0, kStepFraction * kernels.correct(s, sigma * s.gap / s.degree));
    if (!(step > 1e-7)) break;
    kernels.apply(s, step);
  }
  // Rounding ends the method before the dual residual if slacks are tiny; what counts for the
  // answer, its feasibility and its gap, is there already.
  if (out.dual_residual <= 1e-4 && converged()) out.status = Status::solved;
}

}  // namespace goshawk::trajectory_optimizer
