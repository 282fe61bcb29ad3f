#pragma once

#include "goshawk/core/committed_trajectory.hpp"
#include "goshawk/tracker/config.hpp"

namespace goshawk::tracker {

/// Whether this vehicle can fly a trajectory at all, wherever it is. That it keeps its corridor and
/// limits and ends at rest is proved by its type.
/// @return trajectory_infeasible: thrust or tilt beyond the tracker's own bounds; invalid_input: so
/// many pieces that a control step would take long
Status admit(const CommittedTrajectory& committed, const Config& config);

}  // namespace goshawk::tracker
