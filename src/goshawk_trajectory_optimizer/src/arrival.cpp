#include <algorithm>
#include <array>
#include <cmath>

#include "goshawk/trajectory_optimizer/flatness.hpp"
#include "goshawk/trajectory_optimizer/request_check.hpp"
#include "method.hpp"

// Flights with a given duration, and flights that only stop.
namespace goshawk::trajectory_optimizer {
namespace {

constexpr double kRounding = 1e-9;  // of a duration
constexpr int kMostSlowings = 8;
constexpr double kLeastOfLimit = 1e-3;  // of the acceleration limit

void stretch(Plan& plan, double factor) {
  for (double& duration : plan.durations_s) duration *= factor;
  plan.braking_s *= factor;
}

}  // namespace

Result<Solution> TrajectoryOptimizer::Method::arrive(const Request& request, double duration_s,
                                                     Solution soonest) {
  const double least_s = soonest.trajectory.duration_s();
  if (duration_s < least_s * (1.0 - kRounding)) {
    return fail(ErrorCode::trajectory_infeasible,
                "to arrive after " + std::to_string(duration_s) +
                    " s was asked for, and the soonest found is " + std::to_string(least_s) +
                    " s: ask for that or longer, or raise the limits");
  }
  if (auto smooth = arrive_smoothly(request, duration_s)) return smooth;
  if (stopped()) return failure(request);
  const double factor = duration_s / least_s;
  if (factor <= 1.0 + kRounding) return soonest;
  if (!request.rests()) {
    return fail(ErrorCode::trajectory_infeasible,
                "no trajectory of " + std::to_string(duration_s) +
                    " s was found from or to a moving end; the soonest is " +
                    std::to_string(least_s) + " s");
  }
  // Slower along the same curve: always possible between rests.
  for (BezierPiece& piece : soonest.trajectory.pieces) piece.duration_s *= factor;
  soonest.certificate = measure(soonest.trajectory, request.corridor.polytopes, request.limits,
                                request.start, request.goal);
  if (!soonest.certificate.holds()) {
    return fail(ErrorCode::not_certified, "the slower flight: " + soonest.certificate.worst());
  }
  soonest.jerk_cost = soonest.trajectory.jerk_cost();
  return soonest;
}

// Least jerk with the pieces of the soonest flight, all longer by one factor; from a moving end,
// also with the cuts that leave the first polytope sooner or later.
Result<Solution> TrajectoryOptimizer::Method::arrive_smoothly(const Request& request,
                                                              double duration_s) {
  const auto attempt = [&](Plan plan) {
    if (plan.durations_s.empty()) return false;
    stretch(plan, duration_s / plan.duration_s());
    best_.reset();
    return solve_fixed(request, plan) && consider(request, plan) && best_;
  };
  if (config_.method == "scale" || config_.method == "fixed") {
    if (attempt(best_plan_)) return finish();
    constexpr std::array<Lead, 6> kLeads{
        {{0.25, 1.0}, {0.1, 0.5}, {0.05, 0.25}, {0.1, 1.6}, {0.05, 0.1}, {0.05, 3.0}}};
    for (const Lead& lead : kLeads) {
      if (request.rests() || stopped()) break;
      if (attempt(cut_trapezoid(request, config_, lead))) return finish();
    }
  }
  return failure(request);
}

Result<Solution> TrajectoryOptimizer::Method::within_vehicle(const Request& request,
                                                             Solution soonest) {
  const FlatnessLimits vehicle{config_.max_thrust_m_s2, config_.min_thrust_m_s2,
                               config_.max_tilt_rad};
  if (vehicle.none() || respects(flatness_of(soonest.trajectory), vehicle)) return soonest;
  const double safe = vehicle.safe_acceleration_m_s2() / request.limits.a_max_m_s2;
  const bool known = config_.method == "scale" || config_.method == "fixed";
  // A third of the axes' worth: what per-axis limits let through is longer.
  const double share = safe / (request.limits.norm == LimitNorm::euclidean ? 1.0 : std::sqrt(3.0));
  std::optional<Solution> slowed;
  Plan plan = best_plan_;
  for (int pass = 0; known && share > kLeastOfLimit && pass < kMostSlowings; ++pass) {
    plan.a_factors.resize(plan.durations_s.size(), 1.0);
    for (std::size_t k = 0; k < plan.durations_s.size(); ++k) {
      const auto piece =
          BezierPiece::between(plan.joints[k], plan.joints[k + 1], plan.durations_s[k]);
      if (!respects(flatness_of(piece), vehicle)) plan.a_factors[k] = std::min(1.0, share);
    }
    best_.reset();
    refine(request, plan, 0);
    if (!best_) break;
    plan = best_plan_;
    if (!respects(flatness_of(best_->trajectory), vehicle)) continue;
    slowed = finish();
    break;
  }
  // Or carefully everywhere, where that is no slower.
  if (known && share > kLeastOfLimit) {
    Limits limits = request.limits;
    limits.a_max_m_s2 *= std::min(1.0, share);
    limits.a_max_vertical_m_s2 *= std::min(1.0, share);
    const Plan plan_of_slowed = best_plan_;
    auto careful = soonest_flight({request.corridor, request.start, request.goal, limits,
                                   request.duration_s, request.out_of_time});
    if (careful && respects(flatness_of(careful->trajectory), vehicle) &&
        (!slowed || careful->trajectory.duration_s() < slowed->trajectory.duration_s())) {
      careful->certificate = measure(careful->trajectory, request.corridor.polytopes,
                                     request.limits, request.start, request.goal);
      slowed = *std::move(careful);
    } else {
      best_plan_ = plan_of_slowed;
    }
  }
  if (slowed) return *std::move(slowed);
  return fail(ErrorCode::trajectory_infeasible,
              "the flight asks more thrust or tilt than the vehicle has, and could not be slowed "
              "enough: lower the acceleration limit, to " +
                  std::to_string(std::max(0.0, safe * request.limits.a_max_m_s2)) +
                  " m/s^2 to be sure");
}

// Straight on along the velocity, farther and farther, until there is a trajectory; of the first
// few that there are, the soonest.
Result<Solution> TrajectoryOptimizer::Method::stop(const Polytope& free_space,
                                                   const FlatState& start, const Limits& limits) {
  constexpr std::array<double, 10> kReach{1.0, 1.05, 1.15, 1.3, 1.5, 1.8, 2.2, 3.0, 4.5, 7.0};
  constexpr int kEnough = 3;
  const double brake_s = limits.speed_usage(start.velocity) * limits.v_max_m_s / limits.a_max_m_s2;
  std::optional<Solution> soonest_stop;
  Error why = fail(ErrorCode::start_infeasible,
                   "there is no room to stop in front of the vehicle: " + to_text(start.position));
  int found = 0;
  for (const double reach : kReach) {
    FlatState goal;
    goal.position = start.position + 0.5 * reach * brake_s * start.velocity;
    Corridor corridor;
    corridor.waypoints_map = {start.position, goal.position};
    corridor.polytopes = {free_space};
    if (auto status = check_request(corridor, start, goal, limits); !status) {
      if (reach == kReach.front()) why = status.error();
      continue;
    }
    auto solution = answer({corridor, start, goal, limits});
    if (!solution) continue;
    ++found;
    const double duration_s = solution->trajectory.duration_s();
    if (!soonest_stop || duration_s < soonest_stop->trajectory.duration_s()) {
      soonest_stop = *std::move(solution);
    }
    if (found >= kEnough) break;
  }
  if (soonest_stop) return *std::move(soonest_stop);
  return why;
}

}  // namespace goshawk::trajectory_optimizer
