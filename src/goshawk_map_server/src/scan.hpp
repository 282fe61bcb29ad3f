#pragma once

#include <cstdint>
#include <span>

#include "goshawk/core/result.hpp"
#include "goshawk/core/vector.hpp"
#include "goshawk/map_server/octree.hpp"

namespace goshawk::map_server {

struct InsertedScan {
  std::int64_t left_out = 0;  // points that are not finite, or at the sensor itself
  std::int64_t cut = 0;       // rays that end outside the box: they clear what they cross of it
};

/// OctoMap's insertPointCloud, kept from what it cannot bear: points that are not finite or far
/// beyond its raster, and points at the sensor itself (missing returns).
/// @param max_range_m [m] a ray longer than this clears space up to there and hits nothing
/// @param box [m] may be null; nothing is written outside the raster that holds it
/// @return invalid_input for an origin or a range that cannot be, invalid_parameter for a box that
/// is empty
Result<InsertedScan> insert_scan(octomap::OcTree& tree, std::span<const Vec3> points_map,
                                 const Vec3& sensor_origin_map, double max_range_m,
                                 const Box* box = nullptr);

}  // namespace goshawk::map_server
