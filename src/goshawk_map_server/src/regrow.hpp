#pragma once

#include <vector>

#include "goshawk/core/grid_update.hpp"
#include "goshawk/map_server/voxel_map.hpp"

namespace goshawk::map_server {

/// Which bricks of a grid may differ after some raw voxels changed.
class DirtyBricks {
 public:
  /// @param reach [voxels] no growth goes further
  DirtyBricks(Index3 grid_size, int reach);

  /// @param grows whether the change is one of what grows, or only of what is known
  void mark(Index3 voxel, bool grows);

  /// In the order of their place, so that updates are the same from run to run.
  const std::vector<Index3>& bricks();

 private:
  Index3 size_;
  int reach_;
  BitGrid marked_;
  std::vector<Index3> bricks_;
};

/// @return voxels that the growth reaches at most
int reach_of(const Growth& growth, const GridGeometry& geometry);

/// Grows one brick anew from the raw and known voxels around it.
Brick regrow(const VoxelGrid& grid, const Growth& growth, Index3 brick);

}  // namespace goshawk::map_server
