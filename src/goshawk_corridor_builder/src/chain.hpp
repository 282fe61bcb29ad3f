#pragma once

#include <algorithm>
#include <optional>
#include <vector>

#include "goshawk/core/polytope.hpp"

namespace goshawk::corridor_builder {

/// A point of the path as given, between two where a long segment was split, or beside it where
/// the path was bent away from an obstacle.
struct PathPoint {
  Vec3 p_map = Vec3::Zero();
  Vec3 p_grid = Vec3::Zero();      // [voxel edges]
  Vec3 given_grid = Vec3::Zero();  // where it was before it was moved to the centre of a voxel
  int segment = 0;                 // of the path as given: the one that begins or goes on here
  double wanted = 0.0;             // [voxel edges] radius of the free ball around it, at most half
  double needed = 0.0;             // what polytopes that meet here must hold: 0 at start and goal
  bool moved = false;              // to the centre of a voxel
  bool settled = false;            // the segment that begins here was bent, or cannot be
};

/// Polytopes in a row, with points where one is left for the next; n polytopes have n + 1
/// waypoints, start and goal included. Waypoint k lies near, but not always inside, polytopes k - 1
/// and k until settle_waypoints has moved it. Memory of polytopes that are left out is kept for
/// later ones.
class Chain {
 public:
  std::vector<Vec3> waypoints_map;
  std::vector<Ball> overlaps;

  std::size_t size() const { return count_; }
  Polytope& operator[](std::size_t k) { return polytopes_[k]; }
  const Polytope& operator[](std::size_t k) const { return polytopes_[k]; }

  void clear() {
    waypoints_map.clear();
    overlaps.clear();
    count_ = 0;
  }
  /// @return the new last polytope, to be overwritten
  Polytope& append() {
    if (count_ == polytopes_.size()) polytopes_.emplace_back().half_spaces.reserve(kManyFaces);
    return polytopes_[count_++];
  }
  void drop_last() { --count_; }
  void erase(std::size_t k) {
    const auto at = polytopes_.begin() + std::ptrdiff_t(k);
    std::rotate(at, at + 1, polytopes_.begin() + std::ptrdiff_t(count_));
    --count_;
  }

 private:
  static constexpr std::size_t kManyFaces = 64;  // more are rare: polytopes change places

  std::vector<Polytope> polytopes_;  // the first count_
  std::size_t count_ = 0;
};

/// Where a path cannot be wrapped: it enters an obstacle.
struct Blockage {
  int segment = 0;
  Vec3 p_grid = Vec3::Zero();
};

/// Half a voxel edge, less what planes keep away from obstacles: the radius of the ball that
/// consecutive polytopes share where geometry allows.
inline constexpr double kHalfVoxel = 0.5 - 1e-6;

}  // namespace goshawk::corridor_builder
