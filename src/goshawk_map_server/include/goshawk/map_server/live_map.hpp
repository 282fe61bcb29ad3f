#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <string>

#include "goshawk/core/grid_update.hpp"
#include "goshawk/map_server/map_file.hpp"
#include "goshawk/map_server/voxel_map.hpp"

namespace goshawk::map_server {

/// The tree, its bits and the grown grid, kept in step while scans come in. The grid's box never
/// changes: what a scan tells of the space outside stays in the tree alone.
class LiveMap {
 public:
  /// @param max_tree_bytes of the tree that the first scan makes of a map without one
  /// @return as voxelize() and make_voxel_grid(); the grid has version 1
  static Result<LiveMap> from_source(
      MapSource source, const VoxelizeOptions& options, const Growth& growth,
      std::int64_t max_tree_bytes = std::numeric_limits<std::int64_t>::max());

  /// A map that knows nothing yet. @param box [m] what the grid covers
  /// @return invalid_parameter, map_too_large
  static Result<LiveMap> unknown_space(const Box& box, double resolution_m, const Growth& growth,
                                       std::int64_t max_voxels = 1'000'000'000);

  /// With raw voxels. A copy shares its bits and stays as it is while scans come in.
  const VoxelGrid& grid() const { return grid_; }
  const Growth& growth() const { return growth_; }

  /// Null until a scan needs one, if the map was not read from one.
  const OcTreePtr& tree() const { return tree_; }
  /// What octomap_msgs/Octomap carries of the map (binary).
  Result<std::string> octomap_payload() const;

  struct ScanResult {
    GridUpdate update;  // brings grid() of before to grid() of now; may be empty
    std::int64_t points_left_out = 0;  // not finite, or at the sensor itself: missing returns
  };

  /// Inserts a scan and grows anew around what changed. The version rises by one, even if no
  /// brick changed.
  /// @param points_map, sensor_origin_map [m] frame map @param max_range_m [m] longer rays clear
  /// space up to there and hit nothing
  /// @return invalid_input, map_too_large (also if the tree would be); then nothing was inserted
  Result<ScanResult> insert_scan(std::span<const Vec3> points_map, const Vec3& sensor_origin_map,
                                 double max_range_m);

 private:
  LiveMap(OcTreePtr tree, VoxelGrid grid, const Growth& growth, std::int64_t max_tree_bytes);
  Status make_tree();

  OcTreePtr tree_;
  VoxelGrid grid_;
  std::int64_t max_tree_bytes_;
  Growth growth_;
};

}  // namespace goshawk::map_server
