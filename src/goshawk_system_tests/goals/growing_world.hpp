#pragma once

#include <cstdint>
#include <memory>

#include "goshawk/core/grid_geometry.hpp"
#include "goshawk/core/random.hpp"
#include "goshawk/worlds/world.hpp"

namespace goshawk::goals {

inline constexpr double kBody_m = 0.15;          // radius of the vehicle's body
inline constexpr double kTrackingMargin_m = 0.05;

/// [m] from a point to the nearest obstacle's cube, looked for within `within_m`; the world's faces
/// are no obstacles. By brute force on raw voxels, without the grown map.
double obstacle_distance_m(const VoxelGrid& map, const Vec3& p_map, double within_m);

/// Obstacles as they are, and the map that stages make of them.
class GrowingWorld {
 public:
  explicit GrowingWorld(const worlds::WorldSpec& spec);

  const std::shared_ptr<const VoxelGrid>& map() const { return map_; }
  /// The next version of the map has this obstacle.
  void add(Index3 voxel);
  /// The middle of a free voxel.
  Vec3 free_place(Random& random) const;

 private:
  void grow();

  GridGeometry geometry_;
  BitGrid raw_;
  std::uint64_t version_ = 0;
  std::shared_ptr<const VoxelGrid> map_;
};

}  // namespace goshawk::goals
