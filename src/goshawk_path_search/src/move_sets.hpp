#pragma once

#include <bit>

#include "goshawk/path_search/move_rules.hpp"

/// Sets of moves, one bit a direction.
namespace goshawk::path_search::best_first {

// By direction_of().
inline constexpr BlockMask kStraightMoves = 0x415410;
inline constexpr BlockMask kDiagonalMoves = 0x2aa8aaa;

// The queue hands out the newest of equals, so the moves that the canonical order wants first,
// those along most axes, are made last.
inline int next_in_order(BlockMask moves) {
  const BlockMask straight = moves & kStraightMoves, diagonal = moves & kDiagonalMoves;
  return std::countr_zero(straight != 0 ? straight : diagonal != 0 ? diagonal : moves);
}

inline bool at_most(int count, BlockMask moves) {
  for (int k = 0; k < count; ++k) moves &= moves - 1;
  return moves == 0;
}

}  // namespace goshawk::path_search::best_first
