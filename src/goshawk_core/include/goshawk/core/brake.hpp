#pragma once

#include <functional>

#include "goshawk/core/committed_trajectory.hpp"

namespace goshawk {

/// A way to rest along the path of a committed trajectory: the same curve, in the same polytopes,
/// ever slower. As soon as the limits of that trajectory allow.
///
/// The speed falls smoothly: the rate at which the path's own time passes goes from one to zero as
/// the integral of a trapezoid, so that the acceleration has no jump. Quintics between its states
/// approach that curve; the certificate then proves them as any other.
///
/// @param from_s [s] after the trajectory's start, in [0, duration)
/// @param is_free asked of each candidate; a way that is not free is not taken
/// @return the way, its times from from_s on; trajectory_infeasible: the trajectory ends sooner by
///         itself, or no slower way keeps its limits here (in a turn at the limit)
Result<CertifiedTrajectory> brake_along(
    const CommittedTrajectory& committed, double from_s,
    const std::function<bool(const Trajectory&)>& is_free = [](const Trajectory&) { return true; });

}  // namespace goshawk
