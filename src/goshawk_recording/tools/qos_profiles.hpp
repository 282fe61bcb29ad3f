#pragma once

#include <string>
#include <vector>

#include "goshawk/runtime/context.hpp"
#include "goshawk/runtime/qos.hpp"

namespace goshawk::recording {

inline constexpr const char* kQosKey = "offered_qos_profiles";

/// What writers offer, as ROS 2 bags store it in the channel's metadata: YAML, one entry a writer.
/// DDS does not transmit history and depth; they are "unknown".
std::string to_profiles(const std::vector<runtime::EndpointInfo>& writers);

/// What a player must offer to serve all readers of the recorded writers: the most that any of them
/// offered. Takes words and numbers, as different ROS 2 versions write them.
/// @return reliable if nothing is recorded
runtime::Qos offered_by_player(const std::string& profiles);

}  // namespace goshawk::recording
