#include "goshawk/trajectory_optimizer/spline_solver.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "spline_memory.hpp"

namespace goshawk::trajectory_optimizer {
namespace {

constexpr double kStepFraction = 0.99;  // of the way to the boundary

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
  solution_.resize(problem.joints.size());
  for (int k = 0; k <= problem.pieces(); ++k) solution_[std::size_t(k)] = memory_->joint(k);
  return out;
}

void SplineSolver::iterate(const Settings& settings, Outcome& out) {
  SplineState& s = memory_->state;
  const SplineKernels& kernels = spline_kernels();
  const auto converged = [&] {
    return s.primal_residual <= settings.feasibility &&
           s.gap <= settings.gap * std::abs(s.objective) + 1e-14;
  };
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
    if (!std::isfinite(s.gap) || !kernels.factor(s)) break;
    const double reach = std::min(1.0, kernels.predict(s));
    // s'z where the predictor ends, as ds's + dz'z = -s'z.
    const double ahead = (1.0 - reach) * s.gap + reach * reach * s.product;
    const double sigma = std::pow(std::clamp(ahead / s.gap, 0.0, 1.0), 3);
    const double step = std::min(1.0, kStepFraction * kernels.correct(s, sigma * s.gap / s.degree));
    if (getenv("TR")) std::printf("%2d obj %.6g gap %.3g pr %.2g du %.2g eta %.4f reach %.3f sigma %.3g step %.3f\n", out.iterations, s.objective, s.gap, s.primal_residual, s.dual_residual, s.eta, reach, sigma, step);
    if (!(step > 1e-8)) break;
    kernels.apply(s, step);
  }
  // Rounding ends the method before the dual residual where slacks are tiny; what counts for the
  // answer, its feasibility and its gap, is there already.
  if (out.dual_residual <= 1e-4 && converged()) out.status = Status::solved;
}

}  // namespace goshawk::trajectory_optimizer
