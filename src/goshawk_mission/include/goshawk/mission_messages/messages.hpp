#pragma once

#include "goshawk/mission/executor.hpp"
#include "goshawk_msgs.h"

/// The mission's messages to its core types and back. Not a part of the core: the library
/// goshawk_mission::messages has it.
namespace goshawk::mission {

/// @return wrong_frame; the content is not checked (check())
Result<Mission> from_msg(const goshawk_msgs::msg::Mission& m);
goshawk_msgs::msg::Mission to_msg(const Mission& mission, std::int64_t stamp_ns);

goshawk_msgs::msg::Goal to_msg(const Goal& goal, std::int64_t stamp_ns);

/// @return nothing for a state that has no constant
std::optional<NavigatorNews> from_msg(const goshawk_msgs::msg::NavigatorState& m);

goshawk_msgs::msg::MissionState to_msg(const Mission& mission, const Progress& progress,
                                       std::int64_t stamp_ns);
/// MissionState's `state`. @return none for a value that has no constant
State mission_state_of(std::uint8_t value);

}  // namespace goshawk::mission
