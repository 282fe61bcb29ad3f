#pragma once

#include <cstdint>
#include <string>

#include "goshawk/px4_wire/commands.hpp"

namespace goshawk::px4 {

inline constexpr std::uint16_t kComponent = 191;  // MAV_COMP_ID_ONBOARD_COMPUTER

/// PX4's name of a nav_state.
inline std::string mode_name(std::uint8_t mode) {
  switch (mode) {
    case nav_state::kManual:
      return "Manual";
    case nav_state::kAltitude:
      return "Altitude";
    case nav_state::kPosition:
      return "Position";
    case nav_state::kHold:
      return "Hold";
    case nav_state::kReturn:
      return "Return";
    case nav_state::kDescend:
      return "Descend";
    case nav_state::kTermination:
      return "Termination";
    case nav_state::kOffboard:
      return "Offboard";
    case nav_state::kStabilized:
      return "Stabilized";
    case nav_state::kTakeoff:
      return "Takeoff";
    case nav_state::kLand:
      return "Land";
    default:
      return "mode " + std::to_string(mode);
  }
}

inline bool is_flown_by_hand(std::uint8_t mode) {
  constexpr std::uint8_t kAcro = 10;
  return mode <= nav_state::kPosition || mode == kAcro || mode == nav_state::kStabilized;
}

inline std::string command_name(std::uint32_t command) {
  if (command == VehicleCommand::kArm) return "to arm";
  if (command == VehicleCommand::kSetNavState) return "the change of mode";
  return "command " + std::to_string(command);
}

}  // namespace goshawk::px4
