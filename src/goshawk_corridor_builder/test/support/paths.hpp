#pragma once

#include <vector>

#include "goshawk/core/grid_geometry.hpp"

namespace goshawk::corridor_builder::test_support {

/// What the search stage hands over, made plainly: A* over voxel centres, 26 neighbours, no
/// corner is cut, then waypoints are left out wherever the line of sight allows it.
/// @return empty where start and goal are not connected
std::vector<Vec3> pruned_path(const VoxelGrid& grid, Index3 start, Index3 goal);

/// Between two free voxels drawn at random. @return empty where that fails
std::vector<Vec3> random_pruned_path(const VoxelGrid& grid, std::uint64_t seed);

}  // namespace goshawk::corridor_builder::test_support
