#include "unfolding_world.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "goshawk/core/inflation.hpp"
#include "growing_world.hpp"

namespace goshawk::goals {
namespace {

constexpr int kRays = 12'000;
constexpr double kRadius_m = kBody_m + kTrackingMargin_m;

}  // namespace

UnfoldingWorld::UnfoldingWorld(const worlds::World& world, double range_m)
    : geometry_(world.geometry),
      range_voxels_(range_m / world.geometry.resolution_m),
      occupied_(world.occupied),
      seen_(world.geometry.size, false),
      met_(world.geometry.size, true, false) {
  // Equally spread over the sphere: the golden spiral.
  const double golden = std::numbers::pi * (3.0 - std::sqrt(5.0));
  for (int i = 0; i < kRays; ++i) {
    const double z = 1.0 - 2.0 * (i + 0.5) / kRays, r = std::sqrt(1.0 - z * z);
    directions_.emplace_back(r * std::cos(golden * i), r * std::sin(golden * i), z);
  }
  truth_ = grid_of(occupied_, {});
  map_ = grid_of(met_, seen_);
}

std::shared_ptr<const VoxelGrid> UnfoldingWorld::grid_of(const BitGrid& raw,
                                                         const BitGrid& known) const {
  return std::make_shared<const VoxelGrid>(
      VoxelGrid{.geometry = geometry_,
                .grown = inflate(raw, kRadius_m, geometry_.resolution_m).value(),
                .known = known,
                .raw = raw,
                .version = version_,
                .inflation_m = kRadius_m,
                .unknown_is_occupied = false});
}

bool UnfoldingWorld::see_from(const Vec3& p_map) {
  changed_ = false;
  const Vec3 from = geometry_.to_grid(p_map);
  for (const Vec3& direction : directions_) cast(from, direction);
  if (!changed_) return false;
  ++version_;
  map_ = grid_of(met_, seen_);
  return true;
}

// Voxel by voxel along the ray: over the nearest face each time.
void UnfoldingWorld::cast(const Vec3& from, const Vec3& direction) {
  Eigen::Vector3i voxel = from.array().floor().cast<int>();
  Vec3 next, per_voxel;
  for (int axis = 0; axis < 3; ++axis) {
    per_voxel[axis] = 1.0 / std::max(std::abs(direction[axis]), 1e-12);
    const double ahead =
        direction[axis] > 0.0 ? voxel[axis] + 1.0 - from[axis] : from[axis] - voxel[axis];
    next[axis] = ahead * per_voxel[axis];
  }
  for (double passed = 0.0; passed < range_voxels_;) {
    const Index3 i{voxel.x(), voxel.y(), voxel.z()};
    if (!seen_.contains(i)) return;
    const bool hit = occupied_.get(i);
    if (!seen_.get(i) || met_.get(i) != hit) {
      seen_.set(i, true);
      met_.set(i, hit);
      changed_ = true;
    }
    if (hit) return;
    int axis = 0;
    passed = next.minCoeff(&axis);
    next[axis] += per_voxel[axis];
    voxel[axis] += direction[axis] > 0.0 ? 1 : -1;
  }
}

void UnfoldingWorld::add(const std::vector<Index3>& voxels) {
  for (const Index3 voxel : voxels) {
    if (occupied_.contains(voxel)) occupied_.set(voxel, true);
  }
  truth_ = grid_of(occupied_, {});
}

bool body_was_seen_free(const VoxelGrid& map, const Vec3& p_map) {
  const Vec3 p = map.geometry.to_grid(p_map);
  const double radius = map.inflation_m / map.geometry.resolution_m;
  const int reach = int(std::ceil(radius));
  const Index3 c{int(std::floor(p.x())), int(std::floor(p.y())), int(std::floor(p.z()))};
  for (int z = c.z - reach; z <= c.z + reach; ++z) {
    for (int y = c.y - reach; y <= c.y + reach; ++y) {
      for (int x = c.x - reach; x <= c.x + reach; ++x) {
        if (!map.known.contains({x, y, z})) continue;
        const Vec3 lo(x, y, z);
        if ((p - p.cwiseMax(lo).cwiseMin(lo + Vec3::Ones())).norm() >= radius - 1e-4) continue;
        if (!map.known.get({x, y, z}) || map.raw.get({x, y, z})) return false;
      }
    }
  }
  return true;
}

}  // namespace goshawk::goals
