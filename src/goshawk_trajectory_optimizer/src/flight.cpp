#include "flight.hpp"

#include <cmath>

namespace goshawk::trajectory_optimizer {

Judged judge(const Request& request, const Plan& plan) {
  Trajectory trajectory = make_trajectory(plan);
  if (!trajectory.check()) return {};
  const Certificate certificate =
      certify(trajectory, request.corridor.polytopes, request.limits, request.start, request.goal);
  const bool outside = certificate.position_m > 1e-6;
  if (!certificate.holds()) return {std::nullopt, outside};
  const double jerk_cost = trajectory.jerk_cost();
  const double natural = natural_jerk(plan, request.limits);
  const double cost = kTimeWeight * std::pow(plan.duration_s() / plan.reference_s, 2) +
                      jerk_cost / (plan.duration_s() * natural * natural);
  return {Flight{plan, std::move(trajectory), certificate, jerk_cost, cost}, outside};
}

}  // namespace goshawk::trajectory_optimizer
