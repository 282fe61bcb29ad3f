#pragma once

#include "cli.hpp"
#include "planning/planning.hpp"

namespace goshawk::cli {

/// The options that `plan` and `fly` share: which map, what vehicle, what limits. What is not
/// given comes from --params-file, then from the defaults.
struct MapOptions {
  std::string map;
  std::string unknown;
  std::string v_max, a_max, radius, margin, resolution;  // as written; empty: not given
  std::vector<std::string> params_files;

  void add_to(CLI::App& app);

  /// The same as `--ros-args`, so that one code reads and checks both.
  runtime::RosArgs ros_args(const std::string& map_file) const;

  /// @return invalid_parameter for what is no number; zero or negative limits are for Limits::check
  Result<Limits> limits(const Limits& defaults) const;
};

/// A default world under the temporary folder, for calls that name no map. @return its file
Result<std::string> save_default_world(const std::string& folder);

}  // namespace goshawk::cli
