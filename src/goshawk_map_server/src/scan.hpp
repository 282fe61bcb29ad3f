#pragma once

#include <cstdint>
#include <span>

#include "goshawk/core/result.hpp"
#include "goshawk/core/vector.hpp"
#include "goshawk/map_server/octree.hpp"

namespace goshawk::map_server {

/// OctoMap's insertPointCloud, kept from what it cannot bear: points that are not finite or far
/// beyond its raster, and points at the sensor itself (missing returns).
/// @param max_range_m [m] a ray longer than this clears space up to there and hits nothing
/// @return how many points were left out; invalid_input for an origin or a range that cannot be
Result<std::int64_t> insert_scan(octomap::OcTree& tree, std::span<const Vec3> points_map,
                                 const Vec3& sensor_origin_map, double max_range_m);

}  // namespace goshawk::map_server
