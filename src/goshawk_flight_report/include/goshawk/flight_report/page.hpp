#pragma once

#include <filesystem>
#include <string>

#include "goshawk/flight_report/flight.hpp"

namespace goshawk::flight_report {

/// A flight as one HTML file that opens by double click and needs nothing else: map, path,
/// corridor, trajectory, flown track, a vehicle that moves with a time slider, plots.
///
/// @param page_template the page that goshawk_viewer installs, with "@FLIGHT@" where the flight
/// goes
/// @param summary_json what came of the flight (docs/cli.md), or "null"
/// @return invalid_input if Flight::check() fails or the summary is not JSON; io_failed if the
/// template cannot be read or is not one, or the file cannot be written
Status write_flight_page(const Flight& flight, const std::filesystem::path& page_template,
                         const std::filesystem::path& file,
                         const std::string& summary_json = "null");

}  // namespace goshawk::flight_report
