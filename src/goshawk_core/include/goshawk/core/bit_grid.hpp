#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "goshawk/core/result.hpp"
#include "goshawk/core/vector.hpp"

namespace goshawk {

/// One bit a voxel, x fastest, then y, then z; each row (fixed y and z) is padded to whole 64-bit
/// words. Bit b of word w of a row is x = 64 w + b. The padding bits all have one value, the
/// `outside` value, which test() also gives for every index outside the grid: an occupancy grid
/// has outside = true (the world beyond the map is an obstacle), a known grid false.
class BitGrid {
 public:
  using Word = std::uint64_t;
  static constexpr int kWordBits = 64;

  BitGrid() = default;

  /// @param size voxels along x, y, z, each >= 1 @param value of every voxel
  /// @pre check_size(size) is ok
  BitGrid(Index3 size, bool outside, bool value = false);

  /// Adopts words that came from elsewhere; the padding bits are set to `outside`.
  static Result<BitGrid> from_words(Index3 size, bool outside, std::vector<Word> words);

  /// @return map_empty for a dimension below 1, map_too_large beyond kMaxVoxels
  static Status check_size(Index3 size);
  static constexpr std::int64_t kMaxVoxels = std::int64_t{1} << 33;

  Index3 size() const { return size_; }
  bool outside() const { return outside_; }
  bool empty() const { return words_.empty(); }
  std::int64_t voxels() const { return std::int64_t{size_.x} * size_.y * size_.z; }
  std::size_t words_per_row() const { return words_per_row_; }

  bool contains(Index3 i) const {
    return unsigned(i.x) < unsigned(size_.x) && unsigned(i.y) < unsigned(size_.y) &&
           unsigned(i.z) < unsigned(size_.z);
  }

  /// @return the bit, or outside() where the grid does not contain i
  bool test(Index3 i) const { return contains(i) ? get(i) : outside_; }

  /// @pre contains(i)
  bool get(Index3 i) const { return (row(i.y, i.z)[i.x >> 6] >> (i.x & 63)) & 1U; }
  void set(Index3 i, bool value) {
    Word& word = mutable_row(i.y, i.z)[i.x >> 6];
    const Word mask = Word{1} << (i.x & 63);
    word = value ? word | mask : word & ~mask;
  }

  /// Sets x0 <= x < x1 of one row. @pre 0 <= x0 <= x1 <= size().x, y and z inside
  void set_run(int x0, int x1, int y, int z, bool value);

  /// @return the words_per_row() words of a row. @pre y and z inside
  const Word* row(int y, int z) const { return words_.data() + row_offset(y, z); }
  Word* mutable_row(int y, int z) { return words_.data() + row_offset(y, z); }

  std::span<const Word> words() const { return words_; }
  /// Gives the words away, and leaves an empty grid.
  std::vector<Word> take_words();

  /// @return number of voxels (padding excluded) that are set
  std::int64_t count() const;

  friend bool operator==(const BitGrid&, const BitGrid&) = default;

 private:
  std::size_t row_offset(int y, int z) const {
    return (std::size_t(z) * std::size_t(size_.y) + std::size_t(y)) * words_per_row_;
  }
  Word padding_mask() const;
  void write_padding();

  Index3 size_;
  std::size_t words_per_row_ = 0;
  bool outside_ = true;
  std::vector<Word> words_;
};

}  // namespace goshawk
