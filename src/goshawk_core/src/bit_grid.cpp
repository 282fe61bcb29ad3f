#include "goshawk/core/bit_grid.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

namespace goshawk {
namespace {

using Word = BitGrid::Word;
constexpr int kSide = BitGrid::kChunkSide;

std::size_t words_for(int size_x) {
  return (std::size_t(size_x) + 63) / 64;
}

std::size_t chunks_for(int rows) {
  return std::size_t(rows - 1) / std::size_t(kSide) + 1;
}

std::string text(Index3 s) {
  return fmt::format("{} x {} x {}", s.x, s.y, s.z);
}

// Where a shifted row takes its words from: words [begin, end) of the new row are words
// [begin + from, end + from) of the old one.
struct WordShift {
  std::int64_t begin, end, from;

  WordShift(std::int64_t by, std::size_t words)
      : begin(std::max<std::int64_t>(0, -by)),
        end(std::min(std::int64_t(words), std::int64_t(words) - by)),
        from(by) {}
};

}  // namespace

BitGrid::BitGrid(Index3 size, bool outside, bool value)
    : size_(size), words_per_row_(words_for(size.x)), outside_(outside) {
  if (auto status = check_size(size); !status) throw std::logic_error(status.error().message);
  chunks_y_ = chunks_for(size.y);
  const std::size_t layers = chunks_for(size.z);
  const auto uniform = [&](int depth) {
    const std::size_t rows = std::size_t(kSide) * std::size_t(depth);
    SharedWords words(rows * words_per_row_, value ? ~Word{0} : Word{0});
    if (const Word mask = padding_mask(); mask != 0 && value != outside) {
      Word* last = words.own() + words_per_row_ - 1;
      for (std::size_t r = 0; r < rows; ++r) last[r * words_per_row_] ^= mask;
    }
    return words;
  };
  // One chunk says it for all, but for the top ones, which may have fewer layers.
  const int depth = size.z - kSide * int(layers - 1);
  if (layers > 1) chunks_.assign(chunks_y_ * (layers - 1), uniform(kSide));
  chunks_.resize(chunks_y_ * layers, uniform(depth));
}

Result<BitGrid> BitGrid::from_words(Index3 size, bool outside, std::span<const Word> words) {
  if (auto status = check_size(size); !status) return status.error();
  const std::size_t per_row = words_for(size.x);
  const std::size_t expected = per_row * std::size_t(size.y) * std::size_t(size.z);
  if (words.size() != expected) {
    return fail(ErrorCode::invalid_input,
                fmt::format("a grid of {} voxels needs {} words, but {} came: pad each x row to "
                            "whole 64-bit words",
                            text(size), expected, words.size()));
  }
  BitGrid grid(size, outside);
  const Word mask = grid.padding_mask();
  const Word* from = words.data();
  for (int z = 0; z < size.z; ++z) {
    for (int y = 0; y < size.y; ++y, from += per_row) {
      const Word last = outside ? from[per_row - 1] | mask : from[per_row - 1] & ~mask;
      const Word* held = grid.row(y, z);
      if (last == held[per_row - 1] && std::equal(from, from + per_row - 1, held)) continue;
      Word* to = grid.mutable_row(y, z);
      std::copy_n(from, per_row - 1, to);
      to[per_row - 1] = last;
    }
  }
  return grid;
}

void BitGrid::write_words(std::vector<Word>& words) const {
  words.resize(words_per_row_ * std::size_t(size_.y) * std::size_t(size_.z));
  Word* to = words.data();
  for (int z = 0; z < size_.z; ++z) {
    for (int y = 0; y < size_.y; ++y) to = std::copy_n(row(y, z), words_per_row_, to);
  }
}

std::vector<Word> BitGrid::to_words() const {
  std::vector<Word> words;
  write_words(words);
  return words;
}

Status BitGrid::check_size(Index3 size) {
  if (size.x < 1 || size.y < 1 || size.z < 1) {
    return fail(
        ErrorCode::map_empty,
        fmt::format("a grid of {} voxels is empty: each dimension must be 1 or more", text(size)));
  }
  // In this order no product overflows: two factors of at most 2^31 fit into 64 bits.
  const std::int64_t rows = std::int64_t{size.y} * size.z;
  if (rows > kMaxVoxels / size.x) {
    return fail(ErrorCode::map_too_large,
                fmt::format("a grid of {} voxels is larger than the limit of 2^33: use a coarser "
                            "resolution or a smaller box",
                            text(size)));
  }
  return success();
}

void BitGrid::set_run(int x0, int x1, int y, int z, bool value) {
  if (x0 >= x1) return;
  Word* words = mutable_row(y, z);
  while (x0 < x1) {
    const int bit = x0 & 63;
    const int length = std::min(kWordBits - bit, x1 - x0);
    const Word ones = length == kWordBits ? ~Word{0} : (Word{1} << length) - 1;
    const Word mask = ones << bit;
    Word& word = words[x0 >> 6];
    word = value ? word | mask : word & ~mask;
    x0 += length;
  }
}

Word BitGrid::bits_from(std::int64_t x, int y, int z) const {
  const Word* words = row(y, z);
  const std::int64_t n = std::int64_t(words_per_row_);
  const std::int64_t w = x >> 6;
  const int shift = int(x & 63);
  const auto at = [&](std::int64_t k) {
    return k >= 0 && k < n ? words[k] : outside_ ? ~Word{0} : Word{0};
  };
  return shift == 0 ? at(w) : at(w) >> shift | at(w + 1) << (64 - shift);
}

BitGrid BitGrid::window(Index3 lower, Index3 size) const {
  BitGrid cut(size, outside_, outside_);
  const int z0 = std::max(0, -lower.z), y0 = std::max(0, -lower.y);
  const std::int64_t z1 = std::min<std::int64_t>(size.z, std::int64_t{size_.z} - lower.z);
  const std::int64_t y1 = std::min<std::int64_t>(size.y, std::int64_t{size_.y} - lower.y);
  const Word padding = cut.padding_mask();
  for (int z = z0; z < z1; ++z) {
    for (int y = y0; y < y1; ++y) {
      for (std::size_t w = 0; w < cut.words_per_row_; ++w) {
        Word word = bits_from(lower.x + 64 * std::int64_t(w), lower.y + y, lower.z + z);
        if (w + 1 == cut.words_per_row_) word = outside_ ? word | padding : word & ~padding;
        if (word != cut.row(y, z)[w]) cut.mutable_row(y, z)[w] = word;
      }
    }
  }
  return cut;
}

std::int64_t BitGrid::count() const {
  std::int64_t total = 0;
  for (int z = 0; z < size_.z; ++z) {
    for (int y = 0; y < size_.y; ++y) {
      const Word* words = row(y, z);
      for (std::size_t w = 0; w < words_per_row_; ++w) total += std::popcount(words[w]);
    }
  }
  if (outside_) total -= std::int64_t{size_.y} * size_.z * std::popcount(padding_mask());
  return total;
}

BitGrid BitGrid::shifted(Index3 bricks, bool value) const {
  BitGrid moved(size_, outside_, value);
  if (empty()) return moved;
  const WordShift x(bricks.x, words_per_row_);
  const Word mask = padding_mask();
  const auto copy_row = [&](int y, int z, std::int64_t from_y, std::int64_t from_z) {
    const Word* from = row(int(from_y), int(from_z));
    Word* to = moved.mutable_row(y, z);
    std::copy(from + x.begin + x.from, from + x.end + x.from, to + x.begin);
    if (mask == 0) return;
    // The old padding, where it came to lie inside, then the new one.
    if (x.from > 0) to[x.end - 1] = value ? to[x.end - 1] | mask : to[x.end - 1] & ~mask;
    Word& last = to[words_per_row_ - 1];
    last = outside_ ? last | mask : last & ~mask;
  };
  for (std::size_t k = 0; k < chunks_.size(); ++k) {
    const Rows rows = rows_of(k);
    const std::int64_t from_y = rows.y0 + std::int64_t{kSide} * bricks.y;
    const std::int64_t from_z = rows.z0 + std::int64_t{kSide} * bricks.z;
    if (from_y < 0 || from_y >= size_.y || from_z < 0 || from_z >= size_.z) continue;
    const Rows from = rows_of(chunk_at(int(from_y), int(from_z)));
    const bool same_shape = from.y1 - from.y0 == rows.y1 - rows.y0 &&
                            from.z1 - from.z0 == rows.z1 - rows.z0;
    if (x.from == 0 && same_shape) {
      moved.chunks_[k] = chunks_[chunk_at(int(from_y), int(from_z))];
      continue;
    }
    if (x.begin >= x.end) continue;
    for (int z = rows.z0; z < std::min(rows.z1, rows.z0 + from.z1 - from.z0); ++z) {
      for (int y = rows.y0; y < std::min(rows.y1, rows.y0 + from.y1 - from.y0); ++y) {
        copy_row(y, z, from_y + y - rows.y0, from_z + z - rows.z0);
      }
    }
  }
  return moved;
}

void BitGrid::share_equal_chunks(const BitGrid& other) {
  if (empty() || !(size_ == other.size_) || outside_ != other.outside_) return;
  for (std::size_t k = 0; k < chunks_.size(); ++k) {
    if (same_chunk(k, other)) chunks_[k] = other.chunks_[k];
  }
}

bool operator==(const BitGrid& a, const BitGrid& b) {
  if (!(a.size_ == b.size_) || a.outside_ != b.outside_) return false;
  for (std::size_t k = 0; k < a.chunks_.size(); ++k) {
    if (!a.same_chunk(k, b)) return false;
  }
  return true;
}

BitGrid::Rows BitGrid::rows_of(std::size_t chunk) const {
  const int y0 = kSide * int(chunk % chunks_y_);
  const int z0 = kSide * int(chunk / chunks_y_);
  return {y0, y0 + std::min(kSide, size_.y - y0), z0, z0 + std::min(kSide, size_.z - z0)};
}

// Rows beyond the grid mean nothing: only those inside are compared.
bool BitGrid::same_chunk(std::size_t chunk, const BitGrid& other) const {
  if (share(chunks_[chunk], other.chunks_[chunk])) return true;
  const Rows rows = rows_of(chunk);
  const std::size_t words = words_per_row_ * std::size_t(rows.y1 - rows.y0);
  for (int z = rows.z0; z < rows.z1; ++z) {
    const Word* mine = row(rows.y0, z);
    if (!std::equal(mine, mine + words, other.row(rows.y0, z))) return false;
  }
  return true;
}

Word BitGrid::padding_mask() const {
  const int used = size_.x & 63;
  return used == 0 ? Word{0} : ~Word{0} << used;
}

}  // namespace goshawk
