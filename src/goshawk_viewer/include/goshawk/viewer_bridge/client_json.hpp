#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>

#include "goshawk/core/result.hpp"

namespace goshawk::viewer_bridge {

/// What a client published as JSON, with times as ROS 2 names them: Foxglove's panels write
/// {sec, nsec}, as ROS 1 did. @return invalid_input for what is no JSON, or nested without end
Result<nlohmann::ordered_json> client_json(std::span<const unsigned char> bytes);

}  // namespace goshawk::viewer_bridge
