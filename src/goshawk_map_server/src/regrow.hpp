#pragma once

#include <vector>

#include "goshawk/core/grid_update.hpp"
#include "goshawk/map_server/voxel_map.hpp"

namespace goshawk::map_server {

/// Which bricks of the grown grid may differ after some raw voxels changed.
class DirtyBricks {
 public:
  /// @param reach [voxels] no growth goes further
  DirtyBricks(Index3 grid_size, int reach);

  /// @param grows whether the change is one of what grows, or only of what is known
  void mark(Index3 voxel, bool grows);
  /// The voxel became known: its brick changed, whatever the growth makes of it.
  void mark_known(Index3 voxel) { became_known_.set(brick_at(voxel), true); }
  bool became_known(Index3 brick) const { return became_known_.get(brick); }

  /// In the order of their place, so that updates are the same from run to run.
  const std::vector<Index3>& bricks();

 private:
  static Index3 brick_at(Index3 voxel) {
    return {voxel.x / Brick::kSizeX, voxel.y / Brick::kSizeY, voxel.z / Brick::kSizeZ};
  }

  Index3 size_;
  Index3 counts_;
  int reach_;
  BitGrid marked_;
  BitGrid became_known_;
  std::vector<Index3> bricks_;
};

/// @return voxels that the growth reaches at most
int reach_of(const Growth& growth, const GridGeometry& geometry);

/// Grows one brick anew from the raw voxels around it.
Brick regrow(const RawView& raw, const Growth& growth, Index3 brick);

/// @return the same brick as it stands in the grid; bits outside the grid are zero
Brick brick_of(const VoxelGrid& grid, Index3 brick);

}  // namespace goshawk::map_server
