#include "goshawk/core/grid_update.hpp"

#include <fmt/format.h>

#include <algorithm>

namespace goshawk {
namespace {

using Word = BitGrid::Word;

bool inside(Index3 i, Index3 n) {
  return i.x >= 0 && i.y >= 0 && i.z >= 0 && i.x < n.x && i.y < n.y && i.z < n.z;
}

// visit(number of the brick's word, y, z) for each row of the brick that the grid has
template <typename Visit>
void for_rows(Index3 brick, Index3 size, Visit&& visit) {
  const int y0 = brick.y * Brick::kSizeY, z0 = brick.z * Brick::kSizeZ;
  const int ys = std::min(Brick::kSizeY, size.y - y0), zs = std::min(Brick::kSizeZ, size.z - z0);
  for (int z = 0; z < zs; ++z) {
    for (int y = 0; y < ys; ++y) visit(std::size_t(Brick::kSizeY * z + y), y0 + y, z0 + z);
  }
}

Brick::Words read(const BitGrid& bits, Index3 brick) {
  const Word valid = bits_inside(brick, bits.size());
  Brick::Words words{};
  for_rows(brick, bits.size(),
           [&](std::size_t at, int y, int z) { words[at] = bits.row(y, z)[brick.x] & valid; });
  return words;
}

// A word that stays is not written: its chunk need not be cloned.
void write(BitGrid& bits, Index3 brick, const Brick::Words& words) {
  const Word valid = bits_inside(brick, bits.size());
  for_rows(brick, bits.size(), [&](std::size_t at, int y, int z) {
    const Word held = bits.row(y, z)[brick.x];
    const Word word = (held & ~valid) | (words[at] & valid);
    if (word != held) bits.mutable_row(y, z)[brick.x] = word;
  });
}

Vec3 moved_origin(const GridGeometry& geometry, Index3 bricks) {
  const Vec3 voxels(double(bricks.x) * Brick::kSizeX, double(bricks.y) * Brick::kSizeY,
                    double(bricks.z) * Brick::kSizeZ);
  return geometry.origin_map + geometry.resolution_m * voxels;
}

Status check_brick(const Brick& brick, const VoxelGrid& grid, Index3 counts) {
  if (!inside(brick.index, counts)) {
    return fail(ErrorCode::invalid_input,
                fmt::format("the brick {} of an update lies outside the map's {} bricks",
                            to_text(brick.index), to_text(counts)));
  }
  if (!grid.raw.empty() && !brick.raw) {
    return fail(ErrorCode::invalid_input,
                fmt::format("the brick {} of an update brings no raw voxels, but the map has them: "
                            "wait for the whole map",
                            to_text(brick.index)));
  }
  return success();
}

Status check(const VoxelGrid& grid, const GridUpdate& update) {
  if (grid.version != update.from_version) {
    return fail(ErrorCode::invalid_input,
                fmt::format("an update from map version {} does not fit version {}, which is here: "
                            "wait for the whole map",
                            update.from_version, grid.version));
  }
  if (auto status = grid.check(); !status) return status;
  if (grid.known.empty()) {
    return fail(ErrorCode::invalid_input, "an update needs a map with known bits");
  }
  if (!is_finite(moved_origin(grid.geometry, update.shift))) {
    return fail(ErrorCode::invalid_input, "an update moves the map's window beyond all numbers");
  }
  const Index3 counts = brick_counts(grid.geometry.size);
  for (const Brick& brick : update.bricks) {
    if (auto status = check_brick(brick, grid, counts); !status) return status;
  }
  return success();
}

void shift(VoxelGrid& grid, Index3 bricks) {
  if (bricks == Index3{}) return;
  grid.geometry.origin_map = moved_origin(grid.geometry, bricks);
  grid.grown = grid.grown.shifted(bricks, grid.unknown_is_occupied);
  grid.known = grid.known.shifted(bricks, false);
  if (!grid.raw.empty()) grid.raw = grid.raw.shifted(bricks, false);
}

}  // namespace

Index3 brick_counts(Index3 n) {
  return {(n.x - 1) / Brick::kSizeX + 1, (n.y - 1) / Brick::kSizeY + 1,
          (n.z - 1) / Brick::kSizeZ + 1};
}

// Bits beyond the end of a row belong to the grid, not to the brick.
Word bits_inside(Index3 brick, Index3 size) {
  const int used = std::min(size.x - brick.x * Brick::kSizeX, Brick::kSizeX);
  return used == 64 ? ~Word{0} : (Word{1} << used) - 1;
}

Brick brick_of(const VoxelGrid& grid, Index3 index) {
  Brick brick;
  brick.index = index;
  brick.grown = read(grid.grown, index);
  brick.known = read(grid.known, index);
  if (!grid.raw.empty()) brick.raw = read(grid.raw, index);
  return brick;
}

Status apply(VoxelGrid& grid, const GridUpdate& update) {
  if (auto status = check(grid, update); !status) return status;
  shift(grid, update.shift);
  for (const Brick& brick : update.bricks) {
    write(grid.grown, brick.index, brick.grown);
    write(grid.known, brick.index, brick.known);
    if (!grid.raw.empty()) write(grid.raw, brick.index, *brick.raw);
  }
  grid.version = update.to_version;
  return success();
}

}  // namespace goshawk
