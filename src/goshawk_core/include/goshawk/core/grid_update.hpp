#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include "goshawk/core/grid_geometry.hpp"
#include "goshawk/core/result.hpp"

namespace goshawk {

/// A block of 64 x 8 x 8 voxels: one word of each of the 64 rows of a BitGrid's chunk. Brick
/// (i, j, k) begins at voxel (64 i, 8 j, 8 k); word 8 (z % 8) + y % 8 is the row (y, z). Rows and
/// bits outside the grid are zero and mean nothing.
struct Brick {
  static constexpr int kSizeX = BitGrid::kWordBits;
  static constexpr int kSizeY = BitGrid::kChunkSide;
  static constexpr int kSizeZ = BitGrid::kChunkSide;
  static constexpr int kWords = kSizeY * kSizeZ;
  using Words = std::array<BitGrid::Word, kWords>;

  Index3 index;
  Words grown{};
  Words known{};
  std::optional<Words> raw;  // only for a grid that has raw voxels

  friend bool operator==(const Brick&, const Brick&) = default;
};

/// @return bricks along x, y, z that cover a grid of this size
Index3 brick_counts(Index3 grid_size);

/// @return the bits of each word of a brick that lie inside a grid of this size
BitGrid::Word bits_inside(Index3 brick, Index3 grid_size);

/// @return the brick at this index of a grid with known bits; raw if the grid has raw voxels
Brick brick_of(const VoxelGrid& grid, Index3 index);

/// What changed in a VoxelGrid from one version to another.
struct GridUpdate {
  std::uint64_t from_version = 0;
  std::uint64_t to_version = 0;
  /// How far the window moves, in bricks: its lower corner goes to voxel (64, 8, 8) * shift of the
  /// grid before. What comes in is unknown: blocked if the grid counts unknown space as occupied.
  Index3 shift;
  std::vector<Brick> bricks;  // whole, each at most once, counted in the window that was moved
};

/// Brings the grid from update.from_version to update.to_version. All or nothing; only chunks that
/// change are cloned, so versions that others hold stay as they are.
/// @return invalid_input if the grid has another version (ask for the whole grid), has no known
/// bits, or has raw voxels and a brick brings none; if a brick lies outside, or the shift takes
/// the window out of what numbers hold
Status apply(VoxelGrid& grid, const GridUpdate& update);

}  // namespace goshawk
