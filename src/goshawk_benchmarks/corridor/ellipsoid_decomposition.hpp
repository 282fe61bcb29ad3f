#pragma once

#include "goshawk/core/grid_geometry.hpp"
#include "goshawk/core/polytope.hpp"

namespace goshawk::bench {

/// Where planes go: through the nearest voxel's centre, as published, or so far back that the whole
/// cube is kept out, at the risk of losing the segment.
enum class Planes { through_centres, before_cubes };

/// The baseline: the thesis' method as it is usually built (Liu et al., Planning Dynamically
/// Feasible Trajectories for Quadrotors Using Safe Flight Corridors, RA-L 2017). Obstacles are the
/// centres of occupied voxels within the local box, one pass. A plain implementation of our own;
/// points that cannot matter any more are left out as soon as that is known, and distances are
/// computed once.
/// @param p_map, q_map [m] ends of the segment @param local_box_m [m] as in corridor_builder
Polytope decompose(const VoxelGrid& grid, const Vec3& p_map, const Vec3& q_map, double local_box_m,
                   Planes planes);

}  // namespace goshawk::bench
