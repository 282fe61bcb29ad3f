#include "growing_world.hpp"

#include <algorithm>
#include <cmath>

#include "goshawk/core/inflation.hpp"

namespace goshawk::goals {

GrowingWorld::GrowingWorld(const worlds::WorldSpec& spec) {
  auto made = worlds::make_world(spec).value();
  geometry_ = made.geometry;
  raw_ = std::move(made.occupied);
  grow();
}

void GrowingWorld::grow() {
  const double radius_m = kBody_m + kTrackingMargin_m;
  auto grown = inflate(raw_, radius_m, geometry_.resolution_m).value();
  map_ = std::make_shared<const VoxelGrid>(VoxelGrid{.geometry = geometry_,
                                                     .grown = std::move(grown),
                                                     .known = {},
                                                     .raw = raw_,
                                                     .version = ++version_,
                                                     .inflation_m = radius_m});
}

void GrowingWorld::add(Index3 voxel) {
  raw_.set(voxel, true);
  grow();
}

double obstacle_distance_m(const VoxelGrid& map, const Vec3& p_map, double within_m) {
  const Vec3 p = map.geometry.to_grid(p_map);
  const int reach = int(std::ceil(within_m / map.geometry.resolution_m));
  const Index3 at{int(std::floor(p.x())), int(std::floor(p.y())), int(std::floor(p.z()))};
  double nearest = within_m;
  for (int z = at.z - reach; z <= at.z + reach; ++z) {
    for (int y = at.y - reach; y <= at.y + reach; ++y) {
      for (int x = at.x - reach; x <= at.x + reach; ++x) {
        if (!map.raw.contains({x, y, z}) || !map.raw.get({x, y, z})) continue;
        const Vec3 corner(x, y, z);
        const Vec3 off = (corner - p).cwiseMax(p - corner - Vec3::Ones()).cwiseMax(0.0);
        nearest = std::min(nearest, map.geometry.resolution_m * off.norm());
      }
    }
  }
  return nearest;
}

Vec3 GrowingWorld::free_place(Random& random) const {
  for (;;) {
    const Index3 voxel{random.below(geometry_.size.x), random.below(geometry_.size.y),
                       random.below(geometry_.size.z)};
    if (!map_->grown.get(voxel)) return geometry_.center(voxel);
  }
}

}  // namespace goshawk::goals
