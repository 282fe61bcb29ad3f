#pragma once

#include <optional>
#include <span>
#include <vector>

#include "chain.hpp"
#include "goshawk/core/grid_geometry.hpp"
#include "goshawk/corridor_builder/config.hpp"
#include "obstacle_boxes.hpp"
#include "separating_plane.hpp"
#include "voxel_walk.hpp"

namespace goshawk::corridor_builder {

/// The generator `box`: axis-aligned boxes of free voxels along the path. A box begins as two
/// neighbouring voxels of the path, takes in as much of the path as a free box can, then grows
/// layer by layer in all six directions; the next one begins at the last voxel of the path in it,
/// so that two consecutive boxes share a whole voxel.
class BoxExpansion {
 public:
  explicit BoxExpansion(const Config& config) : config_(config) {}

  /// @param chain overwritten @return nothing, or if the path has no free voxels to go through
  std::optional<Blockage> build(const VoxelGrid& grid, std::span<const PathPoint> path,
                                const Margins& margins, Chain& chain);

 private:
  VoxelBox grow(const VoxelGrid& grid, std::size_t begin, std::size_t& end) const;

  Config config_;
  std::vector<Index3> voxels_;  // of the path, each shares a face with the next
  VoxelWalk walk_;
  std::vector<Plane> planes_;
};

}  // namespace goshawk::corridor_builder
