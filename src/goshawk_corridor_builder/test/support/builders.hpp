#pragma once

#include "goshawk/corridor_builder/corridor_builder.hpp"
#include "worlds.hpp"

namespace goshawk::corridor_builder::test_support {

inline CorridorBuilder builder_of(const Config& config) {
  return std::move(CorridorBuilder::create(config)).value();
}

/// 4 x 2 x 2 m; x from 2.0 to 2.2 is blocked for all of y, below z = 1.
inline VoxelGrid world_with_wall() {
  VoxelGrid grid = empty_world({20, 10, 10}, 0.2);
  fill(grid, {10, 0, 0}, {11, 10, 5});
  return grid;
}

}  // namespace goshawk::corridor_builder::test_support
