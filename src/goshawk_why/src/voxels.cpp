#include "voxels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace goshawk::why {
namespace {

// From a place to the nearest point of a voxel.
double distance_to(const VoxelGrid& grid, Index3 i, const Vec3& place_map) {
  const Vec3 lower = grid.geometry.lower_corner(i);
  const Vec3 upper = lower + Vec3::Constant(grid.geometry.resolution_m);
  return (place_map - place_map.cwiseMax(lower).cwiseMin(upper)).norm();
}

// The nearest voxel within the inflation that counts, if any.
template <typename Counts>
std::optional<BlockingVoxel> nearest(const VoxelGrid& grid, const Vec3& place_map,
                                     const Counts& counts) {
  const Index3 middle = *grid.geometry.index_of(place_map);
  const int reach = int(std::ceil(grid.inflation_m / grid.geometry.resolution_m)) + 1;
  std::optional<BlockingVoxel> best;
  for (int z = -reach; z <= reach; ++z) {
    for (int y = -reach; y <= reach; ++y) {
      for (int x = -reach; x <= reach; ++x) {
        const Index3 i = middle + Index3{x, y, z};
        if (!grid.grown.contains(i) || !counts(i)) continue;
        const double distance_m = distance_to(grid, i, place_map);
        if (!best || distance_m < best->distance_m) best = voxel_at(grid, i, place_map);
      }
    }
  }
  return best;
}

}  // namespace

BlockingVoxel voxel_at(const VoxelGrid& grid, Index3 index, const Vec3& from_map) {
  return {.index = index,
          .center_map = grid.geometry.center(index),
          .known = grid.is_known(index),
          .distance_m = distance_to(grid, index, from_map)};
}

std::optional<BlockingVoxel> blocking_voxel(const VoxelGrid& grid, const Vec3& place_map) {
  const auto own = grid.geometry.index_of(place_map);
  if (!own || !grid.grown.test(*own)) return {};
  if (!grid.raw.empty()) {
    if (auto obstacle = nearest(grid, place_map, [&](Index3 i) { return grid.raw.test(i); })) {
      return obstacle;
    }
  }
  if (auto unseen = nearest(grid, place_map, [&](Index3 i) { return !grid.is_known(i); })) {
    return unseen;
  }
  return voxel_at(grid, *own, place_map);
}

std::string to_text(const BlockingVoxel& voxel) {
  return fmt::format("{} at {} (voxel {})", voxel.known ? "the obstacle" : "space never seen",
                     goshawk::to_text(voxel.center_map), goshawk::to_text(voxel.index));
}

}  // namespace goshawk::why
