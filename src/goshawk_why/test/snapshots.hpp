#pragma once

#include <memory>

#include "goshawk/why/why.hpp"

namespace goshawk::why {

/// 10 x 10 x 4 m in voxels of 0.2 m, free and known; obstacles grow by 0.2 m.
inline VoxelGrid room() {
  const Index3 size{50, 50, 20};
  return {.geometry = {.origin_map = Vec3::Zero(), .resolution_m = 0.2, .size = size},
          .grown = BitGrid(size, true),
          .known = BitGrid(size, false, true),
          .raw = BitGrid(size, true),
          .version = 7,
          .inflation_m = 0.2};
}

/// One measured obstacle, grown as by 0.2 m.
inline void put_obstacle(VoxelGrid& grid, Index3 at) {
  grid.raw.set(at, true);
  for (int z = -1; z <= 1; ++z) {
    for (int y = -1; y <= 1; ++y) {
      for (int x = -1; x <= 1; ++x) grid.grown.set(at + Index3{x, y, z}, true);
    }
  }
}

/// Everything runs: the vehicle hovers at (1, 1, 1) and has arrived there.
inline Snapshot at_rest() {
  Snapshot s;
  s.vehicle = Snapshot::Vehicle{.position_map = {1, 1, 1}};
  s.status = Snapshot::Status{};
  s.navigator = Snapshot::Navigator{
      .state = Snapshot::Navigator::State::arrived, .request_id = 5, .goal_map = {1, 1, 1}};
  s.tracker = Snapshot::Tracker{.mode = Snapshot::Tracker::Mode::hold};
  s.map = std::make_shared<const VoxelGrid>(room());
  s.map_age_s = 0.4;
  return s;
}

}  // namespace goshawk::why
