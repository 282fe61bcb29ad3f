#pragma once

#include "flight/flight_summary.hpp"
#include "planning/planning.hpp"

namespace goshawk::cli {

/// Everything but the map, written into the folder: pictures, tables, mesh, flight.json.
/// @param goals_map [m] as they were sent
Status write_flight(const std::string& folder, const Json& summary, const FlightRecorder& record,
                    const std::vector<Vec3>& goals_map, const LoadedMap& map,
                    double body_radius_m);

/// The flown track as the second opinion takes it, from the first commit to the end.
std::vector<flight_check::Sample> flown_track(const FlightRecorder& record);

}  // namespace goshawk::cli
