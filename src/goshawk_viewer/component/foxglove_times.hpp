#pragma once

#include <nlohmann/json.hpp>

namespace goshawk::viewer_bridge {

/// Foxglove's panels write times as {sec, nsec}, as ROS 1 did; ROS 2's types say {sec, nanosec}.
/// Renames them in place, at any depth down to 20.
inline void rename_nanoseconds(nlohmann::ordered_json& value, int depth = 0) {
  if (!value.is_structured() || depth > 20) return;
  if (value.is_object() && value.size() == 2 && value.contains("sec") && value.contains("nsec")) {
    value = {{"sec", value["sec"]}, {"nanosec", value["nsec"]}};
    return;
  }
  for (auto& inner : value) rename_nanoseconds(inner, depth + 1);
}

}  // namespace goshawk::viewer_bridge
