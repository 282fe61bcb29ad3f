#pragma once

#include <memory>
#include <span>
#include <string_view>

#include "goshawk/core/grid_geometry.hpp"
#include "goshawk/core/polytope.hpp"
#include "goshawk/core/result.hpp"
#include "goshawk/corridor_builder/config.hpp"

namespace goshawk::corridor_builder {

/// Wraps a polyline in convex polytopes that no obstacle cuts into (thesis, section "Safe Flight
/// Corridor Generation"; obstacles are whole cubes, not points: docs/corridors.md).
///
/// Promises for every corridor it returns:
/// - the open interior of a polytope meets no occupied voxel's cube and does not leave the map;
///   planes keep at least 1e-7 voxel edges away, or, if the path itself touches an obstacle's
///   face, are rounded to the free side;
/// - start and goal are the path's ends, to the bit, and lie in the first and last polytope (up to
///   1e-9 voxel edges if they touch a face); the path between waypoint k and k + 1 of the
///   result lies in polytope k;
/// - consecutive polytopes share a ball, which is reported: of half a voxel (less 2e-6 voxel edges)
///   wherever the path can be followed through free voxels that share faces, of more than 1e-6 m
///   always.
///
/// Not thread-safe: a builder keeps its working memory from call to call. The same input gives the
/// same bits, whatever was built before.
class CorridorBuilder {
 public:
  /// @return invalid_parameter, with every fault of the config in one sentence
  static Result<CorridorBuilder> create(const Config& config);

  /// From the next path on by this config; or, if create() would refuse it, as before.
  Status reconfigure(const Config& config);

  CorridorBuilder(CorridorBuilder&&) noexcept;
  CorridorBuilder& operator=(CorridorBuilder&&) noexcept;
  ~CorridorBuilder();

  /// @param grid obstacles inflated by the vehicle already; outside is blocked. With margin
  /// `sphere`
  ///   it needs its raw voxels: polytopes keep inflation_m away from every one of them (and from
  ///   unknown space if that was inflated as well), measured to the whole cube
  /// @param waypoints_map [m] n >= 2 points, frame `map`; all equal, or no neighbours equal
  /// @return invalid_input (not finite, fewer than two points, a segment of no length, a grid
  ///   that disagrees with itself), segment_blocked (a segment meets an occupied cube's interior or
  ///   leaves the map; names the segment and the place), corridor_disjoint (two polytopes share no
  ///   ball)
  Result<Corridor> build(const VoxelGrid& grid, std::span<const Vec3> waypoints_map);

  /// The same into memory that is reused: a repeated query allocates nothing.
  /// @param corridor overwritten; left as it was after a failure
  Status build(const VoxelGrid& grid, std::span<const Vec3> waypoints_map, Corridor& corridor);

  /// @return the generator's name, for reports: "ellipsoid" or "box"
  std::string_view implementation() const;

 private:
  class Impl;
  explicit CorridorBuilder(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace goshawk::corridor_builder
