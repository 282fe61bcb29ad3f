#include "scan.hpp"

#include <fmt/format.h>
#include <octomap/OcTree.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace goshawk::map_server {
namespace {

constexpr double kShortest_voxels = 1e-6;  // [voxel edges] a ray up to this ends at the sensor

octomap::point3d to_point(const Vec3& p) {
  return {float(p.x()), float(p.y()), float(p.z())};
}

// Voxels of the tree's raster, in keys.
struct ScanKeys {
  Index3 lower, upper;  // upper excluded

  bool holds(const octomap::OcTreeKey& key) const {
    const Index3 i{key[0], key[1], key[2]};
    return i.x >= lower.x && i.y >= lower.y && i.z >= lower.z && i.x < upper.x && i.y < upper.y &&
           i.z < upper.z;
  }
};

Result<ScanKeys> keys_of(const Box& box, double resolution_m) {
  const auto raster = raster_of(box, resolution_m, std::numeric_limits<std::int64_t>::max());
  if (!raster) return raster.error();
  const Vec3 steps = (raster->origin_map / resolution_m).array().round().matrix();
  const Index3 lower{int(steps.x()) + 32768, int(steps.y()) + 32768, int(steps.z()) + 32768};
  return ScanKeys{lower, lower + raster->size};
}

// Does the ray reach the box before its end?
bool meets(const Box& box, const Vec3& origin, const Vec3& ray) {
  double enter = 0.0, leave = 1.0;
  for (int a = 0; a < 3; ++a) {
    if (ray[a] == 0.0) {
      if (origin[a] < box.lower_map[a] || origin[a] >= box.upper_map[a]) return false;
      continue;
    }
    const double u = (box.lower_map[a] - origin[a]) / ray[a];
    const double v = (box.upper_map[a] - origin[a]) / ray[a];
    enter = std::max(enter, std::min(u, v));
    leave = std::min(leave, std::max(u, v));
  }
  return enter <= leave;
}

/// One scan on its way into the tree.
class Scan {
 public:
  Scan(const Vec3& origin, double max_range_m) : origin_(origin), max_range_m_(max_range_m) {}

  /// @param box may be null
  InsertedScan sort(std::span<const Vec3> points, const Box* box, double resolution_m);
  void write(octomap::OcTree& tree, const ScanKeys* keys) const;

 private:
  Vec3 origin_;
  double max_range_m_;
  octomap::Pointcloud ends_;
};

InsertedScan Scan::sort(std::span<const Vec3> points, const Box* box, double resolution_m) {
  InsertedScan result;
  Box near;  // holds the raster around the box, and what rounding may move into it
  if (box != nullptr) {
    const Vec3 margin = Vec3::Constant(2.0 * resolution_m);
    near = {box->lower_map - margin, box->upper_map + margin};
  }
  ends_.reserve(points.size());
  for (const Vec3& p : points) {
    const Vec3 ray = p - origin_;
    const double length_m = ray.norm();
    // Many drivers write a missing return as the sensor's own place: it would block that voxel. A
    // ray whose square is 0 in float has no direction: OctoMap would never find its end.
    if (!std::isfinite(length_m) || length_m <= kShortest_voxels * resolution_m) {
      ++result.left_out;
      continue;
    }
    if (box != nullptr && !box->holds(p)) {
      ++result.cut;
      if (!meets(near, origin_, ray)) continue;
    }
    // OctoMap computes in float: a far end is pulled in first, still beyond the range.
    const double far = 2.0 * max_range_m_;
    ends_.push_back(to_point(length_m > far ? Vec3(origin_ + ray * (far / length_m)) : p));
  }
  return result;
}

// Rays go to their own ends, whatever the box: with another end, rounding takes another way round
// the corners of voxels, and the box would clear what the whole scan did not see.
void Scan::write(octomap::OcTree& tree, const ScanKeys* keys) const {
  octomap::KeySet free, occupied;
  tree.computeUpdate(ends_, to_point(origin_), free, occupied, max_range_m_);
  const auto inside = [&](const octomap::OcTreeKey& key) {
    return keys == nullptr || keys->holds(key);
  };
  for (const auto& key : free) {
    if (inside(key)) tree.updateNode(key, false);
  }
  for (const auto& key : occupied) {
    if (inside(key)) tree.updateNode(key, true);
  }
}

}  // namespace

Result<InsertedScan> insert_scan(octomap::OcTree& tree, std::span<const Vec3> points_map,
                                 const Vec3& sensor_origin_map, double max_range_m,
                                 const Box* box) {
  if (!is_finite(sensor_origin_map) || !(std::isfinite(max_range_m) && max_range_m > 0.0)) {
    return fail(ErrorCode::invalid_input,
                "a scan needs a finite sensor origin and a finite range above zero");
  }
  // Rays must stay on the raster: 32768 voxels to each side of the origin, one to spare.
  const double reach_m = 32766.0 * tree.getResolution();
  if (sensor_origin_map.cwiseAbs().maxCoeff() + max_range_m > reach_m) {
    return fail(ErrorCode::map_too_large,
                fmt::format("the sensor at {} m with a range of {:g} m reaches beyond OctoMap's "
                            "32768 voxels from the origin: use a coarser resolution, or "
                            "cloud_origin_x_m, _y_m and _z_m for a file",
                            to_text(sensor_origin_map), max_range_m));
  }
  ScanKeys keys{};
  if (box != nullptr) {
    const auto found = keys_of(*box, tree.getResolution());
    if (!found) return found.error();
    keys = *found;
  }
  Scan scan(sensor_origin_map, max_range_m);
  const InsertedScan result = scan.sort(points_map, box, tree.getResolution());
  scan.write(tree, box != nullptr ? &keys : nullptr);
  return result;
}

}  // namespace goshawk::map_server
