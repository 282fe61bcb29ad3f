#include "goshawk/path_search/move_rules.hpp"

#include <algorithm>
#include <bit>
#include <stdexcept>

namespace goshawk::path_search {
namespace {

constexpr int kBypassLanes = 3;

constexpr BlockMask bit(int direction) {
  return BlockMask{1} << direction;
}

bool inside_block(Index3 c) {
  return std::abs(c.x) <= 1 && std::abs(c.y) <= 1 && std::abs(c.z) <= 1;
}

Cost cost_of(int direction) {
  return kMoveCost[std::size_t(axes_changed(direction))];
}

// Walks every path from p to the target around the centre and collects what it needs to be free.
class BypassFinder {
 public:
  BypassFinder(CornerRule rule, int direction, int target)
      : rule_(rule), target_(target), budget_(cost_of(direction) + cost_of(target)) {
    const Index3 center{};
    const Index3 before = center - step_of(direction);
    known_free_ = bit(direction_of(before)) | bit(kNoDirection) |
                  cells_of_move(rule, before, center) |
                  cells_of_move(rule, center, step_of(target));
    walk(before, 0, 0, bit(direction_of(before)) | bit(kNoDirection), 0);
  }

  std::vector<BlockMask> minimal() {
    std::vector<BlockMask> kept;
    const auto fewer = [](BlockMask a, BlockMask b) {
      const int na = std::popcount(a), nb = std::popcount(b);
      return na != nb ? na < nb : a < b;
    };
    std::sort(found_.begin(), found_.end(), fewer);
    for (const BlockMask cells : found_) {
      const auto contained = [cells](BlockMask k) { return (k & cells) == k; };
      if (std::none_of(kept.begin(), kept.end(), contained)) kept.push_back(cells);
    }
    return kept;
  }

 private:
  void walk(Index3 at, int moves, Cost cost, BlockMask visited, BlockMask needed) {
    for (int d = 0; d < kDirections; ++d) {
      const Index3 next = at + step_of(d);
      if (d == kNoDirection || !inside_block(next)) continue;
      const int cell = direction_of(next);
      const Cost total = cost + cost_of(d);
      if ((visited & bit(cell)) != 0 || total > budget_) continue;
      const BlockMask cells = needed | cells_of_move(rule_, at, next);
      if (cell == target_) {
        if (total < budget_ || comes_first(d)) found_.push_back(cells & ~known_free_);
      } else if (moves < 2) {
        walk(next, moves + 1, total, visited | bit(cell), cells);
      }
    }
  }

  // Is the last move d before x -> target in the canonical order?
  bool comes_first(int d) const {
    const int axes = axes_changed(d), axes_target = axes_changed(target_);
    return axes != axes_target ? axes < axes_target : d < target_;
  }

  CornerRule rule_;
  int target_;
  Cost budget_;
  BlockMask known_free_ = 0;
  std::vector<BlockMask> found_;
};

}  // namespace

BlockMask cells_of_move(CornerRule rule, Index3 from, Index3 to) {
  if (rule == CornerRule::squeeze) return bit(direction_of(to));
  BlockMask cells = 0;
  for (int z = std::min(from.z, to.z); z <= std::max(from.z, to.z); ++z) {
    for (int y = std::min(from.y, to.y); y <= std::max(from.y, to.y); ++y) {
      for (int x = std::min(from.x, to.x); x <= std::max(from.x, to.x); ++x) {
        cells |= bit(direction_of({x, y, z}));
      }
    }
  }
  return cells;
}

std::vector<BlockMask> bypasses(CornerRule rule, int direction, int target) {
  if (direction == kNoDirection) return {};
  if (target == opposite(direction)) return {0};  // back to where it came from
  return BypassFinder(rule, direction, target).minimal();
}

MoveRules::MoveRules(CornerRule rule) {
  for (int d = 0; d < kDirections; ++d) {
    for (int target = 0; target < kDirections; ++target) {
      if (target != kNoDirection) add_move(rule, d, target);
    }
  }
}

void MoveRules::add_move(CornerRule rule, int direction, int target) {
  block(direction, cells_of_move(rule, Index3{}, step_of(target)), 0, target);
  const auto ways = bypasses(rule, direction, target);
  if (ways.size() > kBypassLanes) throw std::logic_error("a move has more bypasses than lanes");
  if (ways.size() == 1 && ways[0] == 0) return;  // never needed
  for (int lane = 0; lane < kBypassLanes; ++lane) {
    if (std::size_t(lane) < ways.size()) {
      block(direction, ways[std::size_t(lane)], lane + 1, target);
    } else {
      base_[std::size_t(direction)][lane + 1] |= bit(target);
    }
  }
}

// Every row pattern in which one of the cells is blocked sets the target's bit in the lane.
void MoveRules::block(int direction, BlockMask cells, int lane, int target) {
  for (int row = 0; row < 9; ++row) {
    const BlockMask in_row = (cells >> (3 * row)) & 7U;
    for (BlockMask pattern = 0; pattern < 8; ++pattern) {
      if ((pattern & in_row) == 0) continue;
      table_[std::size_t(direction)][std::size_t(row)][pattern][lane] |= bit(target);
    }
  }
}

const MoveRules& move_rules(CornerRule rule) {
  static const MoveRules no_squeeze(CornerRule::no_squeeze);
  static const MoveRules squeeze(CornerRule::squeeze);
  return rule == CornerRule::squeeze ? squeeze : no_squeeze;
}

}  // namespace goshawk::path_search
