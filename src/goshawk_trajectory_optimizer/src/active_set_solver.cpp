#include "goshawk/trajectory_optimizer/active_set_solver.hpp"

#include <algorithm>
#include <cmath>

#include "active_set_memory.hpp"

namespace goshawk::trajectory_optimizer {
namespace {

constexpr int kMostPieces = 100;  // with more, many constraints bind and rounding grows
constexpr int kSteps = 30, kStepsAPiece = 8;
// Where more balls bind than a few, or their directions are strongly coupled, the interior point is
// faster.
constexpr int kMostCuts = 16;
constexpr int kMostTurns = 32;
constexpr double kDependent = 1e-13;  // slope of a violation, relative: rounding
constexpr int kMostPolishes = 5;
constexpr int kMostRefinements = 5;

enum class Step { added, infeasible, dependent, full };

// Farkas: a = sum change_i a_i + e with no change above zero. Whatever holds the active constraints
// has a'x' - b >= violation - |e|_1 |x' - x|: above zero within reach of x.
bool proves_infeasible(const ActiveSetState& s) {
  constexpr double kReach = 1e4;  // in the problem's units, in which a piece is about 1
  return s.violation > kReach * s.remainder;
}

// The first multiplier that comes to zero, and how large the new one is then.
double first_blocking(const ActiveSetState& s, int& index) {
  double least = HUGE_VAL;
  for (int i = 0; i < s.count; ++i) {
    if (!(s.change[i] > 0.0)) continue;
    const double step = s.active[i].multiplier / s.change[i];
    if (step < least) {
      least = step;
      index = i;
    }
  }
  return least;
}

// Raises the multiplier of the next constraint until it holds, letting go of those in its way.
Step make_active(ActiveSetState& s, double most_objective, int most_steps, int& steps) {
  const ActiveSetKernels& kernels = active_set_kernels();
  kernels.reach(s);
  for (; steps < most_steps; ++steps) {
    kernels.project(s);
    int blocking = -1;
    const double partial = first_blocking(s, blocking);
    const bool dependent = !(s.slope > kDependent * s.own);
    const double full = dependent ? HUGE_VAL : s.violation / s.slope;
    const double step = std::min(partial, full);
    if (blocking < 0 && s.remainder < 1e300 && proves_infeasible(s)) return Step::infeasible;
    if (!(step < HUGE_VAL)) return Step::dependent;
    s.objective += step * s.slope * (0.5 * step + s.next.multiplier);
    if (s.objective > most_objective) return Step::infeasible;
    for (int i = 0; i < s.count; ++i) s.active[i].multiplier -= step * s.change[i];
    s.next.multiplier += step;
    if (full <= partial) {
      if (s.count == s.capacity) return Step::full;
      kernels.append(s);
      ++steps;
      return Step::added;
    }
    s.violation -= step * s.slope;
    kernels.drop(s, blocking);
  }
  return Step::full;
}

}  // namespace

ActiveSetSolver::ActiveSetSolver() : memory_(std::make_unique<Memory>()) {}
ActiveSetSolver::ActiveSetSolver(ActiveSetSolver&&) noexcept = default;
ActiveSetSolver& ActiveSetSolver::operator=(ActiveSetSolver&&) noexcept = default;
ActiveSetSolver::~ActiveSetSolver() = default;

bool ActiveSetSolver::suits(const SplineProblem& problem) {
  return !problem.scale && problem.pieces() <= kMostPieces;
}

bool ActiveSetSolver::decided(const Outcome& outcome) {
  return outcome.status == Status::solved || outcome.status == Status::infeasible ||
         outcome.status == Status::stopped;
}

int ActiveSetSolver::binding() const {
  return memory_->state.count;
}

ActiveSetSolver::Outcome ActiveSetSolver::solve(const SplineProblem& problem,
                                                const Settings& settings) {
  Outcome out;
  memory_->load(problem);
  if (!memory_->finite) return out;
  if (memory_->constant_violated) {
    out.status = Status::infeasible;
    return out;
  }
  iterate(settings, out);
  solution_.resize(problem.knots.size());
  for (int k = 0; k <= problem.pieces(); ++k) solution_[std::size_t(k)] = memory_->knot(k);
  return out;
}

void ActiveSetSolver::iterate(const Settings& settings, Outcome& out) {
  ActiveSetState& s = memory_->state;
  const ActiveSetKernels& kernels = active_set_kernels();
  const int most_steps = kSteps + kStepsAPiece * s.last;
  s.face_tolerance = settings.feasibility;
  s.limit_tolerance = settings.limit_feasibility;
  if (!kernels.factor(s)) return;
  kernels.weigh(s);
  kernels.place(s);
  kernels.measure(s);
  bool placed = true;
  for (int refinements = 0, polishes = 0;;) {
    if (!placed) kernels.place(s);
    placed = false;
    kernels.price(s);
    if (s.violation == 0.0) {
      kernels.measure(s);
      if (s.dual_residual <= settings.dual_feasibility || polishes == kMostPolishes) break;
      kernels.polish(s);
      placed = true;
      ++polishes;
      continue;
    }
    if (settings.stop != nullptr && *settings.stop && (*settings.stop)()) {
      out.status = Status::stopped;
      return;
    }
    kernels.turn(s);
    if (s.cuts > kMostCuts || s.turns > kMostTurns) {
      out.status = Status::iteration_limit;
      return;
    }
    const Step step = make_active(s, memory_->most_objective, most_steps, out.iterations);
    if (step == Step::infeasible) out.status = Status::infeasible;
    if (step == Step::full) out.status = Status::iteration_limit;
    if (step == Step::infeasible || step == Step::full) return;
    if (step == Step::dependent) {
      if (++refinements > kMostRefinements) return;
      kernels.place(s);
      kernels.refine(s);
    }
  }
  out.objective = s.objective;
  out.gap = s.gap;
  out.dual_residual = s.dual_residual;
  out.primal_residual = std::max({0.0, s.face_violation, s.limit_violation});
  const bool holds =
      s.face_violation <= settings.feasibility && s.limit_violation <= settings.limit_feasibility;
  const bool closed = s.gap <= settings.gap * std::abs(s.objective) + 1e-14;
  if (holds && closed) out.status = Status::solved;
}

}  // namespace goshawk::trajectory_optimizer
