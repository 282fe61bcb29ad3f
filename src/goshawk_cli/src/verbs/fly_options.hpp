#pragma once

#include <optional>

#include "planning/map_options.hpp"

namespace goshawk::cli {

struct FlyOptions {
  MapOptions map;
  std::string start;
  std::vector<std::string> goals;
  int random = 0;
  std::uint64_t seed = 1;
  double min_distance_m = 2.0;
  std::optional<double> world_density;
  std::uint64_t world_seed = 1;
  std::string launch = "flight";
  std::string folder;
  double timeout_s = 120.0;
  std::vector<std::string> stage_parameters;  // node:name:=value
  bool no_record = false;
  bool json = false;

  void add_to(CLI::App& app);
};

}  // namespace goshawk::cli
