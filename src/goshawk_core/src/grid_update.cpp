#include "goshawk/core/grid_update.hpp"

#include <algorithm>

namespace goshawk {
namespace {

bool inside(Index3 i, Index3 n) {
  return i.x >= 0 && i.y >= 0 && i.z >= 0 && i.x < n.x && i.y < n.y && i.z < n.z;
}

// Bits beyond the end of a row belong to the grid, not to the brick.
BitGrid::Word valid_bits(Index3 brick, Index3 size) {
  const int used = std::min(size.x - brick.x * Brick::kSizeX, Brick::kSizeX);
  return used == 64 ? ~BitGrid::Word{0} : (BitGrid::Word{1} << used) - 1;
}

void write(BitGrid& bits, Index3 brick, const Brick::Words& words) {
  const Index3 size = bits.size();
  const BitGrid::Word valid = valid_bits(brick, size);
  const int z1 = std::min((brick.z + 1) * Brick::kSizeZ, size.z);
  const int y1 = std::min((brick.y + 1) * Brick::kSizeY, size.y);
  for (int z = brick.z * Brick::kSizeZ; z < z1; ++z) {
    for (int y = brick.y * Brick::kSizeY; y < y1; ++y) {
      BitGrid::Word& word = bits.mutable_row(y, z)[brick.x];
      const std::size_t at = std::size_t(Brick::kSizeY * (z % Brick::kSizeZ) + y % Brick::kSizeY);
      word = (word & ~valid) | (words[at] & valid);
    }
  }
}

}  // namespace

Index3 brick_counts(Index3 n) {
  return {(n.x - 1) / Brick::kSizeX + 1, (n.y - 1) / Brick::kSizeY + 1,
          (n.z - 1) / Brick::kSizeZ + 1};
}

Status apply(VoxelGrid& grid, const GridUpdate& update) {
  if (grid.version != update.from_version) {
    return fail(ErrorCode::invalid_input,
                "an update from map version " + std::to_string(update.from_version) +
                    " does not fit the version " + std::to_string(grid.version) +
                    " that is here: wait for the whole map");
  }
  if (auto status = grid.check(); !status) return status;
  if (grid.known.empty()) {
    return fail(ErrorCode::invalid_input, "an update needs a map with known bits");
  }
  const Index3 counts = brick_counts(grid.geometry.size);
  for (const Brick& brick : update.bricks) {
    if (!inside(brick.index, counts)) {
      return fail(ErrorCode::invalid_input, "the brick " + to_text(brick.index) +
                                                " of an update lies outside the map's " +
                                                to_text(counts) + " bricks");
    }
  }
  for (const Brick& brick : update.bricks) {
    write(grid.occupied, brick.index, brick.occupied);
    write(grid.known, brick.index, brick.known);
  }
  grid.version = update.to_version;
  return success();
}

}  // namespace goshawk
