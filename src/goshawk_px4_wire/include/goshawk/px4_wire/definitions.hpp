#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "goshawk/px4_wire/layout.hpp"
#include "goshawk/px4_wire/release.hpp"

namespace goshawk::px4 {

/// One of PX4's message types as one release has it.
struct Definition {
  Layout layout;
  int version = 0;  // MESSAGE_VERSION; above 0 its topic ends with _v and this number
};

/// @param type "VehicleOdometry" @return nothing if the release has no such message
std::optional<Definition> find_definition(std::string_view type, Release release);

/// @throws std::logic_error if the release has no such message
Definition definition_of(std::string_view type, Release release);

/// @param topic "out/vehicle_status" @return "fmu/out/vehicle_status_v1", relative to the vehicle's
/// namespace
std::string topic_of(std::string_view topic, const Definition& definition);

/// "px4_msgs::msg::dds_::VehicleStatus_"
std::string wire_type_of(std::string_view type);

/// @return the releases whose message of this type has this hash, so that a mismatch can be named
std::vector<Release> releases_with(std::string_view type, std::uint32_t hash);

}  // namespace goshawk::px4
