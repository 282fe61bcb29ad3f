#pragma once

#include <optional>
#include <string>
#include <vector>

#include "goshawk/core/limits.hpp"
#include "goshawk/runtime/ros_args.hpp"

namespace goshawk::cli {

/// Which map, what vehicle, what limits: what `plan`, `fly` and `bench plan` share. What is not
/// given comes from the files of parameters, then from the defaults.
struct MapOptions {
  std::string map;
  // Parameters of the map server as written, which checks them; empty: not given.
  std::string unknown, radius, margin, resolution;
  std::optional<double> v_max_m_s, a_max_m_s2, v_max_vertical_m_s, a_max_vertical_m_s2, j_max_m_s3;
  std::string norm;  // a word of LimitNorm; empty: not given
  std::vector<std::string> params_files;

  /// As `--ros-args` would say it, so that one code reads and checks both.
  runtime::RosArgs ros_args() const;

  /// The defaults unless given; zero or negative ones are for Limits::check.
  Limits limits() const;
};

}  // namespace goshawk::cli
