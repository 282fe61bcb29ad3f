#include "scan.hpp"

#include <fmt/format.h>
#include <octomap/OcTree.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace goshawk::map_server {
namespace {

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

// How far a ray to p, given by its share of the way, stays inside the box; below 0 if it misses it.
double exit_of(const Box& box, const Vec3& origin, const Vec3& ray) {
  double enter = 0.0, leave = 1.0;
  for (int a = 0; a < 3; ++a) {
    if (ray[a] == 0.0) {
      if (origin[a] < box.lower_map[a] || origin[a] >= box.upper_map[a]) return -1.0;
      continue;
    }
    const double u = (box.lower_map[a] - origin[a]) / ray[a];
    const double v = (box.upper_map[a] - origin[a]) / ray[a];
    enter = std::max(enter, std::min(u, v));
    leave = std::min(leave, std::max(u, v));
  }
  return enter <= leave ? leave : -1.0;
}

/// One scan on its way into the tree: what it hits, and rays that only clear.
class Scan {
 public:
  Scan(const octomap::OcTree& tree, const Vec3& origin, double max_range_m, const Box* box)
      : tree_(tree), origin_(origin), max_range_m_(max_range_m), box_(box) {}

  InsertedScan sort(std::span<const Vec3> points);
  void write(octomap::OcTree& tree, const ScanKeys* keys);

 private:
  void clear_to(const Vec3& ray);

  const octomap::OcTree& tree_;
  Vec3 origin_;
  double max_range_m_;
  const Box* box_;
  octomap::Pointcloud hits_;
  std::vector<Vec3> cleared_;  // ends of rays [m] map
};

InsertedScan Scan::sort(std::span<const Vec3> points) {
  InsertedScan result;
  hits_.reserve(points.size());
  for (const Vec3& p : points) {
    const Vec3 ray = p - origin_;
    const double length_m = ray.norm();
    // Many drivers write a missing return as the sensor's own place: it would block that voxel.
    if (!std::isfinite(length_m) || length_m == 0.0) {
      ++result.left_out;
    } else if (box_ != nullptr && !box_->holds(p)) {
      ++result.cut;
      clear_to(ray);
    } else {
      // OctoMap computes in float: a far end is pulled in first, still beyond the range.
      const double far = 2.0 * max_range_m_;
      hits_.push_back(to_point(length_m > far ? Vec3(origin_ + ray * (far / length_m)) : p));
    }
  }
  return result;
}

// A ray that ends outside the box, up to a little beyond where it leaves it: OctoMap leaves out the
// last voxel of a ray.
void Scan::clear_to(const Vec3& ray) {
  const double leave = exit_of(*box_, origin_, ray);
  if (leave < 0.0) return;
  const double length_m = ray.norm();
  const double beyond = 2.0 * tree_.getResolution() / length_m;
  const double share = std::min({1.0, leave + beyond, max_range_m_ / length_m});
  cleared_.push_back(origin_ + share * ray);
}

void Scan::write(octomap::OcTree& tree, const ScanKeys* keys) {
  octomap::KeySet free, occupied;
  tree.computeUpdate(hits_, to_point(origin_), free, occupied, max_range_m_);
  octomap::KeyRay ray;
  for (const Vec3& end : cleared_) {
    if (!tree.computeRayKeys(to_point(origin_), to_point(end), ray)) continue;
    for (const octomap::OcTreeKey& key : ray) {
      if (occupied.find(key) == occupied.end()) free.insert(key);
    }
  }
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
  Scan scan(tree, sensor_origin_map, max_range_m, box);
  const InsertedScan result = scan.sort(points_map);
  scan.write(tree, box != nullptr ? &keys : nullptr);
  return result;
}

}  // namespace goshawk::map_server
