#include "box_expansion.hpp"

#include <algorithm>
#include <cmath>

#include "segment_polytope.hpp"

namespace goshawk::corridor_builder {
namespace {

constexpr int kBits = BitGrid::kWordBits;

bool run_is_free(const BitGrid& occupied, int x0, int x1, int y, int z) {
  const BitGrid::Word* row = occupied.row(y, z);
  for (int w = x0 / kBits; w <= (x1 - 1) / kBits; ++w) {
    BitGrid::Word word = row[w];
    if (w * kBits < x0) word &= ~BitGrid::Word{0} << (x0 - w * kBits);
    if ((w + 1) * kBits > x1) word &= ~BitGrid::Word{0} >> ((w + 1) * kBits - x1);
    if (word != 0) return false;
  }
  return true;
}

bool box_is_free(const BitGrid& occupied, const VoxelBox& box) {
  for (int z = box.lo.z; z < box.hi.z; ++z) {
    for (int y = box.lo.y; y < box.hi.y; ++y) {
      if (!run_is_free(occupied, box.lo.x, box.hi.x, y, z)) return false;
    }
  }
  return true;
}

int& coordinate(Index3& i, int axis) {
  return axis == 0 ? i.x : axis == 1 ? i.y : i.z;
}
int coordinate(const Index3& i, int axis) {
  return axis == 0 ? i.x : axis == 1 ? i.y : i.z;
}

VoxelBox hull(const VoxelBox& box, const Index3& i) {
  return {{std::min(box.lo.x, i.x), std::min(box.lo.y, i.y), std::min(box.lo.z, i.z)},
          {std::max(box.hi.x, i.x + 1), std::max(box.hi.y, i.y + 1), std::max(box.hi.z, i.z + 1)}};
}

bool contains(const VoxelBox& box, const Index3& i) {
  return i.x >= box.lo.x && i.x < box.hi.x && i.y >= box.lo.y && i.y < box.hi.y &&
         i.z >= box.lo.z && i.z < box.hi.z;
}

// One more layer on one side. @return false if it is not free or beyond the limits
bool add_layer(const BitGrid& occupied, int axis, int side, const VoxelBox& limits, VoxelBox& box) {
  VoxelBox layer = box;
  if (side < 0) {
    if (coordinate(box.lo, axis) <= coordinate(limits.lo, axis)) return false;
    coordinate(layer.hi, axis) = coordinate(box.lo, axis);
    coordinate(layer.lo, axis) = coordinate(box.lo, axis) - 1;
  } else {
    if (coordinate(box.hi, axis) >= coordinate(limits.hi, axis)) return false;
    coordinate(layer.lo, axis) = coordinate(box.hi, axis);
    coordinate(layer.hi, axis) = coordinate(box.hi, axis) + 1;
  }
  if (!box_is_free(occupied, layer)) return false;
  if (side < 0) {
    coordinate(box.lo, axis) = coordinate(layer.lo, axis);
  } else {
    coordinate(box.hi, axis) = coordinate(layer.hi, axis);
  }
  return true;
}

// Whole-numbered faces, rounded to the free side.
void planes_of(const VoxelBox& box, const Margins& margins, std::vector<Plane>& planes) {
  planes.clear();
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      Plane plane;
      plane.normal = side * Vec3::Unit(axis);
      plane.offset = side < 0.0 ? 0.0 : coordinate(box.hi, axis) - coordinate(box.lo, axis);
      plane.offset -= 2.0 * margins.rounding;
      planes.push_back(plane);
    }
  }
}

// Where a segment leaves the cube of a voxel that it meets.
Vec3 exit_of(const Index3& voxel, const Vec3& p, const Vec3& q) {
  const Vec3 d = q - p;
  double t = 1.0;
  for (int a = 0; a < 3; ++a) {
    if (std::abs(d[a]) < 1e-12) continue;
    const double face = coordinate(voxel, a) + (d[a] > 0.0 ? 1 : 0);
    t = std::clamp((face - p[a]) / d[a], 0.0, t);
  }
  return p + t * d;
}

}  // namespace

std::optional<Blockage> BoxExpansion::build(const VoxelGrid& grid, std::span<const PathPoint> path,
                                            const Margins& margins, Chain& chain) {
  chain.clear();
  voxels_.clear();
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    if (!walk_.append(grid.grown, path[i].p_grid, path[i + 1].p_grid, voxels_)) {
      const Vec3& p = path[i].p_grid;
      const Vec3 last = voxels_.empty() ? p : exit_of(voxels_.back(), p, path[i + 1].p_grid);
      return Blockage{path[i].segment, last};
    }
  }
  chain.waypoints_map.push_back(path.front().p_map);
  for (std::size_t begin = 0;;) {
    std::size_t end = begin;
    const VoxelBox box = grow(grid, begin, end);
    planes_of(box, margins, planes_);
    to_map(planes_, Vec3(box.lo.x, box.lo.y, box.lo.z), grid.geometry, chain.append());
    if (end + 1 >= voxels_.size()) break;
    chain.waypoints_map.push_back(grid.geometry.center(voxels_[end]));
    begin = end;
  }
  chain.waypoints_map.push_back(path.back().p_map);
  return std::nullopt;
}

// @param end the last voxel of the path, counted on from begin, that is inside
VoxelBox BoxExpansion::grow(const VoxelGrid& grid, std::size_t begin, std::size_t& end) const {
  VoxelBox box = hull({voxels_[begin], voxels_[begin]}, voxels_[begin]);
  for (end = begin; end + 1 < voxels_.size(); ++end) {
    const VoxelBox more = hull(box, voxels_[end + 1]);
    if (!box_is_free(grid.grown, more)) break;
    box = more;
  }
  const int reach = int(std::min(1e6, std::ceil(config_.local_box_m / grid.geometry.resolution_m)));
  const Index3 size = grid.grown.size();
  const VoxelBox limits{
      {std::max(0, box.lo.x - reach), std::max(0, box.lo.y - reach), std::max(0, box.lo.z - reach)},
      {std::min(size.x, box.hi.x + reach), std::min(size.y, box.hi.y + reach),
       std::min(size.z, box.hi.z + reach)}};
  for (bool grew = true; grew;) {
    grew = false;
    for (int axis = 0; axis < 3; ++axis) {
      for (const int side : {-1, 1}) grew |= add_layer(grid.grown, axis, side, limits, box);
    }
  }
  while (end + 1 < voxels_.size() && contains(box, voxels_[end + 1])) ++end;
  return box;
}

}  // namespace goshawk::corridor_builder
