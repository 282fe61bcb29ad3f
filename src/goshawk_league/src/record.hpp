#pragma once

#include "goshawk/league/flight.hpp"

namespace goshawk::league {

/// How much of the limits a state uses, each quantity as the limits say; the jerk by its length.
double use_of(const FlatState& reference, const Limits& limits);

/// Adds a moment, and what follows from it.
void record(const Moment& moment, const Limits& limits, Outcome& outcome);

/// The second opinion on the whole flight. @return what the judge says that it cannot judge
Status judge(const Scene& scene, Outcome& outcome);

}  // namespace goshawk::league
