#pragma once

#include <memory>
#include <vector>

#include "goshawk/core/grid_geometry.hpp"
#include "goshawk/worlds/world.hpp"

namespace goshawk::goals {

/// A world, and the map of what has been seen of it: rays from the vehicle make known what they
/// cross, up to the obstacle that they meet. The map leaves the rest free for planning.
class UnfoldingWorld {
 public:
  /// @param range_m of the rays
  UnfoldingWorld(const worlds::World& world, double range_m);

  /// The world as it is: all known.
  const std::shared_ptr<const VoxelGrid>& truth() const { return truth_; }
  const std::shared_ptr<const VoxelGrid>& map() const { return map_; }

  /// A scan from there. @return whether the map has changed: then it is the next version
  bool see_from(const Vec3& p_map);

  /// The world has this obstacle from now on; it is seen only when a ray meets it.
  void add(const std::vector<Index3>& voxels);

 private:
  void cast(const Vec3& from_grid, const Vec3& direction);
  std::shared_ptr<const VoxelGrid> grid_of(const BitGrid& raw, const BitGrid& known) const;

  GridGeometry geometry_;
  double range_voxels_;
  BitGrid occupied_;
  BitGrid seen_;  // measured, free or not
  BitGrid met_;   // obstacles that were measured
  bool changed_ = false;
  std::uint64_t version_ = 0;
  std::vector<Vec3> directions_;
  std::shared_ptr<const VoxelGrid> truth_, map_;
};

/// Was the whole body, with its margin, seen to be free around a point? By brute force over the
/// voxels near it.
bool body_was_seen_free(const VoxelGrid& map, const Vec3& p_map);

}  // namespace goshawk::goals
