#pragma once

#include "goshawk/core/plan_request.hpp"
#include "goshawk/core/polytope.hpp"

namespace goshawk::trajectory_optimizer {

/// Everything that can be said about a request before solving: check(request), the range of limits
/// and duration, overlap of the polytopes, ends in their place and within the limits.
/// @return invalid_input, invalid_limits, corridor_disjoint or start_infeasible
Status check_request(const PlanRequest& request, const Corridor& corridor);

}  // namespace goshawk::trajectory_optimizer
