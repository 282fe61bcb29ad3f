#include "regrow.hpp"

#include <algorithm>
#include <cmath>

#include "goshawk/core/inflation.hpp"
#include "growth.hpp"

namespace goshawk::map_server {
namespace {

using Word = BitGrid::Word;

// Grid words [word0, word0 + ...) of the rows y0..y1, z0..z1: a brick and all that grows into it.
struct Window {
  Index3 lower;  // voxels, lower.x a multiple of 64
  Index3 size;
};

Window window_around(Index3 brick, int reach, Index3 grid) {
  const auto lower = [&](int b, int side) { return std::max(0, b * side - reach); };
  const auto upper = [&](int b, int side, int n) { return std::min(n, (b + 1) * side + reach); };
  const Index3 lo{lower(brick.x, Brick::kSizeX) & ~63, lower(brick.y, Brick::kSizeY),
                  lower(brick.z, Brick::kSizeZ)};
  const int x1 = std::min(grid.x, (upper(brick.x, Brick::kSizeX, grid.x) + 63) & ~63);
  return {lo,
          Index3{x1, upper(brick.y, Brick::kSizeY, grid.y), upper(brick.z, Brick::kSizeZ, grid.z)} -
              lo};
}

BitGrid growing_bits(const VoxelGrid& grid, const Window& window, UnknownPolicy policy) {
  BitGrid local(window.size, true);
  const std::size_t word0 = std::size_t(window.lower.x) / 64;
  for (int z = 0; z < window.size.z; ++z) {
    for (int y = 0; y < window.size.y; ++y) {
      const Word* raw = grid.raw.row(y + window.lower.y, z + window.lower.z) + word0;
      const Word* known = grid.known.row(y + window.lower.y, z + window.lower.z) + word0;
      Word* to = local.mutable_row(y, z);
      for (std::size_t i = 0; i < local.words_per_row(); ++i) {
        to[i] = growing_word(raw[i], known[i], policy);
      }
    }
  }
  return local;
}

}  // namespace

DirtyBricks::DirtyBricks(Index3 grid_size, int reach)
    : size_(grid_size), reach_(reach), marked_(brick_counts(grid_size), false) {}

void DirtyBricks::mark(Index3 voxel, bool grows) {
  const int reach = grows ? reach_ : 0;
  const auto lower = [&](int v, int side) { return std::max(0, v - reach) / side; };
  const auto upper = [&](int v, int side, int n) { return std::min(n - 1, v + reach) / side; };
  const int x1 = upper(voxel.x, Brick::kSizeX, size_.x);
  const int y1 = upper(voxel.y, Brick::kSizeY, size_.y);
  const int z1 = upper(voxel.z, Brick::kSizeZ, size_.z);
  for (int z = lower(voxel.z, Brick::kSizeZ); z <= z1; ++z) {
    for (int y = lower(voxel.y, Brick::kSizeY); y <= y1; ++y) {
      for (int x = lower(voxel.x, Brick::kSizeX); x <= x1; ++x) {
        if (marked_.get({x, y, z})) continue;
        marked_.set({x, y, z}, true);
        bricks_.push_back({x, y, z});
      }
    }
  }
}

const std::vector<Index3>& DirtyBricks::bricks() {
  std::sort(bricks_.begin(), bricks_.end(), [](Index3 a, Index3 b) {
    if (a.z != b.z) return a.z < b.z;
    return a.y != b.y ? a.y < b.y : a.x < b.x;
  });
  return bricks_;
}

int reach_of(const Growth& growth, const GridGeometry& geometry) {
  const int farthest = std::max({geometry.size.x, geometry.size.y, geometry.size.z});
  return int(std::min(std::ceil(growth.inflation_m / geometry.resolution_m), double(farthest)));
}

Brick regrow(const VoxelGrid& grid, const Growth& growth, Index3 index) {
  const GridGeometry& geometry = grid.geometry;
  const Window window = window_around(index, reach_of(growth, geometry), geometry.size);
  const BitGrid local = growing_bits(grid, window, growth.unknown);
  const BitGrid grown = inflate(local, growth.inflation_m, geometry.resolution_m).value();
  const std::size_t word = std::size_t(index.x) - std::size_t(window.lower.x) / 64;

  Brick brick = brick_of(grid, index);
  for (std::size_t at = 0; at < brick.grown.size(); ++at) {
    const int y = index.y * Brick::kSizeY + int(at) % Brick::kSizeY;
    const int z = index.z * Brick::kSizeZ + int(at) / Brick::kSizeY;
    if (y >= geometry.size.y || z >= geometry.size.z) continue;
    const Word bits = grown.row(y - window.lower.y, z - window.lower.z)[word];
    const Word known = grid.known.row(y, z)[index.x];
    brick.grown[at] = finished_word(bits, known, growth.unknown) & bits_inside(index, geometry.size);
  }
  return brick;
}

}  // namespace goshawk::map_server
