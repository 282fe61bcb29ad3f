#include "goshawk/core/free_space.hpp"

#include <algorithm>
#include <bit>
#include <utility>

#include "structuring_element.hpp"

namespace goshawk {
namespace {

using RowWord = BitGrid::Word;

// The first x0 <= x <= x1 whose bit has the value. @pre inside the row
std::optional<int> first_with(const RowWord* row, int x0, int x1, bool value) {
  for (int w = x0 >> 6; w <= x1 >> 6; ++w) {
    RowWord bits = value ? row[w] : ~row[w];
    if (w == x0 >> 6) bits &= ~RowWord{0} << (x0 & 63);
    if (w == x1 >> 6) bits &= ~RowWord{0} >> (63 - (x1 & 63));
    if (bits != 0) return 64 * w + std::countr_zero(bits);
  }
  return {};
}

}  // namespace

void FreeSpace::set_map(std::shared_ptr<const VoxelGrid> grid) {
  grid_ = std::move(grid);
  asks_for_known_ =
      grid_ != nullptr && !fly_unknown_ && !grid_->unknown_is_occupied && !grid_->known.empty();
  if (!asks_for_known_) return;
  const double voxels = grid_->inflation_m / grid_->geometry.resolution_m;
  const Index3 size = grid_->geometry.size;
  if (voxels == body_voxels_ && size == body_size_) return;
  body_voxels_ = voxels;
  body_size_ = size;
  body_.clear();
  if (!(voxels > 0.0)) return body_.push_back({0, 0, 0});
  for (const ElementRow& row : structuring_element(voxels, size)) {
    body_.push_back({row.dy, row.dz, row.half_extent});
  }
}

bool FreeSpace::is_free(Index3 voxel) const {
  return grid_->grown.contains(voxel) && !first_blocked(view(), voxel.x, voxel.x, voxel.y, voxel.z);
}

std::optional<Index3> first_blocked(const FreeSpace::View& space, int x0, int x1, int y, int z) {
  const VoxelGrid& grid = *space.grid;
  if (const auto x = first_with(grid.grown.row(y, z), x0, x1, true)) return Index3{*x, y, z};
  const Index3 size = grid.geometry.size;
  std::optional<int> first;
  for (const FreeSpace::Row& row : space.body) {
    const int at_y = y + row.dy, at_z = z + row.dz;
    if (at_y < 0 || at_z < 0 || at_y >= size.y || at_z >= size.z) continue;
    const int from = std::max(0, x0 - row.half_extent);
    const int to = std::min(size.x - 1, x1 + row.half_extent);
    const auto unseen = first_with(grid.known.row(at_y, at_z), from, to, false);
    if (!unseen) continue;
    const int x = std::max(x0, *unseen - row.half_extent);
    if (!first || x < *first) first = x;
  }
  if (!first) return {};
  return Index3{*first, y, z};
}

}  // namespace goshawk
