#pragma once

#include <filesystem>

#include "goshawk/flight_report/flight.hpp"

namespace goshawk::flight_report {

/// Pictures of a flight, PNG, up to 1400 pixels wide. All fail with invalid_input if
/// Flight::check() does, and with io_failed if the file cannot be written.

/// From above, x to the right, y up. Obstacles at the height that is flown nearby are dark,
/// those above or below light, grown ones faint; the corridor is projected.
Status draw_top(const Flight& flight, const std::filesystem::path& png);

/// From the side along x or y, whichever the flight covers less of; z up, stretched if the
/// flight is long (the axis says by how much). Dark is what lies at the depth flown nearby.
Status draw_side(const Flight& flight, const std::filesystem::path& png);

/// Position, speed, acceleration and tracking error against time, with the limits.
/// Also invalid_input if there is neither a trajectory nor a flown track.
Status draw_time(const Flight& flight, const std::filesystem::path& png);

}  // namespace goshawk::flight_report
