#include "box_growth.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "goshawk/core/line_of_sight.hpp"
#include "segment_polytope.hpp"

namespace goshawk::corridor_builder {
namespace {

constexpr int kBits = BitGrid::kWordBits;
constexpr double kOnFace = 1e-9;  // [voxel edges]

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

bool holds(const Index3& i, const Vec3& p) {
  for (int a = 0; a < 3; ++a) {
    const double x = p[a] - coordinate(i, a);
    if (x < -kOnFace || x > 1.0 + kOnFace) return false;
  }
  return true;
}

bool share_face(const Index3& a, const Index3& b) {
  return std::abs(a.x - b.x) + std::abs(a.y - b.y) + std::abs(a.z - b.z) == 1;
}

VoxelBox hull(const VoxelBox& box, const Index3& i) {
  return {{std::min(box.lo.x, i.x), std::min(box.lo.y, i.y), std::min(box.lo.z, i.z)},
          {std::max(box.hi.x, i.x + 1), std::max(box.hi.y, i.y + 1), std::max(box.hi.z, i.z + 1)}};
}

bool contains(const VoxelBox& box, const Index3& i) {
  return i.x >= box.lo.x && i.x < box.hi.x && i.y >= box.lo.y && i.y < box.hi.y &&
         i.z >= box.lo.z && i.z < box.hi.z;
}

// One more layer on one side. @return false where it is not free or beyond the limits
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
Polytope to_polytope(const VoxelBox& box, const GridGeometry& geometry, const Margins& margins) {
  std::vector<Plane> planes;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      Plane plane;
      plane.normal = side * Vec3::Unit(axis);
      plane.offset = side < 0.0 ? 0.0 : coordinate(box.hi, axis) - coordinate(box.lo, axis);
      plane.offset -= 2.0 * margins.rounding;
      planes.push_back(plane);
    }
  }
  Polytope polytope;
  to_map(planes, Vec3(box.lo.x, box.lo.y, box.lo.z), geometry, polytope);
  return polytope;
}

}  // namespace

std::optional<Blockage> BoxGrowth::build(const VoxelGrid& grid, std::span<const PathPoint> path,
                                         const Margins& margins, Chain& chain) {
  chain.clear();
  voxels_.clear();
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    if (!walk(grid.occupied, path[i].p_grid, path[i + 1].p_grid)) {
      const Vec3 last = voxels_.empty() ? path[i].p_grid
                                        : Vec3(voxels_.back().x + 0.5, voxels_.back().y + 0.5,
                                               voxels_.back().z + 0.5);
      return Blockage{path[i].segment, last};
    }
  }
  chain.joints_map.push_back(path.front().p_map);
  for (std::size_t begin = 0;;) {
    std::size_t end = begin;
    const VoxelBox box = grow(grid, begin, end);
    chain.polytopes.push_back(to_polytope(box, grid.geometry, margins));
    if (end + 1 >= voxels_.size()) break;
    chain.joints_map.push_back(grid.geometry.center(voxels_[end]));
    begin = end;
  }
  chain.joints_map.push_back(path.back().p_map);
  return std::nullopt;
}

// Appends free voxels that the segment meets, from one that holds p to one that holds q. Where
// the way stops, the last voxel that was reached is appended, for the message.
bool BoxGrowth::walk(const BitGrid& occupied, const Vec3& p, const Vec3& q) {
  std::vector<Index3> cells = supercover(p, q);
  std::erase_if(cells, [&](const Index3& i) { return occupied.test(i); });
  return trace(cells, p, q);
}

bool BoxGrowth::trace(const std::vector<Index3>& cells, const Vec3& p, const Vec3& q) {
  parent_.assign(cells.size(), -2);  // -2: not reached, -1: where the search begins
  queue_.clear();
  for (int i = 0; i < int(cells.size()); ++i) {
    const bool begins =
        voxels_.empty() ? holds(cells[std::size_t(i)], p) : cells[std::size_t(i)] == voxels_.back();
    if (!begins) continue;
    parent_[std::size_t(i)] = -1;
    queue_.push_back(i);
  }
  int found = -1;
  for (std::size_t head = 0; head < queue_.size() && found < 0; ++head) {
    const int i = queue_[head];
    if (holds(cells[std::size_t(i)], q)) found = i;
    // The cover lists neighbours near each other: a diagonal step spans at most eight cells, a
    // walk along a face or an edge four abreast.
    const int first = std::max(0, i - 32);
    const int last = std::min(int(cells.size()), i + 33);
    for (int j = first; j < last; ++j) {
      if (parent_[std::size_t(j)] != -2) continue;
      if (!share_face(cells[std::size_t(i)], cells[std::size_t(j)])) continue;
      parent_[std::size_t(j)] = i;
      queue_.push_back(j);
    }
  }
  const bool reached = found >= 0;
  if (!reached && !queue_.empty()) found = queue_.back();
  back_.clear();
  for (int i = found; i >= 0; i = parent_[std::size_t(i)]) back_.push_back(cells[std::size_t(i)]);
  const std::size_t known = voxels_.empty() || back_.empty() ? 0 : 1;
  voxels_.insert(voxels_.end(), back_.rbegin() + std::ptrdiff_t(known), back_.rend());
  return reached;
}

// @param end the last voxel of the path, counted on from begin, that is inside
VoxelBox BoxGrowth::grow(const VoxelGrid& grid, std::size_t begin, std::size_t& end) const {
  VoxelBox box = hull({voxels_[begin], voxels_[begin]}, voxels_[begin]);
  for (end = begin; end + 1 < voxels_.size(); ++end) {
    const VoxelBox more = hull(box, voxels_[end + 1]);
    if (!box_is_free(grid.occupied, more)) break;
    box = more;
  }
  const int reach = int(std::min(1e6, std::ceil(config_.local_box_m / grid.geometry.resolution_m)));
  const Index3 size = grid.occupied.size();
  const VoxelBox limits{
      {std::max(0, box.lo.x - reach), std::max(0, box.lo.y - reach), std::max(0, box.lo.z - reach)},
      {std::min(size.x, box.hi.x + reach), std::min(size.y, box.hi.y + reach),
       std::min(size.z, box.hi.z + reach)}};
  for (bool grew = true; grew;) {
    grew = false;
    for (int axis = 0; axis < 3; ++axis) {
      for (const int side : {-1, 1}) grew |= add_layer(grid.occupied, axis, side, limits, box);
    }
  }
  while (end + 1 < voxels_.size() && contains(box, voxels_[end + 1])) ++end;
  return box;
}

}  // namespace goshawk::corridor_builder
