#pragma once

#include "goshawk/core/grid_geometry.hpp"
#include "goshawk/core/polytope.hpp"

namespace goshawk::corridor_builder::baseline {

/// Where planes go: through the nearest voxel's centre, as published, or so far back that the whole
/// cube is kept out, at the risk of losing the segment.
enum class Planes { through_centres, before_cubes };

/// The thesis' method as it is usually built (Liu et al., Planning Dynamically Feasible
/// Trajectories for Quadrotors Using Safe Flight Corridors, RA-L 2017): obstacles are the centres
/// of occupied voxels within the local box, one pass. A plain implementation of our own, to
/// compare with; its planes go through voxel centres and so cut into voxels.
/// @param p_map, q_map [m] ends of the segment @param local_box_m [m] as in Config
Polytope decompose(const VoxelGrid& grid, const Vec3& p_map, const Vec3& q_map, double local_box_m,
                   Planes planes);

}  // namespace goshawk::corridor_builder::baseline
