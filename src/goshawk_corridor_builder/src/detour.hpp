#pragma once

#include <span>
#include <vector>

#include "obstacle_boxes.hpp"

namespace goshawk::corridor_builder {

/// Where the map ends.
struct Bounds {
  Vec3 lower = Vec3::Zero();
  Vec3 upper = Vec3::Zero();
};

/// Bends a path that grazes obstacles, so that balls of half a voxel fit along all of it: then
/// they fit into its polytopes, and into what consecutive ones share.
///
/// Points are relative to the obstacles' base [voxel edges].
class Detour {
 public:
  /// @param between overwritten with points such that the hull of neighbouring balls is free all
  ///   along p, between, q
  /// @return false if pushing the path away from the nearest obstacles does not help
  bool push_away(const BoxSet& obstacles, const Bounds& map, const Segment& segment,
                 std::vector<Vec3>& between);

  /// The same over voxel centres: of free voxels, each of which shares a face with the next, from
  /// the one that holds p to the one that holds q. Half a voxel is free around the polyline that
  /// joins them, so this finds a way; it takes as few of the centres as it can.
  /// @param to_last ends at the last centre in place of q
  /// @return false if even neighbouring centres are too close to an obstacle
  bool along(const BoxSet& obstacles, const Segment& segment, std::span<const Vec3> centres,
             bool to_last, std::vector<Vec3>& between);

 private:
  bool push(const Bounds& map, const Segment& segment, int depth, std::vector<Vec3>& between);
  void gather(const BoxSet& obstacles, const Vec3& lower, const Vec3& upper);
  int worst_in(const Segment& segment) const;
  bool is_free(const Segment& segment) const;

  std::vector<Obstacle> near_;
};

}  // namespace goshawk::corridor_builder
