#include "goshawk/core/brick_map.hpp"

#include <algorithm>
#include <bit>
#include <stdexcept>

#include "goshawk/core/inflation.hpp"
#include "structuring_element.hpp"

namespace goshawk {
namespace {

using Word = BrickMap::Word;

// The rows y0 <= y <= y1, z0 <= z <= z1 of a brick; the numbers may lie beyond it.
std::uint64_t rows_mask(int y0, int y1, int z0, int z1) {
  const auto ones = [](int a, int b) {  // bits a .. b of 0 .. 7
    return (0xFFU >> (7 - std::min(b, 7))) & (0xFFU << std::max(a, 0)) & 0xFFU;
  };
  std::uint64_t rows = 0;
  const std::uint64_t ys = ones(y0, y1);
  for (int z = std::max(z0, 0); z <= std::min(z1, 7); ++z) rows |= ys << (8 * z);
  return rows;
}

// visit(index) for each brick of a window
template <typename Visit>
void for_bricks(Index3 counts, Visit&& visit) {
  for (int z = 0; z < counts.z; ++z) {
    for (int y = 0; y < counts.y; ++y) {
      for (int x = 0; x < counts.x; ++x) visit(Index3{x, y, z});
    }
  }
}

int words_reached(int voxels, int side) {
  return (voxels + side - 1) / side;
}

// out |= in shifted by `shift` > 0 voxels towards larger x, and towards smaller x
void or_both_ways(Word* out, const Word* in, int words, int shift) {
  const int skip = shift / 64, bits = shift % 64;
  for (int i = 0; i + skip < words; ++i) {
    Word up = in[i] << bits, down = in[i + skip] >> bits;
    if (bits != 0 && i > 0) up |= in[i - 1] >> (64 - bits);
    if (bits != 0 && i + skip + 1 < words) down |= in[i + skip + 1] << (64 - bits);
    out[i + skip] |= up;
    out[i] |= down;
  }
}

}  // namespace

Result<BrickMap> BrickMap::make(Index3 size, const BrickGrowth& growth) {
  if (auto status = BitGrid::check_size(size); !status) return status.error();
  // The same words for a growth that is not allowed as inflate() has.
  const auto allowed = inflate(BitGrid({1, 1, 1}, true), growth.inflation_m, growth.resolution_m);
  if (!allowed) return allowed.error();
  return BrickMap(size, growth);
}

BrickMap::BrickMap(Index3 size, const BrickGrowth& growth)
    : size_(size), counts_(brick_counts(size)), growth_(growth) {
  if (growth.inflation_m > 0.0) {
    for (const ElementRow& row :
         structuring_element(growth.inflation_m / growth.resolution_m, size)) {
      element_.push_back({row.dy, row.dz, row.half_extent});
      reach_ = {std::max(reach_.x, row.half_extent), std::max(reach_.y, row.dy),
                std::max(reach_.z, row.dz)};
    }
  } else {
    element_.push_back({0, 0, 0});
  }
  side_words_ = words_reached(reach_.x, Brick::kSizeX);
  const std::size_t bricks =
      std::size_t(counts_.x) * std::size_t(counts_.y) * std::size_t(counts_.z);
  slots_.assign(bricks, -1);
  pool_.reserve(bricks);  // addresses; memory is used as bricks become known
  dirty_.assign(bricks, 0);
  changed_.assign(bricks, 0);
  const auto rows =
      std::size_t(Brick::kSizeY + 2 * reach_.y) * std::size_t(Brick::kSizeZ + 2 * reach_.z);
  local_.resize(rows * std::size_t(2 * side_words_ + 1));
  scratch_.resize(std::size_t(2 * side_words_ + 1));
}

std::size_t BrickMap::memory_bytes() const {
  return pool_.size() * sizeof(Bits) + slots_.size() * 4 + dirty_.size() * 8 +
         changed_.size() + local_.size() * 8;
}

BrickMap::Bits& BrickMap::own(Index3 brick) {
  std::int32_t& slot = slots_[flat(brick)];
  if (slot >= 0) return pool_[std::size_t(slot)];
  if (unused_.empty()) {
    slot = std::int32_t(pool_.size());
    pool_.emplace_back();
  } else {
    slot = unused_.back();
    unused_.pop_back();
    pool_[std::size_t(slot)] = {};
  }
  Bits& bits = pool_[std::size_t(slot)];
  if (default_grown()) {
    const Word inside = bits_inside(brick, size_);
    for (int row = 0; row < Brick::kWords; ++row) {
      const bool there = 8 * brick.y + row % 8 < size_.y && 8 * brick.z + row / 8 < size_.z;
      bits.grown[std::size_t(row)] = there ? inside : 0;
    }
  }
  return bits;
}

Word BrickMap::growing(const Bits* bits, int row, Word inside) const {
  if (bits == nullptr) return growth_.unknown_grows ? inside : 0;
  const Word raw = bits->raw[std::size_t(row)];
  return growth_.unknown_grows ? raw | (~bits->known[std::size_t(row)] & inside) : raw;
}

void BrickMap::write(Index3 brick, int row, Word raw, Word known) {
  const Word inside = bits_inside(brick, size_);
  const int y = 8 * brick.y + row % 8, z = 8 * brick.z + row / 8;
  if (y >= size_.y || z >= size_.z) return;
  raw &= inside;
  known &= inside;
  const Bits* held = find(brick);
  const Word old_raw = held != nullptr ? held->raw[std::size_t(row)] : 0;
  const Word old_known = held != nullptr ? held->known[std::size_t(row)] : 0;
  if (raw == old_raw && known == old_known) return;
  const Word before = growing(held, row, inside);
  Bits& bits = own(brick);
  bits.raw[std::size_t(row)] = raw;
  bits.known[std::size_t(row)] = known;
  mark_changed(brick);
  if (const Word diff = before ^ growing(&bits, row, inside); diff != 0) {
    mark_around(brick, row, diff);
  } else if (growth_.unknown_is_occupied && known != old_known) {
    mark_rows(brick, std::uint64_t{1} << row);
  }
}

void BrickMap::mark_changed(Index3 brick) {
  std::uint8_t& mark = changed_[flat(brick)];
  if (mark != 0) return;
  mark = 1;
  changed_bricks_.push_back(brick);
}

void BrickMap::mark_rows(Index3 brick, std::uint64_t rows) {
  std::uint64_t& mark = dirty_[flat(brick)];
  if (mark == 0 && rows != 0) dirty_bricks_.push_back(brick);
  mark |= rows;
}

// The rows that voxels of this row may grow into.
void BrickMap::mark_around(Index3 brick, int row, Word changed) {
  const int y = row % 8, z = row / 8;
  const int first = std::countr_zero(changed), last = 63 - std::countl_zero(changed);
  const int x0 = std::max(0, (64 * brick.x + first - reach_.x) >> 6);
  const int x1 = std::min(counts_.x - 1, (64 * brick.x + last + reach_.x) >> 6);
  const int y0 = std::max(0, (8 * brick.y + y - reach_.y) >> 3);
  const int y1 = std::min(counts_.y - 1, (8 * brick.y + y + reach_.y) >> 3);
  const int z0 = std::max(0, (8 * brick.z + z - reach_.z) >> 3);
  const int z1 = std::min(counts_.z - 1, (8 * brick.z + z + reach_.z) >> 3);
  for (int bz = z0; bz <= z1; ++bz) {
    for (int by = y0; by <= y1; ++by) {
      const int to_y = y + 8 * (brick.y - by), to_z = z + 8 * (brick.z - bz);
      const std::uint64_t rows =
          rows_mask(to_y - reach_.y, to_y + reach_.y, to_z - reach_.z, to_z + reach_.z);
      for (int bx = x0; bx <= x1; ++bx) mark_rows({bx, by, bz}, rows);
    }
  }
}

const std::vector<Index3>& BrickMap::regrow() {
  for (const Index3 brick : dirty_bricks_) {
    std::uint64_t& rows = dirty_[flat(brick)];
    grow_brick(brick, rows);
    rows = 0;
  }
  dirty_bricks_.clear();
  for (const Index3 brick : changed_bricks_) changed_[flat(brick)] = 0;
  answer_.swap(changed_bricks_);
  changed_bricks_.clear();
  std::sort(answer_.begin(), answer_.end(),
            [this](Index3 a, Index3 b) { return flat(a) < flat(b); });
  return answer_;
}

void BrickMap::grow_brick(Index3 brick, std::uint64_t rows) {
  // The box of rows that are asked for, and of those that may grow into them.
  Index3 lower{0, 7, 7}, upper{0, 0, 0};
  for (std::uint64_t rest = rows; rest != 0; rest &= rest - 1) {
    const int row = std::countr_zero(rest);
    lower = {0, std::min(lower.y, row % 8), std::min(lower.z, row / 8)};
    upper = {0, std::max(upper.y, row % 8), std::max(upper.z, row / 8)};
  }
  lower = {0, lower.y - reach_.y, lower.z - reach_.z};
  upper = {0, upper.y + reach_.y, upper.z + reach_.z};
  gather(brick, lower, upper);
  Words grown{};
  dilate(lower, upper, rows, grown);

  const Word inside = bits_inside(brick, size_);
  const Bits* held = find(brick);
  for (; rows != 0; rows &= rows - 1) {
    const auto row = std::size_t(std::countr_zero(rows));
    if (8 * brick.y + int(row) % 8 >= size_.y || 8 * brick.z + int(row) / 8 >= size_.z) continue;
    const Word known = held != nullptr ? held->known[row] : 0;
    Word word = grown[row];
    if (growth_.unknown_is_occupied) word |= ~known;
    word &= inside;
    const Word before = held != nullptr ? held->grown[row] : default_grown() ? inside : 0;
    if (word == before) continue;
    own(brick).grown[row] = word;
    held = find(brick);
    mark_changed(brick);
  }
}

// The growing bits of the rows lower .. upper (counted from the brick) into local_.
void BrickMap::gather(Index3 brick, Index3 lower, Index3 upper) {
  const int words = 2 * side_words_ + 1;
  Word* to = local_.data();
  for (int z = lower.z; z <= upper.z; ++z) {
    for (int y = lower.y; y <= upper.y; ++y, to += words) {
      const int at_y = 8 * brick.y + y, at_z = 8 * brick.z + z;
      const bool there = at_y >= 0 && at_y < size_.y && at_z >= 0 && at_z < size_.z;
      for (int i = 0; i < words; ++i) {
        const Index3 from{brick.x - side_words_ + i, at_y >> 3, at_z >> 3};
        to[i] = there && unsigned(from.x) < unsigned(counts_.x)
                    ? growing(find(from), 8 * (at_z & 7) + (at_y & 7), bits_inside(from, size_))
                    : 0;
      }
    }
  }
}

// Widens the rows of local_ step by step, and writes them into those that are asked for.
void BrickMap::dilate(Index3 lower, Index3 upper, std::uint64_t rows, Words& grown) {
  const int words = 2 * side_words_ + 1;
  const int across = upper.y - lower.y + 1;
  const int all = across * (upper.z - lower.z + 1);
  int covered = 0;
  for (std::size_t first = 0; first < element_.size();) {
    const int extent = element_[first].half_extent;
    for (; covered < extent;) {
      const int step = std::min(std::max(covered, 1), extent - covered);
      Word* row = local_.data();
      for (int i = 0; i < all; ++i, row += words) {
        std::copy_n(row, words, scratch_.data());
        or_both_ways(row, scratch_.data(), words, step);
      }
      covered += step;
    }
    std::size_t last = first;
    while (last < element_.size() && element_[last].half_extent == extent) ++last;
    for (std::uint64_t rest = rows; rest != 0; rest &= rest - 1) {
      const int row = std::countr_zero(rest);
      const Word* centre = local_.data() + side_words_ +
                           ((row / 8 - lower.z) * across + row % 8 - lower.y) * words;
      Word word = 0;
      for (std::size_t k = first; k < last; ++k) {
        word |= centre[(element_[k].dz * across + element_[k].dy) * words];
      }
      grown[std::size_t(row)] |= word;
    }
    first = last;
  }
}

bool BrickMap::any_free() const {
  bool free = false;
  for_bricks(counts_, [&](Index3 index) {
    if (free) return;
    const Bits* held = find(index);
    if (held == nullptr) {
      free = !default_grown();
      return;
    }
    const Word inside = bits_inside(index, size_);
    for (int row = 0; row < Brick::kWords; ++row) {
      const bool there = 8 * index.y + row % 8 < size_.y && 8 * index.z + row / 8 < size_.z;
      free = free || (there && (~held->grown[std::size_t(row)] & inside) != 0);
    }
  });
  return free;
}

void BrickMap::shift(Index3 by, const Leave& leave) {
  if (by == Index3{}) return;
  if (size_.x % Brick::kSizeX != 0 || size_.y % Brick::kSizeY != 0 ||
      size_.z % Brick::kSizeZ != 0) {
    throw std::logic_error("a window that moves must be made of whole bricks");
  }
  regrow();
  for (const Index3 brick : answer_) mark_changed(brick);  // the next answer tells of them too
  std::vector<std::int32_t> moved(slots_.size(), -1);
  std::vector<Index3> changed;
  for_bricks(counts_, [&](Index3 brick) {
    const std::int32_t slot = slots_[flat(brick)];
    const Index3 to = brick - by;
    if (contains(to)) {
      moved[flat(to)] = slot;
      if (changed_[flat(brick)] != 0) changed.push_back(to);
    } else if (slot >= 0) {
      leave(brick, pool_[std::size_t(slot)]);
      unused_.push_back(slot);
    }
  });
  slots_ = std::move(moved);
  changed_.assign(changed_.size(), 0);
  changed_bricks_.clear();
  for (const Index3 brick : changed) mark_changed(brick);
  mark_moved(by);
}

// What has other neighbours within reach than before the move, and what came in.
void BrickMap::mark_moved(Index3 by) {
  const Index3 far{side_words_, words_reached(reach_.y, 8), words_reached(reach_.z, 8)};
  const auto same_before = [&](int at, int moved, int count, int reach) {
    for (int k = at - reach; k <= at + reach; ++k) {
      if ((k >= 0 && k < count) != (k + moved >= 0 && k + moved < count)) return false;
    }
    return true;
  };
  for_bricks(counts_, [&](Index3 brick) {
    const bool same = same_before(brick.x, by.x, counts_.x, far.x) &&
                      same_before(brick.y, by.y, counts_.y, far.y) &&
                      same_before(brick.z, by.z, counts_.z, far.z);
    if (!same) mark_rows(brick, ~std::uint64_t{0});
  });
}

Brick BrickMap::brick(Index3 index) const {
  Brick brick;
  brick.index = index;
  const Bits* held = find(index);
  brick.raw = held != nullptr ? held->raw : Words{};
  if (held != nullptr) {
    brick.known = held->known;
    brick.grown = held->grown;
  } else if (default_grown()) {
    const Word inside = bits_inside(index, size_);
    for (int row = 0; row < Brick::kWords; ++row) {
      const bool there = 8 * index.y + row % 8 < size_.y && 8 * index.z + row / 8 < size_.z;
      brick.grown[std::size_t(row)] = there ? inside : 0;
    }
  }
  return brick;
}

void BrickMap::write_dense(BitGrid& grown, BitGrid& known, BitGrid& raw) const {
  const auto put = [&](BitGrid& grid, Index3 brick, int y, int z, Word word) {
    const Word inside = bits_inside(brick, size_);
    const Word held = grid.row(y, z)[brick.x];
    const Word all = (held & ~inside) | (word & inside);
    if (all != held) grid.mutable_row(y, z)[brick.x] = all;
  };
  for_bricks(counts_, [&](Index3 brick) {
    const Bits* bits = find(brick);
    if (bits == nullptr) return;
    for (int row = 0; row < Brick::kWords; ++row) {
      const int y = 8 * brick.y + row % 8, z = 8 * brick.z + row / 8;
      if (y >= size_.y || z >= size_.z) continue;
      put(grown, brick, y, z, bits->grown[std::size_t(row)]);
      put(known, brick, y, z, bits->known[std::size_t(row)]);
      put(raw, brick, y, z, bits->raw[std::size_t(row)]);
    }
  });
}

}  // namespace goshawk
