#include "flight.hpp"

#include <algorithm>
#include <cmath>

namespace goshawk::trajectory_optimizer {
namespace {

bool leaves_its_polytope(const BezierPiece& piece, const Corridor& corridor) {
  constexpr double kTolerance_m = 1e-6;  // the certificate's
  const Polytope& polytope = corridor.polytopes[std::size_t(piece.polytope)];
  for (int j = 0; j < piece.control_points.cols(); ++j) {
    if (polytope.violation(piece.control_points.col(j)) > kTolerance_m) return true;
  }
  return false;
}

}  // namespace

Judged judge(const Task& task, const Plan& plan) {
  const PlanRequest& request = task.request;
  const Trajectory trajectory = make_trajectory(plan);
  auto certified =
      certify(trajectory, task.corridor.polytopes, request.limits, request.start, request.goal);
  if (!certified) {
    const bool outside = std::ranges::any_of(trajectory.pieces, [&](const BezierPiece& piece) {
      return leaves_its_polytope(piece, task.corridor);
    });
    return {std::nullopt, outside};
  }
  const double jerk_cost = trajectory.jerk_cost();
  const double natural = natural_jerk(plan, request.limits);
  const double cost = kTimeWeight * std::pow(plan.duration_s() / plan.reference_s, 2) +
                      jerk_cost / (plan.duration_s() * natural * natural);
  return {Flight{plan, *std::move(certified), jerk_cost, cost}, false};
}

}  // namespace goshawk::trajectory_optimizer
