#include "goshawk/sensors/voxel_world.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace goshawk::sensors {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr int kFar = 255;  // [blocks]

std::uint64_t bit_of(int x, int y, int z) {
  return std::uint64_t{1} << (((z & 3) << 4) | ((y & 3) << 2) | (x & 3));
}

}  // namespace

/// A ray on its way, in voxel units; parameters are metres along the ray.
struct VoxelWorld::Walk {
  double origin[3];   // [voxels]
  double slope[3];    // [voxels/m]
  double inverse[3];  // [m/voxel], infinite along an axis that the ray does not follow
  int at[3];          // the voxel
  double range_m;     // where it was entered
  int axis = -1;      // across which it was entered; -1: the ray began here

  Walk(const Ray& ray, const GridGeometry& geometry, double voxels_per_m) : range_m(0.0) {
    for (int a = 0; a < 3; ++a) {
      origin[a] = (ray.origin[a] - geometry.origin_map[a]) * voxels_per_m;
      slope[a] = ray.direction[a] * voxels_per_m;
      inverse[a] = slope[a] != 0.0 ? 1.0 / slope[a] : kInfinity;
    }
  }

  /// [m] to the plane `at` voxels from the grid's lower face; never for a parallel axis
  double crossing(int a, int plane) const {
    return slope[a] != 0.0 ? (plane - origin[a]) * inverse[a] : kInfinity;
  }

  /// Where it leaves the voxels lower <= i < upper. Moves into the voxel behind.
  void leave(const int (&lower)[3], const int (&upper)[3]) {
    int exit = 0;
    double best = kInfinity;
    for (int a = 0; a < 3; ++a) {
      const double t = crossing(a, slope[a] > 0.0 ? upper[a] : lower[a]);
      if (t < best) best = t, exit = a;
    }
    for (int a = 0; a < 3; ++a) {
      if (a == exit) {
        at[a] = slope[a] > 0.0 ? upper[a] : lower[a] - 1;
      } else {
        at[a] = std::clamp(int(std::floor(origin[a] + best * slope[a])), lower[a], upper[a] - 1);
      }
    }
    range_m = std::max(range_m, best);
    axis = exit;
  }

  /// Moves to where the ray enters the grid, if it begins outside. @return whether it meets it
  bool enter(const std::array<int, 3>& size, double most_m) {
    double out = most_m;
    for (int a = 0; a < 3; ++a) {
      const bool inside = origin[a] >= 0.0 && origin[a] < size[std::size_t(a)];
      if (slope[a] == 0.0) {
        if (!inside) return false;
        continue;
      }
      const bool up = slope[a] > 0.0;
      const double in = inside ? 0.0 : crossing(a, up ? 0 : size[std::size_t(a)]);
      if (!inside && in > range_m) range_m = in, axis = a;
      if (!inside && in < 0.0) return false;
      out = std::min(out, crossing(a, up ? size[std::size_t(a)] : 0));
    }
    if (range_m > out) return false;
    for (int a = 0; a < 3; ++a) {
      const int there = int(std::floor(origin[a] + range_m * slope[a]));
      at[a] = std::clamp(there, 0, size[std::size_t(a)] - 1);
      if (a == axis) at[a] = slope[a] > 0.0 ? 0 : size[std::size_t(a)] - 1;
    }
    return true;
  }
};

VoxelWorld::VoxelWorld(const GridGeometry& geometry, const BitGrid& occupied, Boundary boundary)
    : geometry_(geometry), boundary_(boundary), voxels_per_m_(1.0 / geometry.resolution_m) {
  const Index3 n = geometry.size;
  if (!geometry.check() || occupied.size() != n) {
    throw std::invalid_argument("VoxelWorld: the geometry and the voxels disagree");
  }
  size_ = {n.x, n.y, n.z};
  for (std::size_t a = 0; a < 3; ++a) blocks_[a] = std::size_t(size_[a] + 3) / 4;
  fill_masks(occupied);
  fill_distances();
}

void VoxelWorld::fill_masks(const BitGrid& occupied) {
  masks_.assign(blocks_[0] * blocks_[1] * blocks_[2], 0);
  for (int z = 0; z < size_[2]; ++z) {
    for (int y = 0; y < size_[1]; ++y) {
      const BitGrid::Word* row = occupied.row(y, z);
      for (int bx = 0; bx < int(blocks_[0]); ++bx) {
        std::uint64_t four = (row[bx / 16] >> (4 * (bx % 16))) & 15U;
        // Padding bits of a row are no voxels.
        if (4 * bx + 4 > size_[0]) four &= (std::uint64_t{1} << (size_[0] - 4 * bx)) - 1;
        masks_[block_at(bx, y / 4, z / 4)] |= four << (16 * (z & 3) + 4 * (y & 3));
      }
    }
  }
}

