#include "goshawk/viewer_bridge/octomap_voxels.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace goshawk::viewer_bridge {
namespace {

constexpr int kHalfTree = 32768;  // voxels from the middle of a tree to its sides
constexpr double kMostVoxels = 3e8;

struct Leaf {
  Index3 lower;
  int edge = 0;  // [voxel]
};

/// Reads one node after another; a node has at most eight children and sixteen levels.
class Reader {
 public:
  explicit Reader(std::span<const std::uint8_t> data) : data_(data) {}

  bool read(Index3 lower, int edge) {
    if (at_ + 2 > data_.size() || edge < 2) return false;
    const unsigned bits = data_[at_] | unsigned(data_[at_ + 1]) << 8U;
    at_ += 2;
    const int half = edge / 2;
    Index3 inner[8];
    int count = 0;
    for (int k = 0; k < 8; ++k) {
      const unsigned kind = bits >> (2 * k) & 3U;  // 0 unknown, 1 free, 2 occupied, 3 has children
      if (kind == 0) continue;
      const Index3 p{lower.x + (k & 1) * half, lower.y + (k >> 1 & 1) * half,
                     lower.z + (k >> 2) * half};
      if (kind == 3) {
        inner[count++] = p;
        continue;
      }
      widen(p, half);
      if (kind == 2) leaves.push_back({p, half});
    }
    for (int k = 0; k < count; ++k) {
      if (!read(inner[k], half)) return false;
    }
    return true;
  }

  std::vector<Leaf> leaves;
  Index3 low{kHalfTree, kHalfTree, kHalfTree};
  Index3 high{-kHalfTree, -kHalfTree, -kHalfTree};

 private:
  void widen(Index3 p, int edge) {
    low = {std::min(low.x, p.x), std::min(low.y, p.y), std::min(low.z, p.z)};
    high = {std::max(high.x, p.x + edge), std::max(high.y, p.y + edge),
            std::max(high.z, p.z + edge)};
  }

  std::span<const std::uint8_t> data_;
  std::size_t at_ = 0;
};

}  // namespace

Result<VoxelGrid> octomap_voxels(std::span<const std::uint8_t> data, double resolution_m) {
  if (!(resolution_m > 0.0) || !std::isfinite(resolution_m)) {
    return fail(ErrorCode::invalid_input, "an octomap's resolution must be above 0");
  }
  if (data.empty()) return fail(ErrorCode::map_empty, "the octomap is empty");
  Reader reader(data);
  if (!reader.read({-kHalfTree, -kHalfTree, -kHalfTree}, 2 * kHalfTree)) {
    return fail(ErrorCode::invalid_input, "the octomap is cut off, or no tree");
  }
  const Index3 size{reader.high.x - reader.low.x, reader.high.y - reader.low.y,
                    reader.high.z - reader.low.z};
  if (size.x <= 0) return fail(ErrorCode::map_empty, "the octomap knows no voxel");
  if (double(size.x) * size.y * size.z > kMostVoxels) {
    return fail(ErrorCode::map_too_large, "the octomap has more voxels than can be drawn");
  }
  VoxelGrid grid;
  grid.geometry = {resolution_m * Vec3(reader.low.x, reader.low.y, reader.low.z), resolution_m,
                   size};
  grid.grown = BitGrid(size, false);
  for (const Leaf& leaf : reader.leaves) {
    const Index3 p{leaf.lower.x - reader.low.x, leaf.lower.y - reader.low.y,
                   leaf.lower.z - reader.low.z};
    for (int z = p.z; z < p.z + leaf.edge; ++z) {
      for (int y = p.y; y < p.y + leaf.edge; ++y) {
        grid.grown.set_run(p.x, p.x + leaf.edge, y, z, true);
      }
    }
  }
  return grid;
}

}  // namespace goshawk::viewer_bridge
