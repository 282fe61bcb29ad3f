#include "voxel_walk.hpp"

#include <algorithm>
#include <cstdlib>

#include "goshawk/core/line_of_sight.hpp"

namespace goshawk::corridor_builder {
namespace {

constexpr double kOnFace = 1e-9;  // [voxel edges]

bool share_face(const Index3& a, const Index3& b) {
  return std::abs(a.x - b.x) + std::abs(a.y - b.y) + std::abs(a.z - b.z) == 1;
}

}  // namespace

bool holds(const Index3& i, const Vec3& p) {
  const Vec3 inside = p - Vec3(i.x, i.y, i.z);
  return (inside.array() >= -kOnFace).all() && (inside.array() <= 1.0 + kOnFace).all();
}

bool VoxelWalk::append(const BitGrid& occupied, const Vec3& p, const Vec3& q,
                       std::vector<Index3>& voxels) {
  supercover(p, q, cells_);
  std::erase_if(cells_, [&](const Index3& i) { return occupied.test(i); });
  return trace(p, q, voxels);
}

bool VoxelWalk::trace(const Vec3& p, const Vec3& q, std::vector<Index3>& voxels) {
  parent_.assign(cells_.size(), -2);  // -2: not reached, -1: where the search begins
  queue_.clear();
  for (int i = 0; i < int(cells_.size()); ++i) {
    const bool begins =
        voxels.empty() ? holds(cells_[std::size_t(i)], p) : cells_[std::size_t(i)] == voxels.back();
    if (!begins) continue;
    parent_[std::size_t(i)] = -1;
    queue_.push_back(i);
  }
  int found = -1;
  for (std::size_t head = 0; head < queue_.size() && found < 0; ++head) {
    const int i = queue_[head];
    if (holds(cells_[std::size_t(i)], q)) found = i;
    // The cover lists neighbours near each other: a diagonal step spans at most eight cells, a
    // walk along a face or an edge four abreast.
    const int first = std::max(0, i - 32);
    const int last = std::min(int(cells_.size()), i + 33);
    for (int j = first; j < last; ++j) {
      if (parent_[std::size_t(j)] != -2) continue;
      if (!share_face(cells_[std::size_t(i)], cells_[std::size_t(j)])) continue;
      parent_[std::size_t(j)] = i;
      queue_.push_back(j);
    }
  }
  const bool reached = found >= 0;
  if (!reached && !queue_.empty()) found = queue_.back();
  back_.clear();
  for (int i = found; i >= 0; i = parent_[std::size_t(i)]) back_.push_back(cells_[std::size_t(i)]);
  const std::size_t known = voxels.empty() || back_.empty() ? 0 : 1;
  voxels.insert(voxels.end(), back_.rbegin() + std::ptrdiff_t(known), back_.rend());
  return reached;
}

}  // namespace goshawk::corridor_builder
