#pragma once

#include <optional>
#include <vector>

#include "goshawk/core/polytope.hpp"
#include "goshawk/core/vector.hpp"

namespace goshawk::corridor_builder {

/// A point of the path as given, or between two where a long segment was split.
struct PathPoint {
  Vec3 p_map = Vec3::Zero();
  Vec3 p_grid = Vec3::Zero();  // [voxel edges]
  int segment = 0;             // of the path as given: the one that begins or goes on here
};

/// Polytopes in a row, with points where one is left for the next; n polytopes have n + 1 joints,
/// start and goal included. Joint k lies near, but not always inside, polytopes k - 1 and k until
/// settle_joints has moved it.
struct Chain {
  std::vector<Vec3> joints_map;
  std::vector<Polytope> polytopes;

  void clear() {
    joints_map.clear();
    polytopes.clear();
  }
};

/// Where a path cannot be wrapped: it enters an obstacle.
struct Blockage {
  int segment = 0;
  Vec3 p_grid = Vec3::Zero();
};

}  // namespace goshawk::corridor_builder
