#include "goshawk/path_search/successor_order.hpp"

#include <limits>

namespace goshawk::path_search {
namespace {

// Highest rise of each level but the last, in voxels: moves of the empty grid's shortest paths;
// then those that lose less than a diagonal's saving, and so on. Measured, not derived.
constexpr double kLevelRise[SuccessorOrder::kLevels - 1] = {0.2, 0.8};

int level_of(std::uint32_t rise) {
  int level = 0;
  while (level + 1 < SuccessorOrder::kLevels && double(rise) > kLevelRise[level] * double(kUnit)) {
    ++level;
  }
  return level;
}

}  // namespace

// Differences of up to 5 are enough for every case: each axis by two more than the next, the least
// of them zero or not.
SuccessorOrder::SuccessorOrder() : cases_(kCases) {
  constexpr int kMost = 5;
  for (int z = -kMost; z <= kMost; ++z) {
    for (int y = -kMost; y <= kMost; ++y) {
      for (int x = -kMost; x <= kMost; ++x) {
        Case& c = cases_[index({x, y, z})];
        if (!c.filled) fill(c, {x, y, z});
      }
    }
  }
}

const SuccessorOrder& successor_order() {
  static const SuccessorOrder order;
  return order;
}

void SuccessorOrder::fill(Case& c, Index3 left) {
  c.least.fill(std::numeric_limits<std::uint32_t>::max());
  const Cost estimate = OctileHeuristic{}({}, left);
  for (int d = 0; d < kDirections; ++d) {
    if (d == kNoDirection) continue;
    const auto rise =
        std::uint32_t(kMoves[std::size_t(d)].cost + OctileHeuristic{}(step_of(d), left) - estimate);
    const auto level = std::size_t(level_of(rise));
    c.rise[std::size_t(d)] = rise;
    c.moves[level] |= BlockMask{1} << d;
    c.least[level] = std::min(c.least[level], rise);
  }
  c.filled = true;
}

}  // namespace goshawk::path_search
