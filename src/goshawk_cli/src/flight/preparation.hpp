#pragma once

#include "flight/fly_options.hpp"
#include "flight/random_tour.hpp"
#include "planning/planning.hpp"

namespace goshawk::cli {

/// All that a flight needs, checked before anything is started or written.
struct Preparation {
  PlanningConfig config;
  LoadedMap map;
  Tour tour;
  Limits limits;
  std::vector<std::string> notes;  // sentences: what looks wrong about the map, what was moved
};

/// @return invalid_parameter, invalid_limits, why the map cannot be read, or why the vehicle cannot
/// hover at its start, or at a goal (unless it keeps going to the next one)
Result<Preparation> prepare(const FlyOptions& options);

/// Makes the flight folder with the map in it as world.bt.
/// @return its absolute path, or io_failed
Result<std::string> make_flight_folder(const FlyOptions& options, const Preparation& preparation);

/// What `goshawk launch` is called with for this flight.
std::vector<std::string> launch_arguments(const FlyOptions& options, const Preparation& preparation,
                                          const std::string& folder);

}  // namespace goshawk::cli
