#include <algorithm>
#include <array>
#include <cmath>

#include "goshawk/trajectory_optimizer/limit_usage.hpp"
#include "strategies.hpp"
#include "switching.hpp"

// Coarse solves that give each polytope (or each piece) its time, and then a fine one.
namespace goshawk::trajectory_optimizer {
namespace {

// Of the first reach: how far faces matter once the shape is nearly known.
constexpr double kNarrow = 0.35;
// Exponent of a piece's use of its limits: above 1, as what one piece gives up others need.
constexpr double kBalance = 1.8;
constexpr int kMostMovingPasses = 2;  // with a moving end, which needs more fine ones
constexpr int kMovingFinePasses = 5;
// Of the first reach: how far beyond a polytope the flight may be where it changes to the next.
constexpr double kBeyond = 0.04;
constexpr double kWorthAPass = 0.01;                                    // of the duration
constexpr std::array<double, 5> kEndSlack{2e-2, 2e-3, 2e-5, 0.0, 0.0};  // pass by pass
constexpr double kSettled = 1e-3;  // of kappa: the linearised moving end is exact at 1

/// What a coarse solve is for: the time in each polytope, or the durations of the pieces by their
/// use of the limits.
enum class Refinement { switches, balance };

double end_slack(const PlanRequest& request, int pass) {
  return from_rest_to_rest(request) ? 0.0 : kEndSlack[std::min<std::size_t>(std::size_t(pass), 4)];
}

// Pieces that stay below their limits get less time.
void balance(const Limits& limits, Plan& plan) {
  for (std::size_t k = 0; k < plan.durations_s.size(); ++k) {
    const double use = time_factor(usage_of(plan.piece(k), limits, plan.a_factor(k)));
    plan.durations_s[k] *= std::pow(std::clamp(use, 0.3, 1.0), kBalance);
  }
}

// Gives each polytope its time, by what that is worth in the solve before.
// @return to first order, by what part of its duration the flight gets shorter
double switch_better(const Task& task, double beyond_m, Plan& plan) {
  std::vector<double>& slopes = task.workspace.slopes;
  task.workspace.interior_point.time_slopes(slopes);
  for (double& slope : slopes) slope /= task.effort.last.eta;
  return move_switches(task.request, task.corridor, task.config, slopes, beyond_m, plan);
}

// @param plan the guess; left as the last solve made it
// @return how many passes were made; nothing if a solve failed
std::optional<int> coarse_passes(const Task& task, int most, Refinement refinement,
                                 double first_reach_m, Plan& plan) {
  for (int pass = 0; pass < most; ++pass) {
    const double reach_m = pass == 0 ? first_reach_m : kNarrow * first_reach_m;
    const ScaleSettings settings{reach_m, true, end_slack(task.request, pass)};
    if (!solve_scale(task, settings, plan)) return {};
    if (refinement == Refinement::balance) {
      balance(task.request.limits, plan);
    } else if (switch_better(task, kBeyond * first_reach_m, plan) < kWorthAPass) {
      return pass + 1;
    }
  }
  return most;
}

// The cheaper of two.
void keep(std::optional<Flight>& best, std::optional<Flight>&& flight) {
  if (flight && (!best || flight->cost < best->cost)) best = std::move(flight);
}

// From rest to rest one solve is enough. A moving end is linearised at kappa = 1: solves follow
// until kappa is 1. If a solution leaves a face that was left out, it is solved again with faces
// from farther away, and then with all of them.
std::optional<Flight> fine_passes(const Task& task, int first_pass, int end_pass, double reach_m,
                                  double first_reach_m, Plan& plan) {
  std::optional<Flight> best;
  for (int pass = first_pass; pass < end_pass; ++pass) {
    double kappa = 1.0;
    for (bool outside = true; outside;) {
      const auto scaled = solve_scale(task, {reach_m, false, end_slack(task.request, pass)}, plan);
      if (!scaled) return best;
      kappa = *scaled;
      Judged judged = judge(task, plan);
      outside = judged.outside && reach_m < kAllFaces;
      if (outside) reach_m = reach_m < first_reach_m ? first_reach_m : kAllFaces;
      keep(best, std::move(judged.flight));
    }
    if (best && (from_rest_to_rest(task.request) || std::abs(kappa - 1.0) < kSettled)) break;
  }
  return best;
}

// @param plan the guess; left as the last solve made it
std::optional<Flight> refine(const Task& task, int coarse, Refinement refinement, Plan& plan) {
  const int fine = from_rest_to_rest(task.request) ? 1 : kMovingFinePasses;
  const double first_reach_m = corner_reach_m(plan, task.request.limits);
  const auto passes = coarse_passes(task, coarse, refinement, first_reach_m, plan);
  if (!passes) return {};
  const double reach_m = *passes > 0 ? kNarrow * first_reach_m : first_reach_m;
  return fine_passes(task, *passes, coarse + fine, reach_m, first_reach_m, plan);
}

// Durations too uneven to compute with are cut anew and left as they are.
std::optional<Flight> soonest_from_rest(const Task& task, const Plan& trapezoid) {
  const int passes = task.config.refinement_passes;
  Plan plan = trapezoid;
  auto flight = refine(task, passes, Refinement::switches, plan);
  if (flight || passes == 0 || task.effort.stopped()) return flight;
  plan = trapezoid;
  return refine(task, 0, Refinement::switches, plan);
}

// Guess after guess of how the moving end is met, until one has a solution.
std::optional<Flight> soonest_moving(const Task& task) {
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
  const bool above = StartAllowance::of(task.request.start, task.request.limits).until_s > 0.0;
  const int passes = std::min(task.config.refinement_passes, kMostMovingPasses);
  Plan plan;
  std::optional<Flight> flight;
  const auto attempt = [&](Lead lead, double braking, Refinement refinement) {
    lead.braking = braking;
    plan = cut_trapezoid(task.request, task.corridor, task.config, lead);
    flight = refine(task, passes, refinement, plan);
    return flight || task.effort.stopped();
  };
  for (const double braking : kBraking) {
    // What gains most time does not always have a solution from there.
    if (attempt(kLeads.front(), braking, Refinement::switches)) return flight;
    for (const Lead& lead : kLeads) {
      if (attempt(lead, braking, Refinement::balance)) return flight;
    }
    if (!above) break;
  }
  return stretched(task, plan);
}

}  // namespace

std::optional<Flight> fastest(const Task& task) {
  task.effort.last = {};
  return task.config.method == Method::fixed ? fixed_durations(task) : soonest(task);
}

std::optional<Flight> soonest_with_cut(const Task& task, Plan plan) {
  return refine(task, 0, Refinement::switches, plan);
}

std::optional<Flight> soonest(const Task& task) {
  const Plan trapezoid = cut_trapezoid(task.request, task.corridor, task.config);
  if (trapezoid.stays) return fixed_durations(task);
  return from_rest_to_rest(task.request) ? soonest_from_rest(task, trapezoid)
                                         : soonest_moving(task);
}

}  // namespace goshawk::trajectory_optimizer
