#pragma once

#include <cstdint>
#include <string_view>

#include "goshawk/core/error.hpp"
#include "goshawk/core/stage_role.hpp"

/// Values of status messages that have names (STATE_ARRIVED), for code and for people.
namespace goshawk::conversions {

/// A counter of stage reports: datagrams that the stage's process refused (docs/security.md).
inline constexpr const char* kRefusedDatagrams = "refused_datagrams";

/// StageReport's `stage`
std::uint8_t to_msg(StageRole role);
/// @return other for a value that has no constant
StageRole stage_role_of(std::uint8_t stage);
/// StageReport's `code`. @return invalid_input for a name that is no code
ErrorCode error_code_of(std::string_view name);

/// NavigatorState's `state` as a word: "arrived"; "unknown" for a value that has no constant.
std::string_view navigator_state_word(std::uint8_t state);
/// TrackingState's `mode` as a word: "follow"; "unknown" for a value that has no constant.
std::string_view tracking_mode_word(std::uint8_t mode);

}  // namespace goshawk::conversions
