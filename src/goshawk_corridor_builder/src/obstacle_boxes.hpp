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

/// The voxels to keep out of: those set in one grid, and those not set in another of the same size
/// (what is not known). Either may be missing.
struct ObstacleVoxels {
  const BitGrid* set = nullptr;
  const BitGrid* known = nullptr;

  bool empty() const { return set == nullptr && known == nullptr; }
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

/// Merges the obstacle voxels of a region into boxes: the longest run along x that holds a voxel is
/// widened along y, then along z, as far as all of it is obstacles. Each of them is in a box, and
/// no free voxel is in any; boxes may overlap, which makes them fewer. Rows are read and compared 64
/// voxels at a time (wider regions are merged in slabs of 64 voxels), and layers that equal the one
/// below cost only their comparison.
class ObstacleMerger {
 public:
  /// Appends to `boxes`, relative to the voxel corner `base`.
  /// @param region inside the grid @param radius of the boxes' sphere [voxel edges]
  void collect(const ObstacleVoxels& voxels, const VoxelBox& region, Index3 base, double radius,
               BoxSet& boxes);

 private:
  using Word = BitGrid::Word;

  void gather(const ObstacleVoxels& voxels, const VoxelBox& slab);
  void merge(const Vec3& offset, double radius, BoxSet& boxes);
  bool layer_holds(Word mask, int y0, int y1, int z) const;
  void clear(Word mask, int y0, int y1, int z0, int z1);
  std::size_t at(int y, int z) const { return std::size_t(z * rows_ + y); }

  int rows_ = 0, layers_ = 0;  // of the slab; layers that differ from the one below
  std::vector<int> heights_;   // where each layer begins, and the last one ends
  std::vector<Word> words_;    // a row each, y faster than z
  std::vector<Word> rest_;     // what is in no box yet
};

}  // namespace goshawk::corridor_builder
