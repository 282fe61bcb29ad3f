#pragma once

#include "goshawk/core/committed_trajectory.hpp"
#include "goshawk/core/plan_request.hpp"

namespace goshawk::navigator {

/// Does a certified trajectory answer the request? It is proved against what its message claims to
/// have been asked for, so that must be what was asked: the same limits, the start (from rest: near
/// it, for a hovering vehicle moves) and the goal.
/// @param goal_moved_m as far as the search said that it moved the goal
/// @return not_certified, naming what differs
Status check_answer(const Commitment& answer, const PlanRequest& request, double goal_moved_m);

}  // namespace goshawk::navigator
