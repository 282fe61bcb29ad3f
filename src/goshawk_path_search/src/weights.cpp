#include "goshawk/path_search/weights.hpp"

#include <algorithm>
#include <bit>

#include "goshawk/core/inflation.hpp"

namespace goshawk::path_search {
namespace {

constexpr std::uint8_t kCostly = 128;

}  // namespace

CostField::CostField(const Weights& weights) : weights_(weights) {
  const int reach = weights.near_obstacles() ? weights.reach_voxels : 0;
  // Blocks as wide as what has to be looked at around them.
  while (1 << shift_ < 2 * reach) ++shift_;
  for (int k = 0; k < kCostly; ++k) {
    const double nearness = k >= 1 && k <= reach ? 1.0 - double(k - 1) / double(reach) : 0.0;
    table_[std::size_t(k)] = 1.0 + weights.clearance * nearness;
    table_[std::size_t(k + kCostly)] = table_[std::size_t(k)] + weights.unknown;
  }
}

void CostField::assign(const BitGrid& blocked, const BitGrid* known) {
  if (weights_.unknown == 0.0) known = nullptr;
  if (!(blocked.size() == size_) || known_.empty() != (known == nullptr)) {
    size_ = blocked.size();
    classes_.assign(std::size_t(blocked.voxels()), 0);
    blocked_ = BitGrid();
    blocks_ = {((size_.x - 1) >> 6) + 1, ((size_.y - 1) >> shift_) + 1,
               ((size_.z - 1) >> shift_) + 1};
    stale_.assign(std::size_t(blocks_.x) * std::size_t(blocks_.y) * std::size_t(blocks_.z),
                  weights_.near_obstacles() ? 1 : 0);
    known_ = known == nullptr ? BitGrid() : BitGrid(size_, false, true);
  }
  if (weights_.near_obstacles()) {
    if (!blocked_.empty()) {
      for_changed_chunks(blocked_, blocked,
                         [&](BitGrid::Rows rows) { mark_changes(blocked, rows); });
    }
    blocked_ = blocked;
  }
  if (known == nullptr) return;
  for_changed_chunks(known_, *known, [&](BitGrid::Rows rows) { mark_costly(*known, rows); });
  known_ = *known;
}

CostField::Box CostField::widened(const Box& box) const {
  const int by = weights_.reach_voxels;
  return {{std::max(0, box.lo.x - by), std::max(0, box.lo.y - by), std::max(0, box.lo.z - by)},
          {std::min(size_.x, box.hi.x + by), std::min(size_.y, box.hi.y + by),
           std::min(size_.z, box.hi.z + by)}};
}

// The blocks within reach of the voxels that differ, word by word along x.
void CostField::mark_changes(const BitGrid& blocked, BitGrid::Rows rows) {
  for (int w = 0; w < int(blocked.words_per_row()); ++w) {
    BitGrid::Word differ = 0;
    Index3 lo{0, rows.y1, rows.z1}, hi{0, rows.y0, rows.z0};
    for (int z = rows.z0; z < rows.z1; ++z) {
      for (int y = rows.y0; y < rows.y1; ++y) {
        const BitGrid::Word bits = blocked_.row(y, z)[w] ^ blocked.row(y, z)[w];
        if (bits == 0) continue;
        differ |= bits;
        lo = {0, std::min(lo.y, y), std::min(lo.z, z)};
        hi = {0, std::max(hi.y, y), std::max(hi.z, z)};
      }
    }
    if (differ == 0) continue;
    lo.x = 64 * w + std::countr_zero(differ);
    hi.x = std::min(size_.x - 1, 64 * w + 63 - std::countl_zero(differ));
    const Box near = widened({lo, hi + Index3{1, 1, 1}});
    for (int z = near.lo.z >> shift_; z <= (near.hi.z - 1) >> shift_; ++z) {
      for (int y = near.lo.y >> shift_; y <= (near.hi.y - 1) >> shift_; ++y) {
        for (int x = near.lo.x >> 6; x <= (near.hi.x - 1) >> 6; ++x) {
          stale_[block_of({64 * x, y << shift_, z << shift_})] = 1;
        }
      }
    }
  }
}

void CostField::measure_block(Index3 voxel) {
  const int side = 1 << shift_;
  const Index3 lo{voxel.x & ~63, voxel.y & -side, voxel.z & -side};
  measure({lo,
           {std::min(size_.x, lo.x + 64), std::min(size_.y, lo.y + side),
            std::min(size_.z, lo.z + side)}});
  stale_[block_of(voxel)] = 0;
}

// The chessboard distance: what is blocked grows by one voxel at a time. What lies farther from the
// box than the reach does not matter, and the window's outside is nobody's obstacle; the map's is.
void CostField::measure(const Box& box) {
  const Box window = widened(box);
  const Index3 corner{window.lo.x & ~63, window.lo.y, window.lo.z};
  BitGrid level(window.hi - corner, false);
  for (int z = corner.z; z < window.hi.z; ++z) {
    for (int y = corner.y; y < window.hi.y; ++y) {
      const auto* from = blocked_.row(y, z) + corner.x / 64;
      auto* to = level.mutable_row(y - corner.y, z - corner.z);
      std::copy_n(from, level.words_per_row(), to);
      const int used = level.size().x % 64;
      if (used != 0) to[level.words_per_row() - 1] &= ~(~BitGrid::Word{0} << used);
    }
  }
  const int reach = weights_.reach_voxels;
  for (int z = box.lo.z; z < box.hi.z; ++z) {
    for (int y = box.lo.y; y < box.hi.y; ++y) {
      for (int x = box.lo.x; x < box.hi.x; ++x) {
        const int to_edge =
            1 + std::min({x, y, z, size_.x - 1 - x, size_.y - 1 - y, size_.z - 1 - z});
        std::uint8_t& held = classes_[flat({x, y, z})];
        held = std::uint8_t((held & kCostly) | std::min(to_edge, reach + 1));
      }
    }
  }
  write(level, corner, box, 0);
  for (int steps = 1; steps <= reach; ++steps) {
    level = inflate(level, 0.5, 1.0).value();
    write(level, corner, box, steps);
  }
}

// Voxels of a level that no lower one had are that many steps from what is blocked.
void CostField::write(const BitGrid& level, Index3 corner, const Box& box, int steps) {
  for (int z = box.lo.z; z < box.hi.z; ++z) {
    for (int y = box.lo.y; y < box.hi.y; ++y) {
      std::uint8_t* row = classes_.data() + flat({0, y, z});
      const auto* words = level.row(y - corner.y, z - corner.z);
      for (int w = (box.lo.x - corner.x) / 64; corner.x + 64 * w < box.hi.x; ++w) {
        for (BitGrid::Word bits = words[w]; bits != 0; bits &= bits - 1) {
          const int x = corner.x + 64 * w + std::countr_zero(bits);
          if (x < box.lo.x || x >= box.hi.x || (row[x] & ~kCostly) <= steps) continue;
          row[x] = std::uint8_t((row[x] & kCostly) | steps);
        }
      }
    }
  }
}

void CostField::mark_costly(const BitGrid& known, BitGrid::Rows rows) {
  for (int z = rows.z0; z < rows.z1; ++z) {
    for (int y = rows.y0; y < rows.y1; ++y) {
      std::uint8_t* row = classes_.data() + flat({0, y, z});
      for (int w = 0; w < int(known.words_per_row()); ++w) {
        BitGrid::Word changed = known_.row(y, z)[w] ^ known.row(y, z)[w];
        for (; changed != 0; changed &= changed - 1) {
          const int x = 64 * w + std::countr_zero(changed);
          if (x < size_.x) row[x] ^= kCostly;  // padding bits follow the grid's outside
        }
      }
    }
  }
}

}  // namespace goshawk::path_search
