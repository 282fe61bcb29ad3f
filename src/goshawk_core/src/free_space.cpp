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

// The first voxel of the row that the body cannot be in, as one of its rows says.
// @param value of the bits that keep it out
std::optional<int> first_kept_out(const FreeSpace::View& space, const BitGrid& bits, bool value,
                                  int x0, int x1, int y, int z) {
  const Index3 size = space.grid->geometry.size;
  std::optional<int> first;
  for (const FreeSpace::Row& row : space.body) {
    const int at_y = y + row.dy, at_z = z + row.dz;
    if (at_y < 0 || at_z < 0 || at_y >= size.y || at_z >= size.z) continue;
    const int from = std::max(0, x0 - row.half_extent);
    const int to = std::min(size.x - 1, x1 + row.half_extent);
    const auto found = first_with(bits.row(at_y, at_z), from, to, value);
    if (!found) continue;
    const int x = std::max(x0, *found - row.half_extent);
    if (!first || x < *first) first = x;
  }
  return first;
}

}  // namespace

void FreeSpace::set_map(std::shared_ptr<const VoxelGrid> grid) {
  grid_ = std::move(grid);
  const bool lax = grid_ != nullptr && !grid_->unknown_is_occupied;
  asks_for_known_ = lax && !fly_unknown_ && !grid_->known.empty();
  asks_for_raw_ = lax && !grid_->raw.empty();
  if (!asks_for_known_ && !asks_for_raw_) {
    body_.clear();
    body_voxels_ = -1.0;
    return;
  }
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
  auto first = first_with(grid.grown.row(y, z), x0, x1, true);
  // What is raw within the inflation is grown: the rest of the row has nothing near.
  if (first && space.asks_for_raw) first = first_kept_out(space, grid.raw, true, *first, x1, y, z);
  if (!first && space.asks_for_known) {
    first = first_kept_out(space, grid.known, false, x0, x1, y, z);
  }
  if (!first) return {};
  return Index3{*first, y, z};
}

}  // namespace goshawk
