#pragma once

#include "cli.hpp"
#include "planning/planning.hpp"

namespace goshawk::cli {

/// The options that `plan` and `fly` share: which map, what vehicle, what limits. What the call
/// lacks comes from --params-file, then from the defaults.
struct MapOptions {
  std::string map;
  std::string unknown;
  // As written; empty: not given.
  std::string v_max, a_max, norm, j_max, v_max_vertical, a_max_vertical;
  std::string radius, margin, resolution;
  std::vector<std::string> params_files;

  void add_to(CLI::App& app);

  /// The same as `--ros-args`, so that one code reads and checks both.
  runtime::RosArgs ros_args(const std::string& map_file) const;

  /// @return invalid_parameter for what is not a number or not a norm; zero and negative limits are
  /// for Limits::check
  Result<Limits> limits(const Limits& defaults) const;
};

/// A default world under the temporary folder, for calls that name no map. @return its file
Result<std::string> save_default_world(const std::string& folder);

}  // namespace goshawk::cli
