#pragma once

#include "goshawk/tracker/committed_trajectory.hpp"
#include "goshawk/tracker/config.hpp"

namespace goshawk::tracker {

/// Whether a trajectory may be flown at all, wherever the vehicle is. Nothing is taken on trust:
/// the certificate is computed anew from the control points.
/// @return invalid_input (not finite, no piece, a bad polytope, a piece without its polytope),
///         invalid_limits, not_certified (a violated family, or an end that is not at rest),
///         trajectory_infeasible (thrust or tilt beyond the tracker's own bounds)
Status admit(const CommittedTrajectory& committed, const Config& config);

}  // namespace goshawk::tracker
