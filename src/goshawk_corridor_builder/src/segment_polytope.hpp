#pragma once

#include <optional>
#include <vector>

#include "goshawk/core/grid_geometry.hpp"
#include "goshawk/core/polytope.hpp"
#include "goshawk/corridor_builder/config.hpp"
#include "obstacle_boxes.hpp"
#include "polytope_inflation.hpp"
#include "redundancy.hpp"

namespace goshawk::corridor_builder {

/// The polytope of one segment, by ellipsoid inflation.
class SegmentPolytope {
 public:
  explicit SegmentPolytope(const Config& config) : config_(config) {}

  /// @param p, q [voxel edges, GridGeometry::to_grid] inside the grid
  /// @param polytope frame map, overwritten
  /// @return nothing, or where the segment enters an obstacle: a point [voxel edges] and its voxel
  std::optional<Vec3> build(const VoxelGrid& grid, const Vec3& p, const Vec3& q,
                            const Margins& margins, Polytope& polytope);

 private:
  std::optional<Vec3> build_within(const VoxelGrid& grid, const Vec3& p, const Vec3& q,
                                   double reach_voxels, const Margins& margins);
  void grow(const Ellipsoid& first, const Vec3& extent, const Segment& segment, double slack,
            const Margins& margins);

  Config config_;
  ObstacleMerger merger_;
  BoxSet boxes_;
  PolytopeInflation inflation_;
  PolytopeInflation regrown_;
  RedundancyFilter redundancy_;
  Vec3 base_ = Vec3::Zero();  // of the local box [voxel edges]
  std::vector<Plane> faces_;
  std::vector<Plane> fewest_;
  Vec3 fewest_base_ = Vec3::Zero();
};

/// Planes in voxel edges relative to `base`, as a polytope in frame map.
void to_map(const std::vector<Plane>& planes, const Vec3& base, const GridGeometry& geometry,
            Polytope& polytope);

}  // namespace goshawk::corridor_builder
