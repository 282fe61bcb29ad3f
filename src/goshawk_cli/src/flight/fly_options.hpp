#pragma once

#include <optional>
#include <string>
#include <vector>

#include "goshawk/core/vector.hpp"
#include "planning/map_options.hpp"

namespace goshawk::cli {

/// What to fly, and where.
struct FlyOptions {
  MapOptions map;
  std::optional<Vec3> start_map;  // where the vehicle hovers at first
  std::vector<Vec3> goals_map;
  int random = 0;  // that many random reachable goals instead; 0: the goals above
  std::uint64_t seed = 1;
  double min_distance_m = 2.0;  // between random goals
  std::optional<double> world_density;
  std::uint64_t world_seed = 1;
  bool live = false;         // the vehicle begins without a map; its sensors alone know the world
  std::string launch;        // empty: flight, or live
  std::string folder;        // empty: flights/DATE
  double timeout_s = 120.0;  // for each goal
  std::vector<std::string> stage_parameters;  // node:name:=value
  bool keep_going = false;                    // to the next goal if one is not reached
  bool record = true;
};

}  // namespace goshawk::cli
