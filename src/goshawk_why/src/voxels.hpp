#pragma once

#include <optional>

#include "goshawk/why/why.hpp"

namespace goshawk::why {

/// The obstacle that blocks a place for the vehicle's centre: the nearest measured voxel within the
/// inflation or, without measured obstacles in the map, the place's own; if there is none, the
/// nearest unknown voxel that was inflated like one.
/// @return nothing if the place is free or outside of the map
std::optional<BlockingVoxel> blocking_voxel(const VoxelGrid& grid, const Vec3& place_map);

/// A voxel that a curve would enter, seen from a place on that curve.
BlockingVoxel voxel_at(const VoxelGrid& grid, Index3 index, const Vec3& from_map);

/// "the obstacle at (1.500, 2.100, 1.100) (voxel (7, 10, 5))"
std::string to_text(const BlockingVoxel& voxel);

}  // namespace goshawk::why
