#pragma once

#include "goshawk/core/certificate.hpp"
#include "goshawk/core/polytope.hpp"
#include "goshawk/core/result.hpp"
#include "goshawk/core/trajectory.hpp"

namespace goshawk::trajectory_optimizer {

/// Everything that can be said about a request before solving: sizes, finiteness, limits, overlap
/// of the polytopes, ends in their place and within the limits.
/// @return invalid_input, invalid_limits, corridor_disjoint or start_infeasible
Status check_request(const Corridor& corridor, const FlatState& start, const FlatState& goal,
                     const Limits& limits);

}  // namespace goshawk::trajectory_optimizer
