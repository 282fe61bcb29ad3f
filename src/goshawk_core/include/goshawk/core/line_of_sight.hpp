#pragma once

#include <vector>

#include "goshawk/core/grid_geometry.hpp"

namespace goshawk {

/// Is every voxel free whose CLOSED cube the closed segment meets (a supercover: a segment that
/// only touches an occupied face, edge or corner is blocked)? What is outside counts as
/// blocked().outside().
///
/// The test is conservative against rounding: a voxel counts as met when the segment comes within
/// 1e-9 voxel edges of it.
/// @param a, b [voxel units, GridGeometry::to_grid] finite
bool line_is_free(const BitGrid& blocked, const Vec3& a, const Vec3& b);

/// The same in map coordinates. @param a_map, b_map [m]
bool line_is_free(const VoxelGrid& grid, const Vec3& a_map, const Vec3& b_map);

/// Every voxel that line_is_free looks at, in order along the segment; for drawing and tests.
/// May contain indices outside any grid.
std::vector<Index3> supercover(const Vec3& a, const Vec3& b);

}  // namespace goshawk
