#pragma once

#include "goshawk/trajectory_optimizer/task.hpp"

namespace goshawk::baselines {

/// The thesis' own form: one piece a segment of the corridor's waypoints, each as long as from rest
/// to rest (thesis, time allocation, as corrected).
trajectory_optimizer::Plan thesis_plan(const PlanRequest& request, const Corridor& corridor);

/// Minimum jerk with these durations and limits per axis, never stretched. If the request's limits
/// are of another kind, the same curve is flown no faster than they allow.
/// @return trajectory_infeasible (one quintic a segment often cannot keep its limits),
///   not_certified (a moving end and limits that are not per axis), deadline_exceeded,
///   solver_failed
Result<Trajectory> thesis_form(const trajectory_optimizer::Task& task);

}  // namespace goshawk::baselines
