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

/// The bracket above for every voxel, one byte a voxel and a table.
class CostField {
 public:
  static constexpr int kMaxReach = 100;

  explicit CostField(const Weights& weights);

  /// Keeps copies of the grids, which share their chunks. Of a map of the same size as before only
  /// the surroundings of chunks that differ are measured again.
  /// @param known of the same size: voxels that are not set in it are costly; null: none is
  void assign(const BitGrid& blocked, const BitGrid* known);

  /// @pre inside the grid
  double factor(Index3 i) const { return table_[classes_[flat(i)]]; }

 private:
  std::size_t flat(Index3 i) const {
    return (std::size_t(i.z) * std::size_t(size_.y) + std::size_t(i.y)) * std::size_t(size_.x) +
           std::size_t(i.x);
  }
  /// lo <= i < hi
  struct Box {
    Index3 lo, hi;
  };

  Box widened(const Box& box) const;
  Box changed_within(const BitGrid& blocked, BitGrid::Rows rows) const;
  void measure(const BitGrid& blocked, const Box& box);
  void write(const BitGrid& level, Index3 corner, const Box& box, int steps);
  void mark_costly(const BitGrid& known, BitGrid::Rows rows);

  Weights weights_;
  Index3 size_;
  BitGrid blocked_, known_;            // what the classes say; known_ is empty if all is known
  std::array<double, 256> table_{};    // by class
  std::vector<std::uint8_t> classes_;  // steps to the nearest blocked voxel, | 128 where costly
};

}  // namespace goshawk::path_search
