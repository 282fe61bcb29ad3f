#pragma once

#include "goshawk/core/committed_trajectory.hpp"
#include "goshawk/core/plan_request.hpp"

namespace goshawk::navigator {

/// How far a plan may end from the goal, as the stages said.
struct Shortfall {
  double goal_moved_m = 0.0;  // by the search
  double beyond_m = 0.0;      // of the path, beyond the corridor builder's horizon
};

/// Does a certified trajectory answer the request? It is proved against what its message claims to
/// have been asked for, so that must be what was asked: the same limits, the start (from rest: near
/// it, for a hovering vehicle moves) and the goal, up to the shortfall.
/// @return not_certified, naming what differs
Status check_answer(const Commitment& answer, const PlanRequest& request,
                    const Shortfall& shortfall);

}  // namespace goshawk::navigator
