#pragma once

#include <vector>

#include "goshawk/core/bit_grid.hpp"
#include "goshawk/core/vector.hpp"

namespace goshawk::corridor_builder {

/// Does the closed cube of voxel i hold p [voxel edges]?
bool holds(const Index3& i, const Vec3& p);

/// Follows a segment through free voxels, each of which shares a face with the one before.
class VoxelWalk {
 public:
  /// Appends free voxels that the segment meets to `voxels`, from its last one (from one that holds
  /// p where it is empty) to one that holds q. Where the way stops, the last voxel that was
  /// reached is appended, for a message.
  /// @param p, q [voxel edges] inside the grid
  bool append(const BitGrid& occupied, const Vec3& p, const Vec3& q, std::vector<Index3>& voxels);

 private:
  bool trace(const Vec3& p, const Vec3& q, std::vector<Index3>& voxels);

  std::vector<Index3> cells_;
  std::vector<int> parent_;
  std::vector<int> queue_;
  std::vector<Index3> back_;
};

}  // namespace goshawk::corridor_builder
