#pragma once

#include "goshawk/core/grid_geometry.hpp"

namespace goshawk::closed_loop {

inline constexpr double kBody_m = 0.15;  // radius of the vehicle's body
inline constexpr double kTrackingMargin_m = 0.05;

/// [m] from a point to the nearest obstacle's cube, looked for within `within_m`; the world's faces
/// are no obstacles. By brute force on raw voxels, without the grown map.
double obstacle_distance_m(const VoxelGrid& map, const Vec3& p_map, double within_m);

}  // namespace goshawk::closed_loop
