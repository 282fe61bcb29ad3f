#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "goshawk/path_search/move_cost.hpp"
#include "goshawk/path_search/planner.hpp"

namespace goshawk::path_search {

/// One bit for each of the 27 voxels of a 3x3x3 block, by direction_of() from its centre.
using BlockMask = std::uint32_t;

/// The voxels of a block that a move along no axis but the others can reach, by axis; and how far
/// apart the bits of neighbouring planes are.
inline constexpr std::array<BlockMask, 3> kMiddlePlane = {0x2492492, 0xe07038, 0x3fe00};
inline constexpr std::array<int, 3> kPlaneStride = {1, 3, 9};

/// @return the voxels, as seen from the block's centre, that must be free for the move from `from`
/// to `to` (both inside the block, neighbours of each other)
BlockMask cells_of_move(CornerRule rule, Index3 from, Index3 to);

/// Each mask is a set of voxels. If all voxels of one of them are free, `target` need not be made
/// from the centre x when x was reached by `direction`: some other path from the voxel before x
/// reaches it as well. Sets that contain another one are left out; an empty set means that
/// target is never needed, no set that it always is (a natural neighbour).
///
/// Derived by brute force: with p the voxel before x, every path of up to three moves from p to
/// the target inside the block and around x counts that is shorter than p, x, target, or as long
/// with a last move that comes first in the canonical order (fewer axes, then lower index).
/// docs/search.md proves that this keeps a shortest path to every voxel.
std::vector<BlockMask> bypasses(CornerRule rule, int direction, int target);

/// The successors of a voxel by lookup: one table row for each direction of arrival, one column
/// for each of the nine x rows of the block.
class MoveRules {
 public:
  explicit MoveRules(CornerRule rule);

  /// @param direction of arrival; kNoDirection gives every move that the corner rule allows
  /// @param blocked of the block around the voxel
  /// @return the moves to make, one bit a direction
  BlockMask successors(int direction, BlockMask blocked) const {
    Lanes sum = base_[std::size_t(direction)];
    const auto& rows = table_[std::size_t(direction)];
    for (std::size_t r = 0; r < 9; ++r) sum |= rows[r][(blocked >> (3 * r)) & 7U];
    return sum[1] & sum[2] & sum[3] & ~sum[0];
  }

  /// The same for kNoDirection, without a table: every move that the corner rule allows.
  static BlockMask allowed(CornerRule rule, BlockMask blocked) {
    constexpr BlockMask kAll = (BlockMask{1} << kDirections) - 1;
    constexpr BlockMask kCenter = BlockMask{1} << kNoDirection;
    BlockMask free = ~blocked & kAll;
    if (rule == CornerRule::squeeze) return free & ~kCenter;
    // Axis by axis: a voxel of an outer plane also needs the one before it in the middle plane.
    for (const int axis : {0, 1, 2}) {
      const BlockMask middle = free & kMiddlePlane[std::size_t(axis)];
      const int s = kPlaneStride[std::size_t(axis)];
      free &= middle | middle << s | middle >> s;
    }
    return free & ~kCenter;
  }

  /// Does the ring of eight around the next voxel of a straight move differ from the ring here?
  static bool ring_changes(const Move& move, BlockMask blocked) {
    const auto axis = std::size_t(move.axis);
    const int s = kPlaneStride[axis];
    const BlockMask next = move.sign > 0 ? blocked >> s : blocked << s;
    return ((blocked ^ next) & kMiddlePlane[axis]) != 0;
  }

 private:
  // Four masks of targets: not a valid move; bypass 1, 2, 3 is cut by a blocked voxel. A target
  // is needed where all of its bypasses are cut. One vector register where the machine has them.
  using Lanes [[gnu::vector_size(16)]] = BlockMask;

  void add_move(CornerRule rule, int direction, int target);
  void block(int direction, BlockMask cells, int lane, int target);

  std::array<Lanes, kDirections> base_{};
  std::array<std::array<std::array<Lanes, 8>, 9>, kDirections> table_{};
};

/// Made once for each rule, at first use.
const MoveRules& move_rules(CornerRule rule);

}  // namespace goshawk::path_search
