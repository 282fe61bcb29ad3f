#pragma once

#include <array>
#include <vector>

#include "goshawk/flight_report/flight.hpp"
#include "plot.hpp"

namespace goshawk::flight_report {

/// What the pictures show along x, y and z [m].
using MapWindow = std::array<Interval, 3>;

/// The flight with some room around it, no more than the map if there is one, but always the
/// flight; of a low map the whole height.
MapWindow window_of(const Flight& flight);

/// @return at most 150 points of the way that was taken, or of the best that is known of it
std::vector<Vec3> guide(const Flight& flight);

}  // namespace goshawk::flight_report
