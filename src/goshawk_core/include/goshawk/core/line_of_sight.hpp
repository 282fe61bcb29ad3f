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
/// @param a, b [voxel units, GridGeometry::to_grid]; a segment that is not finite is not free
bool line_is_free(const BitGrid& blocked, const Vec3& a, const Vec3& b);

/// The same in map coordinates. @param a_map, b_map [m]
bool line_is_free(const VoxelGrid& grid, const Vec3& a_map, const Vec3& b_map);

/// Every voxel that line_is_free looks at, each once, slab by slab from a to b along the segment's
/// longest axis; for drawing and tests. May contain indices outside any grid.
/// @pre coordinates below 2^30 (else throws)
std::vector<Index3> supercover(const Vec3& a, const Vec3& b);
/// The same into memory that is reused: `cells` is overwritten.
void supercover(const Vec3& a, const Vec3& b, std::vector<Index3>& cells);

}  // namespace goshawk
