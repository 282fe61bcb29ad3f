#pragma once

#include "goshawk/core/result.hpp"
#include "goshawk/map_server/voxel_map.hpp"
#include "octomap_msgs.h"

namespace goshawk::map_server {

/// The map of a message that carries a binary OcTree.
/// @return invalid_input for another kind of tree; as read_binary_payload() and voxelize()
Result<RawVoxels> read_octomap(const octomap_msgs::msg::Octomap& m);

/// Writes a map into a message, whose header stays. @return as binary_payload()
Status fill_octomap(const GridGeometry& geometry, const BitGrid& occupied, const BitGrid& known,
                    octomap_msgs::msg::Octomap& m);

}  // namespace goshawk::map_server
