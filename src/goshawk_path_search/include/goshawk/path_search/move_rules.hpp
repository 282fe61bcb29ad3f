#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "goshawk/path_search/move_cost.hpp"
#include "goshawk/path_search/planner.hpp"

namespace goshawk::path_search {

/// One bit for each of the 27 voxels of a 3x3x3 block, by direction_of() from its centre.
using BlockMask = std::uint32_t;

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

  /// For each row 3 (dz + 1) + (dy + 1) of the block: bits 0..2 are dx = -1, 0, 1; set = blocked.
  using Rows = std::array<std::uint8_t, 9>;

  /// @param direction of arrival; kNoDirection gives every move that the corner rule allows
  /// @return the moves to make, one bit a direction
  BlockMask successors(int direction, const Rows& blocked) const {
    Lanes sum = base_[std::size_t(direction)];
    const auto& rows = table_[std::size_t(direction)];
    for (std::size_t r = 0; r < 9; ++r) {
      const Lanes& lanes = rows[r][blocked[r]];
      sum.low |= lanes.low;
      sum.high |= lanes.high;
    }
    const auto invalid = BlockMask(sum.low);
    const auto needed = BlockMask(sum.low >> 32) & BlockMask(sum.high) & BlockMask(sum.high >> 32);
    return needed & ~invalid;
  }

 private:
  // Four masks of targets: not a valid move; bypass 1, 2, 3 is cut by a blocked voxel. A target
  // is needed where all of its bypasses are cut.
  struct Lanes {
    std::uint64_t low = 0;
    std::uint64_t high = 0;
    void set(int lane, int target);
  };

  void add_move(CornerRule rule, int direction, int target);
  void block(int direction, BlockMask cells, int lane, int target);

  std::array<Lanes, kDirections> base_{};
  std::array<std::array<std::array<Lanes, 8>, 9>, kDirections> table_{};
};

/// Made once for each rule, at first use.
const MoveRules& move_rules(CornerRule rule);

}  // namespace goshawk::path_search
