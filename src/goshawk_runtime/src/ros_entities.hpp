#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace goshawk::runtime {

/// What ROS 2 names a participant, a reader or a writer by: its GUID in wire order.
using Gid = std::array<unsigned char, 16>;

/// [byte] of a gid on the wire: Humble's end with eight zeros.
enum class GidLength : std::size_t { humble = 24, iron = 16 };

struct RosNode {
  std::string full_name;  // begins with '/'
  std::vector<Gid> readers{};
  std::vector<Gid> writers{};
};

/// The state of one participant, as ros_discovery_info tells it (idl/rmw_dds_common.idl).
struct RosEntities {
  Gid participant{};
  std::vector<RosNode> nodes{};
};

/// @return XCDR1, little endian, with its encapsulation
std::vector<unsigned char> encode(const RosEntities& entities, GidLength length);

/// The participant and its nodes' full names, of a message with gids of either length.
struct RosNodeNames {
  Gid participant{};
  std::vector<std::string> names{};
};

/// @param payload with its encapsulation, of either byte order
/// @return nothing if it is not such a message, or holds a name that is none in ROS
std::optional<RosNodeNames> decode_node_names(std::span<const unsigned char> payload);

}  // namespace goshawk::runtime
