#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "goshawk/core/grid_geometry.hpp"
#include "goshawk/core/result.hpp"

namespace goshawk {

/// A block of 64 x 8 x 8 voxels: one word of each of 64 rows. Brick (i, j, k) begins at voxel
/// (64 i, 8 j, 8 k); word 8 (z % 8) + y % 8 is the row (y, z). Rows and bits outside the grid
/// are zero and mean nothing.
struct Brick {
  static constexpr int kSizeX = 64;
  static constexpr int kSizeY = 8;
  static constexpr int kSizeZ = 8;
  static constexpr int kWords = kSizeY * kSizeZ;
  using Words = std::array<BitGrid::Word, kWords>;

  Index3 index;
  Words occupied{};
  Words known{};

  friend bool operator==(const Brick&, const Brick&) = default;
};

/// @return bricks along x, y, z that cover a grid of this size
Index3 brick_counts(Index3 grid_size);

/// What changed in a VoxelGrid from one version to another: whole bricks, each at most once.
struct GridUpdate {
  std::uint64_t from_version = 0;
  std::uint64_t to_version = 0;
  std::vector<Brick> bricks;
};

/// Brings the grid from update.from_version to update.to_version. All or nothing.
/// @return invalid_input where the grid has another version (ask for the whole grid), has no
/// known bits, or a brick lies outside it
Status apply(VoxelGrid& grid, const GridUpdate& update);

}  // namespace goshawk
