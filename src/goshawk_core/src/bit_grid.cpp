#include "goshawk/core/bit_grid.hpp"

#include <algorithm>
#include <bit>
#include <utility>

namespace goshawk {
namespace {

std::size_t words_for(int size_x) {
  return (std::size_t(size_x) + 63) / 64;
}

std::string text(Index3 s) {
  return std::to_string(s.x) + " x " + std::to_string(s.y) + " x " + std::to_string(s.z);
}

}  // namespace

BitGrid::BitGrid(Index3 size, bool outside, bool value)
    : size_(size), words_per_row_(words_for(size.x)), outside_(outside) {
  if (auto status = check_size(size); !status) throw std::logic_error(status.error().message);
  words_.assign(words_per_row_ * std::size_t(size.y) * std::size_t(size.z),
                value ? ~Word{0} : Word{0});
  write_padding();
}

Result<BitGrid> BitGrid::from_words(Index3 size, bool outside, std::vector<Word> words) {
  if (auto status = check_size(size); !status) return status.error();
  const std::size_t expected = words_for(size.x) * std::size_t(size.y) * std::size_t(size.z);
  if (words.size() != expected) {
    return fail(ErrorCode::invalid_input, "a grid of " + text(size) + " voxels needs " +
                                              std::to_string(expected) + " words, but " +
                                              std::to_string(words.size()) +
                                              " came: pad each x row to whole 64-bit words");
  }
  BitGrid grid;
  grid.size_ = size;
  grid.words_per_row_ = words_for(size.x);
  grid.outside_ = outside;
  grid.words_ = std::move(words);
  grid.write_padding();
  return grid;
}

Status BitGrid::check_size(Index3 size) {
  if (size.x < 1 || size.y < 1 || size.z < 1) {
    return fail(ErrorCode::map_empty,
                "a grid of " + text(size) + " voxels is empty: each dimension must be 1 or more");
  }
  // In this order no product overflows: two factors of at most 2^31 fit into 64 bits.
  const std::int64_t rows = std::int64_t{size.y} * size.z;
  if (rows > kMaxVoxels / size.x) {
    return fail(ErrorCode::map_too_large, "a grid of " + text(size) +
                                              " voxels is larger than the limit of 2^33: use a "
                                              "coarser resolution or a smaller box");
  }
  return success();
}

void BitGrid::set_run(int x0, int x1, int y, int z, bool value) {
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

std::vector<BitGrid::Word> BitGrid::take_words() {
  size_ = {};
  words_per_row_ = 0;
  return std::exchange(words_, {});
}

std::int64_t BitGrid::count() const {
  std::int64_t total = 0;
  for (const Word word : words_) total += std::popcount(word);
  if (outside_) total -= std::int64_t{size_.y} * size_.z * std::popcount(padding_mask());
  return total;
}

BitGrid::Word BitGrid::padding_mask() const {
  const int used = size_.x & 63;
  return used == 0 ? Word{0} : ~Word{0} << used;
}

void BitGrid::write_padding() {
  const Word mask = padding_mask();
  if (mask == 0) return;
  for (std::size_t last = words_per_row_ - 1; last < words_.size(); last += words_per_row_) {
    words_[last] = outside_ ? words_[last] | mask : words_[last] & ~mask;
  }
}

}  // namespace goshawk