// With all 26 neighbours at distance 1, two sweeps give the exact Chebyshev distance
// (Rosenfeld and Pfaltz 1968).
void VoxelWorld::fill_distances() {
  distances_.resize(masks_.size());
  for (std::size_t i = 0; i < masks_.size(); ++i) {
    distances_[i] = std::uint8_t(masks_[i] != 0 ? 0 : kFar);
  }
  spread(true);
  spread(false);
}

void VoxelWorld::spread(bool forward) {
  const int n[3] = {int(blocks_[0]), int(blocks_[1]), int(blocks_[2])};
  const int sign = forward ? -1 : 1;
  const auto nearest_before = [&](int x, int y, int z) {
    int best = kFar;
    // Half of the neighbours: those that this sweep has passed.
    for (int k = 0; k < 13; ++k) {
      const int dx = k % 3 - 1, dy = k / 3 % 3 - 1, dz = k / 9 - 1;
      const int i = x - sign * dx, j = y - sign * dy, l = z - sign * dz;
      const bool inside = i >= 0 && j >= 0 && l >= 0 && i < n[0] && j < n[1] && l < n[2];
      if (inside) best = std::min(best, int(distances_[block_at(i, j, l)]));
    }
    return best;
  };
  for (int k = 0; k < n[2]; ++k) {
    for (int j = 0; j < n[1]; ++j) {
      for (int i = 0; i < n[0]; ++i) {
        const int x = forward ? i : n[0] - 1 - i;
        const int y = forward ? j : n[1] - 1 - j;
        const int z = forward ? k : n[2] - 1 - k;
        auto& distance = distances_[block_at(x, y, z)];
        distance = std::uint8_t(std::min(int(distance), nearest_before(x, y, z) + 1));
      }
    }
  }
}

bool VoxelWorld::occupied(const Walk& walk) const {
  const auto& v = walk.at;
  return (masks_[block_at(v[0] >> 2, v[1] >> 2, v[2] >> 2)] & bit_of(v[0], v[1], v[2])) != 0;
}

void VoxelWorld::cast(std::span<const Ray> rays, std::span<Hit> hits) const {
  for (std::size_t i = 0; i < rays.size(); ++i) {
    Hit hit = cast_one(rays[i]);
    if (boundary_ != Boundary::open) {
      const Hit face = boundary_hit(rays[i]);
      if (face.range_m < hit.range_m) hit = face;
    }
    hits[i] = hit;
  }
}

Hit VoxelWorld::cast_one(const Ray& ray) const {
  Walk walk(ray, geometry_, voxels_per_m_);
  if (!walk.enter(size_, ray.range_m)) return {};
  const auto in_grid = [&] {
    return unsigned(walk.at[0]) < unsigned(size_[0]) && unsigned(walk.at[1]) < unsigned(size_[1]) &&
           unsigned(walk.at[2]) < unsigned(size_[2]);
  };
  while (walk.range_m <= ray.range_m && in_grid()) {
    const int block[3] = {walk.at[0] >> 2, walk.at[1] >> 2, walk.at[2] >> 2};
    const int empty = distances_[block_at(block[0], block[1], block[2])];
    int lower[3], upper[3];
    if (empty > 0) {
      for (int a = 0; a < 3; ++a) {
        lower[a] = 4 * (block[a] - empty + 1);
        upper[a] = 4 * (block[a] + empty);
      }
    } else {
      if (occupied(walk)) {
        const double cosine = walk.axis < 0 ? 1.0 : std::abs(ray.direction[walk.axis]);
        return {walk.range_m, cosine};
      }
      for (int a = 0; a < 3; ++a) lower[a] = walk.at[a], upper[a] = walk.at[a] + 1;
    }
    walk.leave(lower, upper);
  }
  return {};
}

// The faces of the box as seen from inside, or the floor.
Hit VoxelWorld::boundary_hit(const Ray& ray) const {
  const Walk walk(ray, geometry_, voxels_per_m_);
  Hit hit;
  for (int a = boundary_ == Boundary::floor ? 2 : 0; a < 3; ++a) {
    const bool up = walk.slope[a] > 0.0;
    if (up && boundary_ == Boundary::floor) continue;
    const double t = std::max(0.0, walk.crossing(a, up ? size_[std::size_t(a)] : 0));
    if (t <= ray.range_m && t < hit.range_m) hit = {t, std::abs(ray.direction[a])};
  }
  return hit;
}

bool VoxelWorld::contains(const Vec3& point) const {
  const Vec3 g = geometry_.to_grid(point);
  if (boundary_ == Boundary::floor && g.z() < 0.0) return true;
  const auto index = geometry_.index_of(point);
  if (!index) return boundary_ == Boundary::box;
  const std::uint64_t mask = masks_[block_at(index->x >> 2, index->y >> 2, index->z >> 2)];
  return (mask & bit_of(index->x, index->y, index->z)) != 0;
}

}  // namespace goshawk::sensors
