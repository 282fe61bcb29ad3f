#pragma once

#include <optional>
#include <span>
#include <vector>

#include "chain.hpp"
#include "detour.hpp"
#include "segment_polytope.hpp"
#include "voxel_walk.hpp"

namespace goshawk::corridor_builder {

/// The path as points: long segments split into equal parts, repeated waypoints left out.
void split_path(const GridGeometry& geometry, std::span<const Vec3> path, double max_segment_m,
                std::vector<PathPoint>& points);

/// The ellipsoid generator: wraps a path segment by segment. A polytope that holds balls of half a
/// voxel around both ends of its segment shares them with its neighbours. Where obstacles come so
/// near that these do not fit, the path is bent away from them (Detour) before it is wrapped.
class PathWrapper {
 public:
  explicit PathWrapper(const Config& config) : config_(config), segment_polytope_(config) {}

  /// @param grown what the path was searched on @param map what polytopes keep out of
  /// @param points the path; bent in place
  /// @param chain overwritten @return nothing, or if the path is blocked
  std::optional<Blockage> wrap(const VoxelGrid& grown, const ObstacleLayers& map,
                               const Margins& margins, std::vector<PathPoint>& points,
                               Chain& chain);

 private:
  enum class Step { done, bent, blocked };

  void measure_rooms(const BitGrid& occupied, std::vector<PathPoint>& points) const;
  Step wrap_one(std::size_t i, Chain& chain);
  std::size_t join(std::size_t i, Chain& chain);
  Separation build(const PathPoint& p, const PathPoint& q, bool stop_when_thin, Chain& chain);
  Step move_waypoint(std::size_t i, Chain& chain);
  void bend(std::size_t i, const Segment& segment);
  bool walk(std::size_t i);
  void insert(std::size_t i);
  std::size_t covered_until(const Polytope& polytope, std::size_t end) const;

  Config config_;
  SegmentPolytope segment_polytope_;
  Detour detour_;
  VoxelWalk walk_;
  std::vector<Index3> voxels_;
  std::vector<Vec3> centres_;
  std::vector<Vec3> between_;
  // Of the path that is being wrapped.
  const VoxelGrid* grown_ = nullptr;
  const ObstacleLayers* map_ = nullptr;
  Margins margins_;
  std::vector<PathPoint>* points_ = nullptr;
  Vec3 blocked_grid_ = Vec3::Zero();
};

}  // namespace goshawk::corridor_builder
