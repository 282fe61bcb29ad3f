#include "method.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "goshawk/trajectory_optimizer/rivals.hpp"
#include "switching.hpp"
#include "usage.hpp"

namespace goshawk::trajectory_optimizer {
namespace {

constexpr double kAllFaces = std::numeric_limits<double>::infinity();
// Of the first reach: how far faces matter once the shape is nearly known.
constexpr double kNarrow = 0.35;
// Exponent of a piece's use of its limits: above 1, as what one piece gives up others need.
constexpr double kBalance = 1.8;
constexpr int kMostMovingPasses = 2;  // with a moving end: more are needed to meet it
// Of the first reach: how far beyond a polytope the flight may be where it changes to the next.
constexpr double kBeyond = 0.04;
constexpr double kWorthAPass = 0.01;  // of the duration
// All passes but the last need to be no better than what is asked of them: where time is lacking.
constexpr SplineSolver::Settings kCoarse{
    .gap = 0.5, .feasibility = 3e-2, .limit_feasibility = 3e-2, .dual_feasibility = 0.5};
constexpr SplineSolver::Settings kFine{
    .gap = 1e-3, .feasibility = 1e-8, .limit_feasibility = 1e-8, .dual_feasibility = 1e-3};
constexpr double kCoarseLimits = 0.1;
constexpr double kFineLimits = 1e-3;
// The squared duration beside the mean squared jerk, each in units of the trapezoid's: enough for
// nearly the least time, not so much that the jerk is left to chance.
constexpr double kTimeWeight = 300.0;
constexpr double kCoarseTimeWeight = 100.0;
constexpr std::array<double, 5> kEndSlack{2e-2, 2e-3, 2e-5, 0.0, 0.0};  // pass by pass

void stretch_durations(Plan& plan, double factor) {
  for (double& duration : plan.durations_s) duration *= factor;
}

}  // namespace

Result<Solution> TrajectoryOptimizer::Method::answer(const Request& request) {
  iterations_ = solves_ = 0;
  auto soon = soonest_flight(request);
  if (soon) soon = within_vehicle(request, *std::move(soon));
  if (!soon) return soon;
  if (request.duration_s > 0.0) return arrive(request, request.duration_s, *std::move(soon));
  if (config_.extra_time > 0.0) {
    const double duration_s = (1.0 + config_.extra_time) * soon->trajectory.duration_s();
    return arrive(request, duration_s, *std::move(soon));
  }
  return soon;
}

Result<Solution> TrajectoryOptimizer::Method::soonest_flight(const Request& request) {
  best_.reset();
  last_ = {};
  if (config_.method == "thesis") return thesis(request);
  if (config_.method == "minimum_snap" || config_.method == "polynomial") return rival(request);
  return config_.method == "fixed" ? fixed(request) : scale(request);
}

Result<Solution> TrajectoryOptimizer::Method::scale(const Request& request) {
  Plan plan = cut_trapezoid(request, config_);
  if (plan.stays) return fixed(request);
  if (request.rests()) {
    refine(request, plan, config_.refinement_passes);
    if (!best_ && config_.refinement_passes > 0 && !stopped()) {
      plan = cut_trapezoid(request, config_);  // durations too uneven to compute with
      refine(request, plan, 0);
    }
  } else {
    scale_moving(request, plan);
    if (!best_ && !stopped()) try_longer(request, plan);
  }
  if (best_) return finish();
  return failure(request);
}

void TrajectoryOptimizer::Method::scale_moving(const Request& request, Plan& plan) {
  constexpr std::array<Lead, 11> kLeads{{{0.25, 1.0},
                                         {0.1, 0.5},
                                         {0.1, 1.6},
                                         {0.02, 1.0},
                                         {0.05, 0.25},
                                         {0.05, 0.7},
                                         {0.03, 0.12},
                                         {0.02, 0.05},
                                         {0.05, 3.0},
                                         {0.01, 0.02},
                                         {0.01, 1.0}}};
  // A start above a limit: as little time above it as there is an answer for.
  constexpr std::array<double, 4> kBraking{0.4, 0.6, 0.8, 0.99};
  const bool above = StartAllowance::of(request.start, request.limits).until_s > 0.0;
  const auto attempt = [&](Lead lead, double braking, Refinement refinement) {
    lead.braking = braking;
    plan = cut_trapezoid(request, config_, lead);
    refine(request, plan, std::min(config_.refinement_passes, kMostMovingPasses), refinement);
    return best_ || stopped();
  };
  for (const double braking : kBraking) {
    // What is bettered most is not always what can be flown from there.
    if (attempt(kLeads.front(), braking, Refinement::switches)) return;
    for (const Lead& lead : kLeads) {
      if (attempt(lead, braking, Refinement::balance)) return;
    }
    if (!above) return;
  }
}

// Coarse solves that better the durations of the pieces, and then a fine one.
void TrajectoryOptimizer::Method::refine(const Request& request, Plan& plan, int refinements,
                                         Refinement refinement) {
  const bool rests = request.rests();
  const int passes = 1 + refinements + (rests ? 0 : 4);
  const double first_reach_m = corner_reach_m(plan, request.limits);
  double reach_m = first_reach_m;
  for (int pass = 0; pass < passes; ++pass) {
    const double slack = rests ? 0.0 : kEndSlack[std::min<std::size_t>(std::size_t(pass), 4)];
    const bool coarse = pass < refinements;
    double kappa = 1.0;
    if (!solve_scale(request, plan, reach_m, coarse, slack, kappa)) return;
    if (coarse) {
      reach_m = kNarrow * first_reach_m;
      if (refinement == Refinement::balance) {
        balance(request, plan);
      } else if (move_switches(request, plan, kBeyond * first_reach_m) < kWorthAPass) {
        refinements = pass + 1;  // the next is the last
      }
      continue;
    }
    consider(request, plan);
    // Through a face that was left out: look farther, and then at all of them.
    for (const double farther : {first_reach_m, kAllFaces}) {
      if (!outside_ || reach_m >= farther) continue;
      reach_m = farther;
      if (!solve_scale(request, plan, reach_m, coarse, slack, kappa)) return;
      consider(request, plan);
    }
    const bool certified = best_.has_value();
    // A moving end was linearised at kappa = 1: done when it has come to be so.
    const bool settled = certified && (rests || std::abs(kappa - 1.0) < 1e-3);
    if (settled) return;
  }
}

// @return by what part of its duration the flight gets shorter, to first order
double TrajectoryOptimizer::Method::move_switches(const Request& request, Plan& plan,
                                                  double beyond_m) {
  solver_.time_slopes(slopes_);
  for (double& slope : slopes_) slope /= last_.eta;
  return trajectory_optimizer::move_switches(request, config_, slopes_, beyond_m, plan);
}

// Pieces that stay below both limits get less time.
void TrajectoryOptimizer::Method::balance(const Request& request, Plan& plan) const {
  for (std::size_t k = 0; k < plan.durations_s.size(); ++k) {
    const auto piece =
        BezierPiece::between(plan.joints[k], plan.joints[k + 1], plan.durations_s[k]);
    const double u = time_factor(usage_of(piece, request.limits, plan.a_factor(k)));
    plan.durations_s[k] *= std::pow(std::clamp(u, 0.3, 1.0), kBalance);
  }
}

// The thesis' durations from one trapezoid, longer and longer until there is an answer. A flight
// from rest to rest has one in the end; a moving start may have none.
Result<Solution> TrajectoryOptimizer::Method::fixed(const Request& request) {
  try_longer(request, cut_trapezoid(request, config_));
  if (best_) return finish();
  return failure(request);
}

Result<Solution> TrajectoryOptimizer::Method::thesis(const Request& request) {
  Limits per_axis = request.limits;
  per_axis.norm = LimitNorm::per_axis;
  const Request thesis{request.corridor, request.start,      request.goal,
                       per_axis,         request.duration_s, request.out_of_time};
  Plan plan = thesis_plan(thesis);
  if (solve_fixed(thesis, plan)) consider(thesis, plan);
  if (!best_) return failure(thesis);
  if (request.limits.norm == LimitNorm::per_axis) return finish();
  // Other limits than the thesis': its curve, no faster than they allow.
  best_.reset();
  if (request.rests()) slow_to_limits(request, plan, 1.0);
  if (consider(request, plan)) return finish();
  return fail(ErrorCode::not_certified,
              "the thesis' form limits each axis, and breaks the limits asked for: ask for limits "
              "per axis, or use method scale");
}

// The thesis' Ref. [40] and Ref. [42] in the corridor's clothes: what leaves it is not handed out.
Result<Solution> TrajectoryOptimizer::Method::rival(const Request& request) {
  const auto& polytopes = request.corridor.polytopes;
  Trajectory trajectory;
  if (config_.method == "minimum_snap") {
    auto answer =
        minimum_snap(request.corridor.waypoints_map, request.start, request.goal, request.limits);
    if (!answer) return answer.error();
    trajectory = *std::move(answer);
    solves_ = 1;
  } else {
    auto answer =
        rechecked_polynomial(request.corridor.waypoints_map, request.start, request.goal,
                             request.limits, [&](const BezierPiece& piece) {
                               const Polytope& home = polytopes[std::size_t(piece.polytope)];
                               for (int j = 0; j < 6; ++j) {
                                 if (!(home.violation(piece.control_points.col(j)) <= 1e-7))
                                   return false;
                               }
                               return true;
                             });
    if (!answer) return answer.error();
    trajectory = std::move(answer->trajectory);
    solves_ = answer->plans;
  }
  const Certificate certificate =
      measure(trajectory, polytopes, request.limits, request.start, request.goal);
  if (!certificate.holds()) {
    return fail(ErrorCode::not_certified, "the polynomial breaks its promises (" +
                                              certificate.worst() +
                                              "), as this method may: use method scale");
  }
  const int pieces = int(trajectory.pieces.size());
  const double jerk_cost = trajectory.jerk_cost();
  best_ = Solution{std::move(trajectory), certificate, 0, 0, pieces, jerk_cost};
  return finish();
}

void TrajectoryOptimizer::Method::try_longer(const Request& request, const Plan& plan) {
  double factor = 1.0;
  for (double step = 1e-3; factor <= config_.max_stretch; step = std::min(2.0 * step, 0.2)) {
    Plan longer = plan;
    stretch_durations(longer, factor);
    if (solve_fixed(request, longer) && consider(request, longer)) return;
    if (stopped()) return;
    factor *= 1.0 + step;
  }
}

// The same curve between rests, with the durations that its control points need.
void TrajectoryOptimizer::Method::slow_to_limits(const Request& request, Plan& plan,
                                                 double least) const {
  double exact = least;
  for (std::size_t k = 0; k < plan.durations_s.size(); ++k) {
    const auto piece =
        BezierPiece::between(plan.joints[k], plan.joints[k + 1], plan.durations_s[k]);
    exact = std::max(exact, time_factor(usage_of(piece, request.limits, plan.a_factor(k))));
  }
  exact *= 1.0 + 1e-12;
  stretch_durations(plan, exact);
  for (FlatState& joint : plan.joints) {
    joint.velocity /= exact;
    joint.acceleration /= exact * exact;
  }
}

bool TrajectoryOptimizer::Method::solve_scale(const Request& request, Plan& plan, double reach_m,
                                              bool coarse, double end_slack, double& kappa) {
  const double time_weight = coarse ? kCoarseTimeWeight : kTimeWeight;
  if (!make_problem(request, plan, true, time_weight, reach_m, problem_, units_, end_slack))
    return false;
  SplineSolver::Settings settings = coarse ? kCoarse : kFine;
  // From rest to rest the durations are set to what the limits need afterwards.
  if (request.rests()) settings.limit_feasibility = coarse ? kCoarseLimits : kFineLimits;
  settings.max_iterations = config_.max_iterations;
  settings.stop = request.out_of_time;
  last_ = solver_.solve(problem_, settings);
  iterations_ += last_.iterations;
  ++solves_;
  if (last_.status != SplineSolver::Status::solved || !(last_.eta > 0.0)) return false;
  kappa = std::sqrt(last_.eta);
  take_solution(request, solver_.joints(), units_, kappa, plan);
  // Exact: the shape is feasible at any longer duration.
  if (request.rests()) slow_to_limits(request, plan, 0.0);
  return true;
}

bool TrajectoryOptimizer::Method::solve_fixed(const Request& request, Plan& plan) {
  ++solves_;
  last_ = {};
  if (!make_problem(request, plan, false, 1.0, kAllFaces, problem_, units_)) {
    last_.status = SplineSolver::Status::infeasible;
    return false;
  }
  const SplineSolver::Settings settings{config_.max_iterations, 1e-7, 1e-9, 1e-9, 1e-6,
                                        request.out_of_time};
  bool decided = false;
  if (ActiveSetSolver::suits(problem_)) {
    last_ = active_set_.solve(problem_, settings);
    iterations_ += last_.iterations;
    decided = ActiveSetSolver::decided(last_);
  }
  if (!decided) {
    last_ = solver_.solve(problem_, settings);
    iterations_ += last_.iterations;
  }
  if (last_.status != SplineSolver::Status::solved) return false;
  take_solution(request, decided ? active_set_.joints() : solver_.joints(), units_, 1.0, plan);
  return true;
}

bool TrajectoryOptimizer::Method::consider(const Request& request, const Plan& plan) {
  Trajectory trajectory = make_trajectory(plan);
  if (!trajectory.check()) return false;
  const Certificate certificate =
      measure(trajectory, request.corridor.polytopes, request.limits, request.start, request.goal);
  outside_ = certificate.position_m > 1e-6;
  if (!certificate.holds()) return false;
  const double jerk_cost = trajectory.jerk_cost();
  const double natural = natural_jerk(plan, request.limits);
  const double cost = kTimeWeight * std::pow(plan.duration_s() / plan.reference_s, 2) +
                      jerk_cost / (plan.duration_s() * natural * natural);
  if (best_ && best_cost_ <= cost) return true;
  best_cost_ = cost;
  best_plan_ = plan;
  best_ =
      Solution{std::move(trajectory), certificate, 0, 0, int(plan.durations_s.size()), jerk_cost};
  return true;
}

Solution TrajectoryOptimizer::Method::finish() {
  best_->iterations = iterations_;
  best_->solves = solves_;
  return std::move(*best_);
}

Error TrajectoryOptimizer::Method::failure(const Request& request) const {
  using Status = SplineSolver::Status;
  char numbers[160];
  std::snprintf(numbers, sizeof numbers,
                " (%d solves, %d iterations; last primal residual %.2g, gap %.2g)", solves_,
                iterations_, last_.primal_residual, last_.gap);
  if (stopped()) {
    return fail(ErrorCode::deadline_exceeded,
                "the time for optimising was over before there was an answer: allow more time" +
                    std::string(numbers));
  }
  if (config_.method == "thesis" && last_.status == Status::infeasible) {
    return fail(ErrorCode::trajectory_infeasible,
                "one quintic a segment with trapezoid durations cannot stay in the corridor and "
                "its limits: use method scale or fixed" +
                    std::string(numbers));
  }
  if (!request.rests() && last_.status != Status::numerical_trouble) {
    return fail(ErrorCode::start_infeasible,
                "from a speed of " + std::to_string(request.start.velocity.norm()) +
                    " m/s no trajectory within the limits stays in the corridor: replan from "
                    "farther ahead, widen the corridor or raise the acceleration limit" +
                    numbers);
  }
  if (last_.status == Status::infeasible) {
    return fail(ErrorCode::trajectory_infeasible,
                "no trajectory within the limits stays in the corridor: let consecutive polytopes "
                "overlap more or raise max_stretch" +
                    std::string(numbers));
  }
  return fail(ErrorCode::solver_failed,
              "the solver stopped without an answer: look for very thin or very small polytopes, "
              "or raise max_iterations" +
                  std::string(numbers));
}

}  // namespace goshawk::trajectory_optimizer
