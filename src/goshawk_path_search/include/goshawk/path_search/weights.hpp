#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "goshawk/core/bit_grid.hpp"

namespace goshawk::path_search {

/// What a path costs beside its length. A move of length s into voxel v that climbs by h costs
///
///     s * (1 + unknown [v is costly] + clearance * max(0, 1 - (k - 1) / reach)) + climb * h
///
/// with k the steps of 26-neighbour moves from v to the nearest blocked voxel (what is outside
/// counts), reach in voxels, h >= 0. All weights >= 0; all zero is the plain length.
struct Weights {
  double climb = 0.0;
  double unknown = 0.0;
  double clearance = 0.0;
  int reach_voxels = 0;

  bool plain() const { return climb == 0.0 && unknown == 0.0 && !near_obstacles(); }
  bool near_obstacles() const { return clearance > 0.0 && reach_voxels > 0; }
};

/// The bracket above for every voxel, one byte a voxel and a table. Blocks of
/// the map are measured when a search first asks for one of their voxels, and again after a change
/// near them.
class CostField {
 public:
  static constexpr int kMaxReach = 100;

  explicit CostField(const Weights& weights);

  /// Keeps copies of the grids, which share their chunks. Of a map of the same size as before only
  /// chunks that differ are looked at.
  /// @param known of the same size: voxels that are not set in it are costly; null: none is
  void assign(const BitGrid& blocked, const BitGrid* known);

  /// @pre inside the grid
  double factor(Index3 i) {
    if (stale_[block_of(i)]) measure_block(i);
    return table_[classes_[flat(i)]];
  }

 private:
  std::size_t flat(Index3 i) const {
    return (std::size_t(i.z) * std::size_t(size_.y) + std::size_t(i.y)) * std::size_t(size_.x) +
           std::size_t(i.x);
  }
  std::size_t block_of(Index3 i) const {
    return (std::size_t(i.z >> shift_) * std::size_t(blocks_.y) + std::size_t(i.y >> shift_)) *
               std::size_t(blocks_.x) +
           std::size_t(i.x >> 6);
  }
  /// lo <= i < hi
  struct Box {
    Index3 lo, hi;
  };

  Box widened(const Box& box) const;
  void mark_changes(const BitGrid& blocked, BitGrid::Rows rows);
  [[gnu::noinline]] void measure_block(Index3 voxel);
  void measure(const Box& box);
  void write(const BitGrid& level, Index3 corner, const Box& box, int steps);
  void mark_costly(const BitGrid& known, BitGrid::Rows rows);

  Weights weights_;
  Index3 size_;
  int shift_ = 3;                      // a block is 64 voxels along x, 2^shift along y and z
  Index3 blocks_;                      // how many
  std::vector<std::uint8_t> stale_;    // by block: the distances in it are to be measured
  BitGrid blocked_, known_;            // what the classes say; known_ is empty if all is known
  std::array<double, 256> table_{};    // by class
  std::vector<std::uint8_t> classes_;  // steps to the nearest blocked voxel, | 128 where costly
};

}  // namespace goshawk::path_search
