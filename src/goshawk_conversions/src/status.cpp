#include "goshawk/conversions/status.hpp"

#include "goshawk_msgs.h"

namespace goshawk::conversions {
namespace {

namespace stage = goshawk_msgs::msg::StageReport_Constants;
namespace state = goshawk_msgs::msg::NavigatorState_Constants;
namespace mode = goshawk_msgs::msg::TrackingState_Constants;

static_assert(std::uint8_t(StageRole::other) == stage::STAGE_OTHER);
static_assert(std::uint8_t(StageRole::map_server) == stage::STAGE_MAP_SERVER);
static_assert(std::uint8_t(StageRole::path_search) == stage::STAGE_PATH_SEARCH);
static_assert(std::uint8_t(StageRole::corridor_builder) == stage::STAGE_CORRIDOR_BUILDER);
static_assert(std::uint8_t(StageRole::trajectory_optimizer) == stage::STAGE_TRAJECTORY_OPTIMIZER);
static_assert(std::uint8_t(StageRole::navigator) == stage::STAGE_NAVIGATOR);
static_assert(std::uint8_t(StageRole::tracker) == stage::STAGE_TRACKER);
static_assert(std::uint8_t(StageRole::vehicle) == stage::STAGE_VEHICLE);
static_assert(std::uint8_t(StageRole::flight_check) == stage::STAGE_FLIGHT_CHECK);
static_assert(std::uint8_t(StageRole::viewer) == stage::STAGE_VIEWER &&
              std::uint8_t(StageRole::mission) == stage::STAGE_MISSION &&
              std::uint8_t(StageRole::guard) == stage::STAGE_GUARD &&
              std::uint8_t(StageRole::obstacle_tracker) == stage::STAGE_OBSTACLE_TRACKER);

}  // namespace

std::uint8_t to_msg(StageRole role) {
  return std::uint8_t(role);
}

StageRole stage_role_of(std::uint8_t value) {
  return value <= stage::STAGE_OBSTACLE_TRACKER ? StageRole(value) : StageRole::other;
}

ErrorCode error_code_of(std::string_view name) {
  for (const ErrorCode code : all_error_codes()) {
    if (to_string(code) == name) return code;
  }
  return ErrorCode::invalid_input;
}

std::string_view navigator_state_word(std::uint8_t value) {
  switch (value) {
    case state::STATE_IDLE:
      return "idle";
    case state::STATE_PLANNING:
      return "planning";
    case state::STATE_FLYING:
      return "flying";
    case state::STATE_ARRIVED:
      return "arrived";
    case state::STATE_FAILED:
      return "failed";
    case state::STATE_HELD:
      return "held";
    default:
      return "unknown";
  }
}

std::string_view tracking_mode_word(std::uint8_t value) {
  switch (value) {
    case mode::MODE_IDLE:
      return "idle";
    case mode::MODE_HOLD:
      return "hold";
    case mode::MODE_FOLLOW:
      return "follow";
    case mode::MODE_BRAKE:
      return "brake";
    case mode::MODE_LAND:
      return "land";
    default:
      return "unknown";
  }
}

}  // namespace goshawk::conversions
