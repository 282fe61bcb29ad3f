#pragma once

#include <array>

#include "goshawk/core/bit_grid.hpp"

namespace goshawk::map_server {

/// Sets every voxel whose cube holds a part of the triangle, and no other; what lies outside the
/// grid is left out. A triangle in the plane between two layers of voxels goes to the upper one, as
/// a point does. Corners that coincide make a line or a point.
/// @param corners [voxel units, GridGeometry::to_grid] finite
void rasterise(const std::array<Vec3, 3>& corners, BitGrid& occupied);

}  // namespace goshawk::map_server
