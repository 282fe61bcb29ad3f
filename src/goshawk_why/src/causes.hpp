#pragma once

#include <optional>

#include "goshawk/why/why.hpp"

namespace goshawk::why {

/// The tracker brakes or lands by itself. @pre a tracker
std::optional<Reason> tracker_stop(const Snapshot& snapshot);
/// The navigator gave the goal up. @pre a map, a vehicle, a navigator that has failed
Reason failure(const Snapshot& snapshot);
/// It waits for a plan from rest. @pre as failure()
Reason planning(const Snapshot& snapshot);
/// It flies: what keeps it from flying faster. @pre as failure()
Reason flight(const Snapshot& snapshot);

}  // namespace goshawk::why
