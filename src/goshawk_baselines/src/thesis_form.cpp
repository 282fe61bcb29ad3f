#include "goshawk/baselines/thesis_form.hpp"

#include <algorithm>

#include "goshawk/trajectory_optimizer/time_profile.hpp"

namespace goshawk::baselines {
namespace {

using namespace trajectory_optimizer;

constexpr double kShortest_m = 1e-6;

Error no_trajectory(const Effort& effort) {
  switch (effort.last.status) {
    case SplineSolver::Status::stopped:
      return fail(ErrorCode::deadline_exceeded,
                  "the deadline passed before a trajectory was found: allow more time");
    case SplineSolver::Status::infeasible:
      return fail(ErrorCode::trajectory_infeasible,
                  "one quintic a segment with the durations from rest to rest cannot stay in the "
                  "corridor and within the limits: use trajectory_optimizer");
    default:
      return fail(ErrorCode::solver_failed,
                  "the solver found no trajectory: look for very thin or very small polytopes");
  }
}

}  // namespace

Plan thesis_plan(const PlanRequest& request, const Corridor& corridor) {
  const auto& waypoints = corridor.waypoints_map;
  Plan plan;
  plan.knots.push_back(request.start);
  for (std::size_t k = 0; k + 1 < waypoints.size(); ++k) {
    const double length_m = std::max((waypoints[k + 1] - waypoints[k]).norm(), kShortest_m);
    plan.durations_s.push_back(
        rest_to_rest_duration_s(length_m, request.limits.v_max_m_s, request.limits.a_max_m_s2));
    plan.polytopes.push_back(int(k));
    FlatState& end = plan.knots.emplace_back();
    end.position = waypoints[k + 1];
  }
  plan.knots.back() = request.goal;
  plan.reference_s = plan.duration_s();
  return plan;
}

Result<Trajectory> thesis_form(const Task& task) {
  const PlanRequest& request = task.request;
  PlanRequest per_axis = request;
  per_axis.limits.norm = LimitNorm::per_axis;
  Plan plan = thesis_plan(per_axis, task.corridor);
  const Task of_thesis{per_axis,       task.corridor, task.config,
                       task.workspace, task.effort,   task.out_of_time};
  if (!solve_fixed(of_thesis, plan)) return no_trajectory(task.effort);
  const bool other_limits = request.limits.norm != LimitNorm::per_axis;
  if (other_limits && from_rest_to_rest(request)) slow_to_limits(request.limits, 1.0, plan);
  return make_trajectory(plan);
}

}  // namespace goshawk::baselines
