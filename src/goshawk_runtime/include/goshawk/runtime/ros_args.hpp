#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "goshawk/core/result.hpp"
#include "goshawk/runtime/parameters.hpp"

namespace goshawk::runtime {

/// The arguments after `--ros-args`, as ROS 2 users know them:
///   -r from:=to           remap a topic (`-r node:from:=to` for one node of several);
///                         __ns:=/uav1 the namespace, __node:=name the node
///   -p name:=value        one parameter (`-p node:name:=value` for one node of several)
///   --params-file FILE    parameters of one or many nodes
///   --log-level LEVEL     trace, debug, info, warn, error, off
struct RosArgs {
  std::string node_namespace = "/";
  std::string node_name;  // empty: the component's own name
  std::string log_level = "info";
  struct Remap {
    std::string from;
    std::string to;
    std::string node = {};  // empty: any node
  };
  std::vector<Remap> remaps;
  std::vector<std::string> params_files;

  struct Override {
    std::string node;  // empty: any node
    std::string name;
    std::string value;
  };
  std::vector<Override> overrides;

  /// Takes the part from `--ros-args` on (up to `--` or the end) out of `arguments`.
  /// @return invalid_input that names the argument which is wrong
  static Result<RosArgs> extract(std::vector<std::string>& arguments);

  /// @return the node's parameters from files and overrides, unchecked against a config struct
  Result<ParameterSource> parameters_of(std::string_view name) const;

  /// A topic's full name: remapped, then put under the namespace unless it begins with '/'.
  /// @param node that uses the topic: remappings for other nodes do not apply
  std::string resolve_topic(std::string_view topic, std::string_view node = {}) const;
};

/// @return invalid_input unless the name consists of letters, digits, '_' and '/', as in ROS
Status check_topic_name(std::string_view topic);

}  // namespace goshawk::runtime
