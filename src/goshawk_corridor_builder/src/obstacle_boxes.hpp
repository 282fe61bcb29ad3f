#pragma once

#include <array>
#include <vector>

#include "goshawk/core/bit_grid.hpp"
#include "separating_plane.hpp"

namespace goshawk::corridor_builder {

/// A box of whole voxels, lo <= i < hi.
struct VoxelBox {
  Index3 lo;
  Index3 hi;
};

/// Obstacles whose boxes have whole-numbered corners, one array a coordinate so that a plane is
/// tested against all of them in a few vector instructions. Voxel edges.
struct BoxSet {
  std::array<std::vector<double>, 3> lo;
  std::array<std::vector<double>, 3> hi;
  std::vector<double> radius;

  std::size_t size() const { return radius.size(); }
  void clear() { resize(0); }
  void add(const Vec3& lower, const Vec3& upper, double r = 0.0);
  Vec3 lower(std::size_t i) const { return {lo[0][i], lo[1][i], lo[2][i]}; }
  Vec3 upper(std::size_t i) const { return {hi[0][i], hi[1][i], hi[2][i]}; }
  Obstacle at(std::size_t i) const { return {lower(i), upper(i), radius[i]}; }
  void set(std::size_t i, const Vec3& lower, const Vec3& upper);
  void copy(std::size_t from, std::size_t to);
  void resize(std::size_t n);
};

/// Merges the set voxels of a region into boxes: runs along x, equal runs along y, equal
/// rectangles along z. Every set voxel is in exactly one box, and no clear one is in any. Rows
/// are read 64 voxels at a time; a row or a layer that equals the one before costs only its
/// comparison.
class ObstacleMerger {
 public:
  /// Appends to `boxes`, relative to the voxel corner `base`.
  /// @param region inside the grid @param radius of the boxes' sphere [voxel edges]
  void collect(const BitGrid& occupied, const VoxelBox& region, Index3 base, double radius,
               BoxSet& boxes);

 private:
  struct Run {
    int x0, x1;
    std::size_t rectangle;  // in layer_
  };
  struct Rectangle {
    int x0, x1, y0, y1, z0;
  };

  bool layer_repeats(const BitGrid& occupied, const VoxelBox& region, int z) const;
  void collect_layer(const BitGrid& occupied, const VoxelBox& region, int z);
  void collect_row(const BitGrid::Word* row, const VoxelBox& region, int y, int z);
  void collect_narrow_row(BitGrid::Word word, int x0, int y, int z);
  void add_run(int x0, int x1, int y, int z, std::size_t& before);
  void join_layers(int z, BoxSet& boxes);
  void emit(const Rectangle& r, int z1, BoxSet& boxes) const;

  Vec3 base_ = Vec3::Zero();
  double radius_ = 0.0;
  std::vector<Run> row_;
  std::vector<Run> previous_row_;
  std::vector<Rectangle> layer_;
  std::vector<Rectangle> open_;  // rectangles that still grow along z, in order of (y0, x0)
};

}  // namespace goshawk::corridor_builder
