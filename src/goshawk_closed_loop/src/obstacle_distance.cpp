#include "goshawk/closed_loop/obstacle_distance.hpp"

#include <algorithm>
#include <cmath>

namespace goshawk::closed_loop {

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

}  // namespace goshawk::closed_loop
