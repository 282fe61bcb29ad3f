#pragma once

#include <filesystem>
#include <span>

#include "goshawk/flight_report/map_timeline.hpp"

namespace goshawk::flight_report {

/// From above, one panel a moment: what is known about the height that was flown nearby, what was
/// learnt since the panel before, obstacles as measured (grown ones if the grid has no others), the
/// window and the track.
/// @return invalid_input for no moment, more than 12, or numbers that are not finite; io_failed
Status draw_growth(std::span<const MapMoment> moments, const std::filesystem::path& png);

}  // namespace goshawk::flight_report
