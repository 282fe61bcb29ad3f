#pragma once

#include <cstdint>
#include <memory>

#include "goshawk/closed_loop/obstacle_distance.hpp"
#include "goshawk/core/grid_geometry.hpp"
#include "goshawk/core/random.hpp"
#include "goshawk/worlds/world.hpp"

namespace goshawk::goals {

using closed_loop::kBody_m;
using closed_loop::kTrackingMargin_m;
using closed_loop::obstacle_distance_m;

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
