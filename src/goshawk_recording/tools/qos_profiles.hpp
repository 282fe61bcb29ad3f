#pragma once

#include <string>
#include <vector>

#include "goshawk/runtime/context.hpp"
#include "goshawk/runtime/qos.hpp"

namespace goshawk::recording {

inline constexpr const char* kQosKey = "offered_qos_profiles";

/// What writers offer, as ROS 2's bags keep it in the channel's metadata: YAML, one entry a writer.
/// History and depth do not travel over DDS; they are "unknown".
std::string to_profiles(const std::vector<runtime::EndpointInfo>& writers);

/// What a player offers so that it serves whoever the recorded writers served: the most that any
/// of them offered. Words and numbers are understood, as different ROS 2 versions write them.
/// @return reliable where nothing is recorded
runtime::Qos offered_by_player(const std::string& profiles);

}  // namespace goshawk::recording
