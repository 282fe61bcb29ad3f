#include "scan.hpp"

#include <octomap/OcTree.h>

#include <cmath>

namespace goshawk::map_server {

Result<std::int64_t> insert_scan(octomap::OcTree& tree, std::span<const Vec3> points_map,
                                 const Vec3& sensor_origin_map, double max_range_m) {
  if (!is_finite(sensor_origin_map) || !(std::isfinite(max_range_m) && max_range_m > 0.0)) {
    return fail(ErrorCode::invalid_input,
                "a scan needs a finite sensor origin and a finite range above zero");
  }
  // Rays must stay on the raster: 32768 voxels to each side of the origin, one to spare.
  const double reach_m = 32766.0 * tree.getResolution();
  if (sensor_origin_map.cwiseAbs().maxCoeff() + max_range_m > reach_m) {
    return fail(ErrorCode::map_too_large, "the sensor at " + to_text(sensor_origin_map) +
                                              " m with a range of " + std::to_string(max_range_m) +
                                              " m reaches beyond OctoMap's 32768 voxels from "
                                              "the origin: use a coarser resolution");
  }
  octomap::Pointcloud cloud;
  cloud.reserve(points_map.size());
  std::int64_t left_out = 0;
  for (const Vec3& p : points_map) {
    const Vec3 ray = p - sensor_origin_map;
    const double length_m = ray.norm();
    // Many drivers write a missing return as the sensor's own place: it would block that voxel.
    if (!std::isfinite(length_m) || length_m == 0.0) {
      ++left_out;
      continue;
    }
    // OctoMap computes in float: a far end is pulled in first, still beyond the range.
    const Vec3 end =
        length_m > 2.0 * max_range_m ? sensor_origin_map + ray * (2.0 * max_range_m / length_m) : p;
    cloud.push_back(float(end.x()), float(end.y()), float(end.z()));
  }
  const octomap::point3d origin(float(sensor_origin_map.x()), float(sensor_origin_map.y()),
                                float(sensor_origin_map.z()));
  tree.insertPointCloud(cloud, origin, max_range_m);
  return left_out;
}

}  // namespace goshawk::map_server
