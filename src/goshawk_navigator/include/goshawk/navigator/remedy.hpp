#pragma once

#include "goshawk/core/error.hpp"

namespace goshawk::navigator {

/// What may help after a plan has failed.
enum class Remedy {
  wait,         // it passes by itself: ask again
  other_start,  // plan from elsewhere: later on what is flown, or from rest
  other_map,    // only the map can change it
  none,
};

/// @param from_motion the plan was to begin in flight
Remedy remedy_of(ErrorCode code, bool from_motion);

/// Whether a newer map may help after asking again has not: the vehicle rests beside what the map
/// learnt late, or the map is of a server that has only just begun.
bool depends_on_map(ErrorCode code);

}  // namespace goshawk::navigator
