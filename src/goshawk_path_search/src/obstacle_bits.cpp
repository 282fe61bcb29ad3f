#include "goshawk/path_search/obstacle_bits.hpp"

#include <algorithm>
#include <bit>
#include <limits>

namespace goshawk::path_search {
namespace {

// 64 bits from position p on, of which the lowest 57 are good.
std::uint64_t ahead(const char* bytes, std::int64_t p) {
  std::uint64_t word;
  std::memcpy(&word, bytes + (p >> 3), sizeof word);
  return word >> (p & 7);
}

// 64 bits up to position p, which becomes bit 63; the highest 57 are good.
std::uint64_t behind(const char* bytes, std::int64_t p) {
  std::uint64_t word;
  std::memcpy(&word, bytes + (p >> 3) - 7, sizeof word);
  return word << (7 - (p & 7));
}

// The eight rows around a scanned one, and the scanned one itself.
struct Rows {
  std::uint64_t own;
  std::uint64_t side[4];    // share a face with the own row
  std::uint64_t corner[4];  // corner k lies between sides k and (k + 1) % 4
};

// Voxels at which a forced neighbour may exist. `next` gives each voxel the bit of the voxel
// ahead of it, `last` that of the voxel before.
template <typename Next, typename Last>
std::uint64_t forced(CornerRule rule, const Rows& r, Next next, Last last) {
  std::uint64_t found = 0;
  if (rule == CornerRule::squeeze) {
    // A blocked voxel beside, a free one ahead of that.
    for (const std::uint64_t n : r.side) found |= n & ~next(n);
    for (const std::uint64_t n : r.corner) found |= n & ~next(n);
    return found;
  }
  // A free voxel beside, a blocked one before that.
  for (const std::uint64_t n : r.side) found |= last(n) & ~n;
  // Past the end of a single edge, only the triagonal move is new: its whole box must be free.
  for (int k = 0; k < 4; ++k) {
    const std::uint64_t here = r.side[k] | r.side[(k + 1) % 4] | r.corner[k];
    found |= last(r.corner[k]) & ~(here | next(here) | next(r.own));
  }
  return found;
}

}  // namespace

std::int64_t ObstacleBits::nodes_for(Index3 size) {
  const std::int64_t row = std::int64_t{size.x} + 1, rows = std::int64_t{size.y} + 2;
  const std::int64_t layers = std::int64_t{size.z} + 2;
  // Each factor is below 2^32, so that no product overflows before it is compared.
  if (row * rows > kMaxNodes || row * rows * layers + row + 2 > kMaxNodes) return 0;
  return row * rows * layers + row + 2;
}

void ObstacleBits::resize(Index3 size) {
  size_ = size;
  held_ = BitGrid(size, true, false);
  clear(axes_[0], size.x, size.y, size.z);
  clear(axes_[1], size.y, size.x, size.z);
  clear(axes_[2], size.z, size.x, size.y);
  for (int d = 0; d < kDirections; ++d) {
    const Index3 s = step_of(d);
    offsets_[std::size_t(d)] = s.x + axes_[0].stride_u * s.y + axes_[0].stride_v * s.z;
  }
  rows_per_layer_ = std::uint64_t(size.y) + 2;
  const auto magic = [](std::uint64_t d) {
    return std::numeric_limits<std::uint64_t>::max() / d + 1;
  };
  row_magic_ = magic(std::uint64_t(axes_[0].stride_u));
  layer_magic_ = magic(rows_per_layer_);
}

// All blocked, then the inside free.
void ObstacleBits::clear(Copy& copy, int u_size, int v_size, int w_size) {
  copy.stride_u = std::int64_t{u_size} + 1;
  copy.stride_v = copy.stride_u * (std::int64_t{v_size} + 2);
  const std::int64_t bits = copy.stride_v * (std::int64_t{w_size} + 2) + copy.stride_u + 2;
  copy.words.assign(std::size_t(bits / 64) + 4, ~std::uint64_t{0});
  for (int w = 0; w < w_size; ++w) {
    for (int v = 0; v < v_size; ++v) {
      std::int64_t p = position(copy, 0, v, w);
      for (std::int64_t left = u_size; left > 0;) {
        const std::int64_t shift = p & 63, count = std::min(left, 64 - shift);
        const std::uint64_t ones = ~std::uint64_t{0} >> (64 - count);
        copy.words[std::size_t(p >> 6) + 1] &= ~(ones << shift);
        p += count;
        left -= count;
      }
    }
  }
}

bool ObstacleBits::assign(const BitGrid& blocked) {
  bool changed = !(blocked.size() == size_);
  if (changed) resize(blocked.size());
  for_changed_chunks(held_, blocked, [&](BitGrid::Rows rows) {
    for (int z = rows.z0; z < rows.z1; ++z) {
      for (int y = rows.y0; y < rows.y1; ++y) changed |= assign_row(blocked, y, z);
    }
  });
  held_ = blocked;
  return changed;
}

bool ObstacleBits::assign_row(const BitGrid& blocked, int y, int z) {
  const std::uint64_t* before = held_.row(y, z);
  const std::uint64_t* after = blocked.row(y, z);
  bool changed = false;
  for (int x0 = 0; x0 < size_.x; x0 += 64) {
    std::uint64_t changes = before[x0 >> 6] ^ after[x0 >> 6];
    if (size_.x - x0 < 64) changes &= ~std::uint64_t{0} >> (64 - (size_.x - x0));
    if (changes != 0) apply_changes(changes, x0, y, z);
    changed |= changes != 0;
  }
  return changed;
}

void ObstacleBits::apply_changes(std::uint64_t changes, int x0, int y, int z) {
  for (; changes != 0; changes &= changes - 1) {
    const int x = x0 + std::countr_zero(changes);
    flip(axes_[0], position(axes_[0], x, y, z));
    flip(axes_[1], position(axes_[1], y, x, z));
    flip(axes_[2], position(axes_[2], z, x, y));
  }
}

int ObstacleBits::straight_jump(CornerRule rule, int axis, int sign, Index3 from) const {
  const Copy& copy = axes_[std::size_t(axis)];
  const int u = axis == 0 ? from.x : axis == 1 ? from.y : from.z;
  const int v = axis == 0 ? from.y : from.x;
  const int w = axis == 2 ? from.y : from.z;
  const std::int64_t p = position(copy, u, v, w);
  const std::int64_t a = copy.stride_u, b = copy.stride_v;
  const std::int64_t side[4] = {a, b, -a, -b};
  const std::int64_t corner[4] = {a + b, b - a, -a - b, a - b};
  const char* bytes = copy.bytes();
  const auto load = [&](auto window) {
    Rows rows;
    rows.own = window(bytes, p);
    for (int k = 0; k < 4; ++k) {
      rows.side[k] = window(bytes, p + side[k]);
      rows.corner[k] = window(bytes, p + corner[k]);
    }
    return rows;
  };
  const auto up = [](std::uint64_t x) { return x << 1; };
  const auto down = [](std::uint64_t x) { return x >> 1; };
  constexpr int kLast = kWindow - 2;  // the voxel ahead of it is still in the window
  if (sign > 0) {
    const Rows rows = load(ahead);
    const std::uint64_t stop =
        (forced(rule, rows, down, up) | rows.own | std::uint64_t{1} << kLast) & ~std::uint64_t{1};
    const int steps = std::countr_zero(stop);
    return (rows.own >> steps & 1U) != 0 ? 1 - steps : steps;
  }
  const Rows rows = load(behind);
  const std::uint64_t top = std::uint64_t{1} << 63;
  const std::uint64_t stop = (forced(rule, rows, up, down) | rows.own | top >> kLast) & ~top;
  const int steps = std::countl_zero(stop);
  return (rows.own << steps & top) != 0 ? 1 - steps : steps;
}

}  // namespace goshawk::path_search
