#pragma once

#include <optional>

#include "goshawk/core/committed_trajectory.hpp"
#include "goshawk/core/free_space.hpp"

namespace goshawk {

/// The stop part that a nominal part needs in a space: it leaves the nominal part as late as the
/// space allows, brakes along its path as hard as the limits allow, and ends at rest. Everything
/// flown from from_s on is then free, at all times and not only at samples.
///
/// All that is flown lies on the nominal part's own curve, so that one question finds how much of
/// it is free; the latest moment follows from how far the vehicle rolls. The moment is the latest
/// up to kStopStep_s, among ways to brake whose deceleration rises and falls linearly.
///
/// @param from_s [s] after the nominal part's start: what comes before is not looked at
/// @return nothing if the nominal part is free to its end and ends at rest; trajectory_blocked with
///   the place if no stop fits before what is in the way. @pre a map has come
Result<std::optional<StopPart>> latest_stop(const CertifiedTrajectory& nominal,
                                            const FreeSpace& space, double from_s);

inline constexpr double kStopStep_s = 0.02;

}  // namespace goshawk
