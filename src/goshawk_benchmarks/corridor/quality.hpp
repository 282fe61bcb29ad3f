#pragma once

#include "goshawk/core/grid_geometry.hpp"
#include "goshawk/core/polytope.hpp"

namespace goshawk::bench {

/// The volume of a polytope, and how much of it lies in occupied voxels. By lines along x, three
/// a voxel and axis, exact along each.
struct Volume {
  double total_m3 = 0.0;
  double stolen_m3 = 0.0;
};
Volume volume_of(const Polytope& polytope, const VoxelGrid& grid);

/// A polytope's faces that touch it, counted by its corners.
int faces_of(const Polytope& polytope);

}  // namespace goshawk::bench
