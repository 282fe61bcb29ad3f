#pragma once

#include <string>

#include "flight/flight_summary.hpp"
#include "goshawk/flight_report/flight.hpp"

namespace goshawk::cli {

/// What a flight's own recording, flight.mcap in its folder, adds to what was heard of it.

/// How the map grew and what moved. @return io_failed, invalid_input if nothing in it can be drawn
Status add_recorded_world(const std::string& folder, std::int64_t origin_ns,
                          flight_report::Flight& flight);

/// Why the vehicle did not go on, at one moment: an object of docs/cli.md, or null if the recording
/// cannot be read.
/// @param at_ns [ns] when that was heard; what the recorder wrote within a second after it counts
Json recorded_reason(const std::string& folder, std::int64_t at_ns);

/// growth.png: up to four moments of a map that grew; nothing for one that did not.
/// @return io_failed
Status draw_growth(const flight_report::Flight& flight, const std::string& folder);

}  // namespace goshawk::cli
