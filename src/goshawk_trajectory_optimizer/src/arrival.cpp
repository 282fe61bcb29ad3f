#include <array>
#include <cmath>

#include <fmt/format.h>

#include "strategies.hpp"

namespace goshawk::trajectory_optimizer {
namespace {

constexpr double kRounding = 1e-9;  // of a duration

// Least jerk with the pieces of the soonest flight, all longer by one factor; from a moving end,
// also with cuts that leave the first polytope sooner or later.
std::optional<Flight> smoothest(const Task& task, double duration_s, const Plan& soonest) {
  constexpr std::array<Lead, 6> kLeads{
      {{0.25, 1.0}, {0.1, 0.5}, {0.05, 0.25}, {0.1, 1.6}, {0.05, 0.1}, {0.05, 3.0}}};
  const auto attempt = [&](Plan plan) -> std::optional<Flight> {
    const double factor = duration_s / plan.duration_s();
    plan.stretch(factor);
    plan.braking_s *= factor;
    if (!solve_fixed(task, plan)) return {};
    return judge(task, plan).flight;
  };
  if (auto flight = attempt(soonest)) return flight;
  for (const Lead& lead : kLeads) {
    if (from_rest_to_rest(task.request) || task.effort.stopped()) break;
    if (auto flight = attempt(cut_trapezoid(task.request, task.corridor, task.config, lead))) return flight;
  }
  return {};
}

// Slower along the same curve: always possible between rests.
Result<Flight> slower(const Task& task, double factor, Flight flight) {
  Trajectory trajectory = flight.certified.trajectory();
  for (BezierPiece& piece : trajectory.pieces) piece.duration_s *= factor;
  flight.jerk_cost = trajectory.jerk_cost();
  auto certified = certify(std::move(trajectory), task.corridor.polytopes, task.request.limits,
                           task.request.start, task.request.goal);
  if (!certified) return certified.error();
  flight.certified = *std::move(certified);
  return flight;
}

}  // namespace

Result<Flight> arrive_after(const Task& task, double duration_s, Flight soonest) {
  const double least_s = soonest.certified.duration_s();
  if (duration_s < least_s * (1.0 - kRounding)) {
    return fail(ErrorCode::trajectory_infeasible,
                fmt::format("a flight of {:.4g} s is too short: the soonest found takes {:.4g} s; "
                            "ask for that or longer, or raise the limits",
                            duration_s, least_s));
  }
  if (auto flight = smoothest(task, duration_s, soonest.plan)) return *std::move(flight);
  if (task.effort.stopped()) return no_flight(task);
  const double factor = duration_s / least_s;
  if (factor <= 1.0 + kRounding) return soonest;
  if (from_rest_to_rest(task.request)) return slower(task, factor, std::move(soonest));
  return fail(ErrorCode::trajectory_infeasible,
              fmt::format("found no flight of {:.4g} s from or to a moving end; the soonest takes "
                          "{:.4g} s: ask for another duration",
                          duration_s, least_s));
}

}  // namespace goshawk::trajectory_optimizer
