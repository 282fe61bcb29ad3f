#pragma once

#include <cstdint>
#include <string>

#include "goshawk/league/flight.hpp"

namespace goshawk::league {

/// One flight of a campaign: a world that the vehicle does not know, a sensor, limits and a goal.
struct LiveCase {
  std::uint64_t number = 0;
  std::string kind = {};  // of the world, as worlds::world_kinds()
  double density = 0.0;   // as worlds::WorldSpec::density
  Scene scene = {};
  Options options = {};
};

/// Draws all of it from the number. @param vehicle the vehicle and its stages
/// @return what keeps a world from being made
Result<LiveCase> make_live_case(std::uint64_t number, const closed_loop::Setup& vehicle);

/// Does a search through the known world, at the clearance of plans, lead to the goal?
/// @return map_too_large
Result<bool> can_be_reached(const Scene& scene);

}  // namespace goshawk::league
