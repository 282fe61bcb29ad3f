#pragma once

#include <cstdint>
#include <memory>

#include "goshawk/core/grid_geometry.hpp"
#include "goshawk/core/random.hpp"

namespace goshawk::goals {

inline constexpr double kBody_m = 0.15;          // radius of the vehicle's body
inline constexpr double kTrackingMargin_m = 0.05;

/// Obstacles as they are, and the map that stages make of them.
class GrowingWorld {
 public:
  /// Boxes and pillars. @param density share of the grown map that is blocked
  GrowingWorld(const Vec3& size_m, double density, std::uint64_t seed);

  const std::shared_ptr<const VoxelGrid>& map() const { return map_; }
  /// The next version of the map has this obstacle.
  void add(Index3 voxel);
  /// [m] from a point to the nearest obstacle's cube, looked for within `within_m`; the world's
  /// faces are no obstacles. By brute force, without the grown map.
  double distance_m(const Vec3& p_map, double within_m) const;
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
