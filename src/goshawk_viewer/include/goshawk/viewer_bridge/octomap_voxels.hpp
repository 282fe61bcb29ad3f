#pragma once

#include <cstdint>
#include <span>

#include "goshawk/core/grid_geometry.hpp"

namespace goshawk::viewer_bridge {

/// The occupied voxels of an octomap_msgs/Octomap without log-odds: two bits a child, depth first,
/// as OctoMap writes it. Unknown voxels are free here: only what was seen is drawn.
/// @param data the message's data @param resolution_m [m]
/// @return invalid_input where the data are cut off or no tree, map_empty for an empty tree,
/// map_too_large beyond 3e8 voxels
Result<VoxelGrid> octomap_voxels(std::span<const std::uint8_t> data, double resolution_m);

}  // namespace goshawk::viewer_bridge
