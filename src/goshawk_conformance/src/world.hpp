#pragma once

#include <limits>
#include <memory>

#include "goshawk/core/grid_geometry.hpp"
#include "goshawk/core/random.hpp"

namespace goshawk::conformance {

inline constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// A small cluttered map with a closed room in one corner.
struct World {
  std::shared_ptr<VoxelGrid> grid;
  Vec3 in_room_map = Vec3::Zero();      // [m] free, but cut off from everything else
  Vec3 in_obstacle_map = Vec3::Zero();  // [m]
  Vec3 outside_map = Vec3::Zero();      // [m]
};

World make_world(std::uint64_t seed);

/// The centre of a free voxel outside the room, with free neighbours all around.
Vec3 free_point(const World& world, Random& random);

}  // namespace goshawk::conformance
