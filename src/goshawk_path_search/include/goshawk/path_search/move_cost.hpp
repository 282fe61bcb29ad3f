#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdlib>

#include "goshawk/core/vector.hpp"

namespace goshawk::path_search {

/// Path costs as integers, so that sums are exact and equal costs are equal.
///
/// 3041996 / 2151016 and 3725669 / 2151016 approximate sqrt(2) and sqrt(3) at once to 2.9e-11 (the
/// best such pair below 2^23). A path that is shortest in these units is therefore longer than the
/// true shortest by at most 6e-11 of its length, whatever its length is.
using Cost = std::int64_t;
inline constexpr std::array<Cost, 4> kMoveCost = {0, 2151016, 3041996, 3725669};
inline constexpr Cost kUnit = kMoveCost[1];

/// The 26 moves and, in the middle, no move: index = 9 (dz + 1) + 3 (dy + 1) + (dx + 1).
inline constexpr int kDirections = 27;
inline constexpr int kNoDirection = 13;
constexpr int opposite(int direction) {
  return 26 - direction;
}
constexpr int direction_of(Index3 step) {
  return 9 * (step.z + 1) + 3 * (step.y + 1) + step.x + 1;
}
constexpr Index3 step_of(int direction) {
  return {direction % 3 - 1, direction / 3 % 3 - 1, direction / 9 - 1};
}
/// @return 0 to 3: how many coordinates the move changes
constexpr int axes_changed(int direction) {
  const Index3 s = step_of(direction);
  return (s.x != 0) + (s.y != 0) + (s.z != 0);
}

/// All that the search asks of a move, looked up: the formulas above divide.
struct Move {
  Index3 step;
  Cost cost = 0;
  int axis = -1;  // 0, 1, 2 for a straight move
  int sign = 0;   // of a straight move
};
constexpr std::array<Move, kDirections> make_moves() {
  std::array<Move, kDirections> moves{};
  for (int d = 0; d < kDirections; ++d) {
    const Index3 s = step_of(d);
    const int axes = axes_changed(d);
    Move& move = moves[std::size_t(d)];
    move.step = s;
    move.cost = kMoveCost[std::size_t(axes)];
    if (axes != 1) continue;
    move.axis = s.x != 0 ? 0 : s.y != 0 ? 1 : 2;
    move.sign = s.x + s.y + s.z;
  }
  return moves;
}
inline constexpr std::array<Move, kDirections> kMoves = make_moves();

/// Lower bounds on the cost between two voxels, in the units above; each a functor, so that the
/// search is compiled once for each.
struct OctileHeuristic {
  // The exact cost on an empty grid (thesis, Improved Heuristic Function): triagonal moves for the
  // smallest difference, diagonal ones for the middle, straight ones for the rest. Consistent,
  // since each further axis costs less than the one before.
  Cost operator()(Index3 a, Index3 b) const {
    const Cost x = std::abs(a.x - b.x), y = std::abs(a.y - b.y), z = std::abs(a.z - b.z);
    const Cost most = std::max(std::max(x, y), z);
    const Cost least = std::min(std::min(x, y), z);
    const Cost middle = x + y + z - most - least;
    return kMoveCost[1] * most + (kMoveCost[2] - kMoveCost[1]) * middle +
           (kMoveCost[3] - kMoveCost[2]) * least;
  }
};

struct EuclideanHeuristic {
  // Scaled down by more than the move costs' rounding, so that it never overestimates.
  Cost operator()(Index3 a, Index3 b) const {
    const double x = a.x - b.x, y = a.y - b.y, z = a.z - b.z;
    return Cost(std::sqrt(x * x + y * y + z * z) * (double(kUnit) * (1.0 - 1e-9)));
  }
};

struct ManhattanHeuristic {
  // Overestimates wherever a diagonal move is possible: paths may be longer than the shortest.
  Cost operator()(Index3 a, Index3 b) const {
    return kUnit * (Cost{std::abs(a.x - b.x)} + std::abs(a.y - b.y) + std::abs(a.z - b.z));
  }
};

struct ZeroHeuristic {
  Cost operator()(Index3, Index3) const { return 0; }
};

}  // namespace goshawk::path_search
