#pragma once

#include <cstdint>
#include <optional>
#include <string_view>

namespace goshawk {

/// What a stage does for the others, whatever its node is called. In the order of the constants
/// STAGE_* of goshawk_msgs/msg/StageReport.
enum class StageRole : std::uint8_t {
  other,
  map_server,
  path_search,
  corridor_builder,
  trajectory_optimizer,
  navigator,
  tracker,
  vehicle,  // a simulator, or the bridge to an autopilot
  flight_check,
  viewer,
  mission,
  guard,
  obstacle_tracker
};

/// "path_search"
std::string_view to_string(StageRole role);

/// @param word as to_string() writes it @return nothing for any other word
std::optional<StageRole> stage_role_of(std::string_view word);

}  // namespace goshawk
