#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "goshawk/core/grid_geometry.hpp"
#include "goshawk/core/inflation.hpp"
#include "goshawk/core/line_of_sight.hpp"
#include "goshawk/core/random.hpp"

namespace goshawk::corridor_builder::test_support {

inline VoxelGrid empty_world(Index3 size, double resolution_m, Vec3 origin_map = Vec3::Zero()) {
  VoxelGrid grid;
  grid.geometry = {origin_map, resolution_m, size};
  grid.grown = BitGrid(size, true);
  return grid;
}

inline double blocked_share(const VoxelGrid& grid) {
  return double(grid.grown.count()) / double(grid.grown.voxels());
}

/// Every voxel blocked or not by itself.
inline void add_noise(VoxelGrid& grid, double ratio, Random& random) {
  const Index3 n = grid.geometry.size;
  for (int z = 0; z < n.z; ++z) {
    for (int y = 0; y < n.y; ++y) {
      for (int x = 0; x < n.x; ++x) {
        if (random.chance(ratio)) grid.grown.set({x, y, z}, true);
      }
    }
  }
}

inline void fill(VoxelGrid& grid, Index3 lo, Index3 hi) {
  const Index3 n = grid.geometry.size;
  const int x0 = std::clamp(lo.x, 0, n.x);
  const int x1 = std::clamp(hi.x, x0, n.x);
  for (int z = std::max(0, lo.z); z < std::min(n.z, hi.z); ++z) {
    for (int y = std::max(0, lo.y); y < std::min(n.y, hi.y); ++y) {
      grid.grown.set_run(x0, x1, y, z, true);
    }
  }
}

/// Boxes and pillars until `ratio` of the world, after growing by `radius_m`, is blocked.
inline VoxelGrid boxes_and_pillars(Index3 size, double resolution_m, double ratio, double radius_m,
                                   std::uint64_t seed) {
  Random random(seed);
  VoxelGrid raw = empty_world(size, resolution_m);
  VoxelGrid grown = raw;
  for (int k = 0; k < 10000 && blocked_share(grown) < ratio; ++k) {
    const int w = 1 + random.below(4);
    const int d = 1 + random.below(4);
    const bool pillar = random.chance(0.5);
    const int h = pillar ? size.z : 2 + random.below(std::max(1, size.z / 2));
    const Index3 lo{random.below(size.x), random.below(size.y), pillar ? 0 : random.below(size.z)};
    fill(raw, lo, {lo.x + w, lo.y + d, lo.z + h});
    grown.grown = inflate(raw.grown, radius_m, resolution_m).value();
  }
  return grown;
}

/// Trunks, round in section, from the ground to the top.
inline VoxelGrid forest(Index3 size, double resolution_m, int trees, double radius_m,
                        std::uint64_t seed) {
  Random random(seed);
  VoxelGrid grid = empty_world(size, resolution_m);
  for (int k = 0; k < trees; ++k) {
    const double cx = random.uniform(0.0, size.x);
    const double cy = random.uniform(0.0, size.y);
    const double r = random.uniform(0.1, 0.4) / resolution_m;
    for (int y = int(cy - r) - 1; y <= int(cy + r) + 1; ++y) {
      for (int x = int(cx - r) - 1; x <= int(cx + r) + 1; ++x) {
        if (std::hypot(x + 0.5 - cx, y + 0.5 - cy) < r)
          fill(grid, {x, y, 0}, {x + 1, y + 1, size.z});
      }
    }
  }
  grid.grown = inflate(grid.grown, radius_m, resolution_m).value();
  return grid;
}

/// A point of a free voxel: its centre, anywhere in it, or on its faces.
inline bool random_free_point(const VoxelGrid& grid, Random& random, Vec3& p_map) {
  const Index3 n = grid.geometry.size;
  for (int k = 0; k < 200; ++k) {
    const Index3 i{random.below(n.x), random.below(n.y), random.below(n.z)};
    if (grid.grown.get(i)) continue;
    const int kind = random.below(4);
    Vec3 f(0.5, 0.5, 0.5);
    if (kind >= 1) f = Vec3(random.uniform(), random.uniform(), random.uniform());
    if (kind == 2) f[random.below(3)] = random.chance(0.5) ? 0.0 : 1.0;
    p_map = grid.geometry.origin_map + grid.geometry.resolution_m * (Vec3(i.x, i.y, i.z) + f);
    return true;
  }
  return false;
}

/// A polyline of up to `segments` segments in the sense of line_is_free, each up to reach_m long.
inline std::vector<Vec3> random_free_path(const VoxelGrid& grid, int segments, double reach_m,
                                          Random& random) {
  std::vector<Vec3> path(1);
  if (!random_free_point(grid, random, path[0])) return {};
  for (int tries = 0; tries < 60 && int(path.size()) <= segments; ++tries) {
    Vec3 next;
    if (!random_free_point(grid, random, next)) return {};
    const Vec3 step = next - path.back();
    const double length = step.norm();
    if (length > reach_m) next = path.back() + step * (reach_m / length);
    if (next != path.back() && line_is_free(grid, path.back(), next)) path.push_back(next);
  }
  if (path.size() < 2) path.clear();
  return path;
}

}  // namespace goshawk::corridor_builder::test_support
