#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <vector>

#include "goshawk/path_search/move_cost.hpp"
#include "goshawk/path_search/move_rules.hpp"

namespace goshawk::path_search {

/// By how much each of the 26 moves raises g + octile estimate, looked up, for one goal. A search
/// makes the successors that raise it least first and comes back for the others only if it gets
/// that far (partial expansion: Goldenberg et al., "Enhanced Partial Expansion A*", JAIR 2014).
/// Most of them are never made.
///
/// The rise depends on the signs of the differences to the goal, on which differ by less than two,
/// and on which are zero: 2,000 cases, of which about 500 can occur.
class SuccessorOrder {
 public:
  static constexpr int kLevels = 3;

  struct Case {
    std::array<std::uint32_t, kDirections> rise{};  // of g + estimate, by direction
    std::array<BlockMask, kLevels> moves{};         // the moves of each level
    std::array<std::uint32_t, kLevels> least{};     // the smallest rise of each level
    bool filled = false;
  };

  SuccessorOrder();

  /// @param left goal - voxel
  const Case& of(Index3 left) const { return cases_[index(left)]; }

 private:
  static constexpr std::size_t kCases = 125 * 2 * 8;

  static std::size_t index(Index3 left) {
    const int x = std::abs(left.x), y = std::abs(left.y), z = std::abs(left.z);
    const auto apart = [](int a, int b) { return unsigned(std::clamp(a - b, -2, 2) + 2); };
    const unsigned order = (apart(x, y) * 5 + apart(y, z)) * 5 + apart(x, z);
    const unsigned flat = std::min({x, y, z}) == 0;
    const unsigned signs =
        unsigned(left.x < 0) | unsigned(left.y < 0) << 1 | unsigned(left.z < 0) << 2;
    return (order * 2 + flat) * 8 + signs;
  }
  static void fill(Case& c, Index3 left);

  std::vector<Case> cases_;
};

/// Made once, at first use.
const SuccessorOrder& successor_order();

}  // namespace goshawk::path_search
