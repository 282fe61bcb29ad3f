#pragma once

#include <functional>

#include "flight/flight_summary.hpp"
#include "planning/planning.hpp"

namespace goshawk::cli {

/// Everything but the map, written into the folder: pictures, tables, mesh, flight.json.
/// @param goals_map [m] as they were sent
/// @param recorded whether the folder has a recording, of which the page shows how the map grew
/// @param say told if that recording cannot be read: all else is written
Status write_flight(const std::string& folder, const Json& summary, const FlightRecorder& record,
                    const std::vector<Vec3>& goals_map, const LoadedMap& map, double body_radius_m,
                    bool recorded, const std::function<void(const std::string&)>& say);

/// The flown track as the second opinion takes it, from the first commit to the end.
std::vector<flight_check::Sample> flown_track(const FlightRecorder& record);

}  // namespace goshawk::cli
