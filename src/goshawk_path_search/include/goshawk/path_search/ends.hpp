#pragma once

#include <optional>

#include "goshawk/core/grid_geometry.hpp"
#include "goshawk/path_search/planner.hpp"

namespace goshawk::path_search {

/// A start or a goal as it is searched for.
struct PlacedEnd {
  Vec3 at_map = Vec3::Zero();  // [m]
  End end;
  double moved_m = 0.0;  // from where it was asked for
};

/// Finds the voxel of a start or goal. One in an obstacle or in unknown space, or, under
/// no_squeeze, on the very face of a blocked voxel or of the map (no segment from it is free), is
/// moved to the centre of the nearest free voxel whose centre is within the radius.
/// @param move_within_m [m] 0: nothing is moved
/// @return the errors of goshawk::locate
Result<PlacedEnd> place_end(const VoxelGrid& map, CornerRule rule, const Vec3& p_map,
                            Endpoint endpoint, double move_within_m);

}  // namespace goshawk::path_search
