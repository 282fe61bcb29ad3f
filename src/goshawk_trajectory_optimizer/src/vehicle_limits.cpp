#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "goshawk/core/thrust.hpp"
#include "strategies.hpp"

namespace goshawk::trajectory_optimizer {
namespace {

constexpr int kMostSlowings = 8;
constexpr double kLeastOfLimit = 1e-3;  // of the acceleration limit

bool respects(const Flight& flight, const ThrustLimits& vehicle) {
  return respects(thrust_of(flight.certified.trajectory()), vehicle);
}

// The pieces that ask too much get this share of the acceleration limit, until none does.
std::optional<Flight> slow_where_needed(const Task& task, const ThrustLimits& vehicle, double share,
                                        const Flight& flight) {
  Plan plan = flight.plan;
  for (int pass = 0; pass < kMostSlowings; ++pass) {
    plan.a_factors.resize(plan.durations_s.size(), 1.0);
    for (std::size_t k = 0; k < plan.durations_s.size(); ++k) {
      if (!respects(thrust_of(plan.piece(k)), vehicle)) plan.a_factors[k] = share;
    }
    auto slower = soonest_with_cut(task, plan);
    if (!slower) return {};
    if (respects(*slower, vehicle)) return slower;
    plan = slower->plan;
  }
  return {};
}

// With this share of the acceleration limit from start to goal.
std::optional<Flight> slow_everywhere(const Task& task, const ThrustLimits& vehicle, double share) {
  PlanRequest careful = task.request;
  careful.limits.a_max_m_s2 *= share;
  careful.limits.a_max_vertical_m_s2 *= share;
  auto flight =
      fastest({careful, task.corridor, task.config, task.workspace, task.effort, task.out_of_time});
  if (!flight || !respects(*flight, vehicle)) return {};
  auto certified = certify(flight->certified.trajectory(), task.corridor.polytopes,
                           task.request.limits, task.request.start, task.request.goal);
  if (!certified) return {};
  flight->certified = *std::move(certified);
  return flight;
}

}  // namespace

Result<Flight> within_vehicle(const Task& task, Flight flight) {
  const ThrustLimits vehicle{task.config.max_thrust_m_s2, task.config.min_thrust_m_s2,
                             task.config.max_tilt_rad};
  if (vehicle.none() || respects(flight, vehicle)) return flight;
  const Limits& limits = task.request.limits;
  const double safe_m_s2 = vehicle.safe_acceleration_m_s2();
  // Per axis, or horizontally and vertically apart, a limit lets up to sqrt(3) of it through.
  const double share =
      safe_m_s2 / limits.a_max_m_s2 / (limits.norm == LimitNorm::euclidean ? 1.0 : std::sqrt(3.0));
  if (share > kLeastOfLimit) {
    auto here = slow_where_needed(task, vehicle, std::min(1.0, share), flight);
    auto everywhere = slow_everywhere(task, vehicle, std::min(1.0, share));
    const bool simpler =
        everywhere && (!here || everywhere->certified.duration_s() < here->certified.duration_s());
    if (simpler) return *std::move(everywhere);
    if (here) return *std::move(here);
  }
  if (task.effort.stopped()) return no_flight(task);
  return fail(ErrorCode::trajectory_infeasible,
              fmt::format("the flight needs more thrust or tilt than the vehicle has, and slowing "
                          "it down did not help: lower the acceleration limit; {:.3g} m/s^2 is "
                          "always flyable",
                          std::max(0.0, safe_m_s2)));
}

}  // namespace goshawk::trajectory_optimizer
