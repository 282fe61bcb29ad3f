#pragma once

#include <array>
#include <vector>

#include "goshawk/core/grid_geometry.hpp"
#include "goshawk/core/polytope.hpp"
#include "goshawk/corridor_builder/config.hpp"
#include "obstacle_boxes.hpp"
#include "polytope_expansion.hpp"
#include "redundancy.hpp"

namespace goshawk::corridor_builder {

/// What polytopes keep out of: one or two sets of voxels, each with a sphere swept over it.
struct ObstacleLayers {
  struct Layer {
    ObstacleVoxels voxels;
    double radius = 0.0;  // [voxel edges]
  };
  std::array<Layer, 2> layers;  // an empty one is not there
  GridGeometry geometry;
};

/// The polytope of one segment, by expansion of an ellipsoid.
class SegmentPolytope {
 public:
  explicit SegmentPolytope(const Config& config) : config_(config) {
    // They change places with each other: so that neither has to grow late.
    faces_.reserve(RedundancyFilter::kMostPlanes);
    fewest_.reserve(RedundancyFilter::kMostPlanes);
    expansion_.reserve(RedundancyFilter::kMostPlanes);
    again_.reserve(RedundancyFilter::kMostPlanes);
  }

  /// @param segment [voxel edges, GridGeometry::to_grid] inside the grid
  /// @param stop_when_thin ends without a polytope if the balls around its ends do not fit
  /// @param polytope frame map, overwritten unless blocked, or thin and that was to stop it
  Separation build(const ObstacleLayers& map, const Segment& segment, bool stop_when_thin,
                   const Margins& margins, Polytope& polytope);

  /// Of the last build: the obstacles around the segment, and where the segment was thin or
  /// blocked, relative to base() [voxel edges]
  const BoxSet& obstacles() const { return boxes_; }
  const Vec3& base() const { return base_; }
  const Obstacle& in_the_way() const { return in_the_way_; }

 private:
  Separation build_within(const ObstacleLayers& map, const Segment& segment, double reach_voxels,
                          bool stop_when_thin, const Margins& margins);
  bool find_thin(const Segment& segment);
  void collect(const ObstacleLayers& map, const VoxelBox& local);
  void grow(const Ellipsoid& first, const Vec3& extent, const Segment& segment,
            const Margins& margins);

  Config config_;
  ObstacleMerger merger_;
  BoxSet boxes_;
  PolytopeExpansion expansion_;
  PolytopeExpansion again_;
  RedundancyFilter redundancy_;
  Vec3 base_ = Vec3::Zero();  // of the local box [voxel edges]
  Obstacle in_the_way_;
  std::vector<Plane> faces_;
  std::vector<Plane> fewest_;
  Vec3 fewest_base_ = Vec3::Zero();
};

/// Planes in voxel edges relative to `base`, as a polytope in frame map.
void to_map(const std::vector<Plane>& planes, const Vec3& base, const GridGeometry& geometry,
            Polytope& polytope);

}  // namespace goshawk::corridor_builder
