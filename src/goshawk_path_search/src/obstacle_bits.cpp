#include "goshawk/path_search/obstacle_bits.hpp"

#include <algorithm>
#include <bit>
#include <limits>

namespace goshawk::path_search {
namespace {

// So many changed voxels, at most one in this many words of the map, are forgotten one by one.
constexpr std::int64_t kWordsAChange = 64;

// Of the words that say where jumps stop: they begin 64 bits before the copy, for a window that
// ends near its beginning.
std::size_t stop_word(std::int64_t position) {
  return std::size_t((position >> 6) + 1);
}

// 64 voxels of the nine rows around and with a scanned one, and of the same rows one voxel on.
struct Rows {
  std::uint64_t own;
  std::uint64_t side[4];    // share a face with the own row
  std::uint64_t corner[4];  // corner k lies between sides k and (k + 1) % 4
};

// Voxels at which a forced neighbour may exist, by the rows here, before and after in the
// direction of the jump.
std::uint64_t forced(CornerRule rule, const Rows& last, const Rows& here, const Rows& next) {
  std::uint64_t found = 0;
  for (int k = 0; k < 4; ++k) {
    if (rule == CornerRule::squeeze) {
      // A blocked voxel beside, a free one ahead of that.
      found |= here.side[k] & ~next.side[k];
      found |= here.corner[k] & ~next.corner[k];
      continue;
    }
    // A free voxel beside, a blocked one before that.
    found |= last.side[k] & ~here.side[k];
    // Past the end of a single edge, only the triagonal move is new: its whole box must be free.
    const int l = (k + 1) % 4;
    found |= last.corner[k] & ~(here.side[k] | here.side[l] | here.corner[k] | next.side[k] |
                                next.side[l] | next.corner[k] | next.own);
  }
  return found;
}

template <typename Copy>
Rows rows_at(const Copy& copy, std::int64_t p) {
  const std::int64_t a = copy.stride_u, b = copy.stride_v;
  return {copy.from(p),
          {copy.from(p + a), copy.from(p + b), copy.from(p - a), copy.from(p - b)},
          {copy.from(p + a + b), copy.from(p + b - a), copy.from(p - a - b), copy.from(p + a - b)}};
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
  copy.words.assign(std::size_t(bits / 64) + 2 * kSpare + 1, ~std::uint64_t{0});
  copy.ahead.resize(std::size_t(bits / 64) + 4);
  copy.behind.resize(std::size_t(bits / 64) + 4);
  for (int w = 0; w < w_size; ++w) {
    for (int v = 0; v < v_size; ++v) {
      std::int64_t p = position(copy, 0, v, w);
      for (std::int64_t left = u_size; left > 0;) {
        const std::int64_t shift = p & 63, count = std::min(left, 64 - shift);
        const std::uint64_t ones = ~std::uint64_t{0} >> (64 - count);
        copy.words[std::size_t(p >> 6) + kSpare] &= ~(ones << shift);
        p += count;
        left -= count;
      }
    }
  }
}

bool ObstacleBits::assign(const BitGrid& blocked) {
  bool changed = !(blocked.size() == size_);
  if (changed) resize(blocked.size());
  changes_ = 0;
  for_changed_chunks(held_, blocked, [&](BitGrid::Rows rows) {
    for (int z = rows.z0; z < rows.z1; ++z) {
      for (int y = rows.y0; y < rows.y1; ++y) changed |= assign_row(blocked, y, z);
    }
  });
  if (changes_ * kWordsAChange > std::int64_t(axes_[0].words.size())) forget_derived();
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
    if (++changes_ * kWordsAChange > std::int64_t(axes_[0].words.size())) continue;
    forget_around(axes_[0], position(axes_[0], x, y, z));
    forget_around(axes_[1], position(axes_[1], y, x, z));
    forget_around(axes_[2], position(axes_[2], z, x, y));
  }
}

// What depends on the voxel at p: two words at most of each of the nine rows around it.
void ObstacleBits::forget_around(Copy& copy, std::int64_t p) {
  for (const std::int64_t v : {-copy.stride_v, std::int64_t{0}, copy.stride_v}) {
    for (const std::int64_t u : {-copy.stride_u, std::int64_t{0}, copy.stride_u}) {
      const std::int64_t row = p + v + u;
      for (const std::int64_t q : {row - 1, row + 1}) {
        copy.ahead.forget(stop_word(q));
        copy.behind.forget(stop_word(q));
      }
    }
  }
}

void ObstacleBits::forget_derived() {
  for (Copy& copy : axes_) {
    copy.ahead.forget_all();
    copy.behind.forget_all();
  }
}

void ObstacleBits::populate_jumps() {
  for (Copy& copy : axes_) {
    copy.ahead.populate();
    copy.behind.populate();
  }
}

void ObstacleBits::find_stops(Copy& copy, std::size_t word) {
  const std::int64_t p = (std::int64_t(word) - 1) * 64;
  const Rows before = rows_at(copy, p - 1), here = rows_at(copy, p), after = rows_at(copy, p + 1);
  copy.ahead.set(word, here.own | forced(rule_, before, here, after));
  copy.behind.set(word, here.own | forced(rule_, after, here, before));
}

int ObstacleBits::straight_jump(CornerRule rule, int axis, int sign, Index3 from) {
  if (rule != rule_) {
    rule_ = rule;
    forget_derived();
  }
  Copy& copy = axes_[std::size_t(axis)];
  const int u = axis == 0 ? from.x : axis == 1 ? from.y : from.z;
  const int v = axis == 0 ? from.y : from.x;
  const int w = axis == 2 ? from.y : from.z;
  const std::int64_t p = position(copy, u, v, w);
  // The window begins, or ends, at the voxel itself.
  const std::int64_t low = sign > 0 ? p : p - 63;
  const std::size_t first = stop_word(low);
  const int shift = int(low & 63);
  const auto stops = [&](const LazyWords& words, std::size_t word) {
    if (!words.is_known(word)) find_stops(copy, word);
    return words[word];
  };
  const LazyWords& words = sign > 0 ? copy.ahead : copy.behind;
  std::uint64_t window = stops(words, first) >> shift;
  if (shift != 0) window |= stops(words, first + 1) << (64 - shift);
  constexpr std::uint64_t kTop = std::uint64_t{1} << 63;
  const int steps = sign > 0 ? std::countr_zero((window & ~std::uint64_t{1}) | kTop)
                             : std::countl_zero((window & ~kTop) | 1U);
  return get(copy, p + sign * steps) ? 1 - steps : steps;
}

}  // namespace goshawk::path_search
