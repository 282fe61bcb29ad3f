#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "goshawk/core/result.hpp"
#include "goshawk/core/shared_words.hpp"
#include "goshawk/core/vector.hpp"

namespace goshawk {

/// One bit a voxel; a row (fixed y and z) is contiguous and padded to whole 64-bit words: bit b of
/// word w is x = 64 w + b. The padding bits all have one value, the `outside` value, which test()
/// also gives for every index outside the grid: an occupancy grid has outside = true (the world
/// beyond the map is an obstacle), a known grid false.
///
/// Rows are kept in chunks of 8 x 8 (y, z). Copies share chunks, and a write clones the chunk that
/// it meets if another copy has it: to copy a grid costs 8 bytes a chunk, and two versions of a map
/// tell in a moment which chunks differ (for_changed_chunks). Copies may be used in different
/// threads at the same time, one object may not.
class BitGrid {
 public:
  using Word = SharedWords::Word;
  static constexpr int kWordBits = 64;
  static constexpr int kChunkSide = 8;  // rows of a chunk along y and along z

  BitGrid() = default;

  /// @param size voxels along x, y, z, each >= 1 @param value of every voxel
  /// @pre check_size(size) is ok
  BitGrid(Index3 size, bool outside, bool value = false);

  /// @param words row after row, y faster than z; their padding bits are not looked at
  static Result<BitGrid> from_words(Index3 size, bool outside, std::span<const Word> words);
  /// The same words again, padding included; into memory that is reused, or new.
  void write_words(std::vector<Word>& words) const;
  std::vector<Word> to_words() const;

  /// @return map_empty for a dimension below 1, map_too_large beyond kMaxVoxels
  static Status check_size(Index3 size);
  static constexpr std::int64_t kMaxVoxels = std::int64_t{1} << 33;

  Index3 size() const { return size_; }
  bool outside() const { return outside_; }
  bool empty() const { return chunks_.empty(); }
  std::int64_t voxels() const { return std::int64_t{size_.x} * size_.y * size_.z; }
  std::size_t words_per_row() const { return words_per_row_; }

  bool contains(Index3 i) const {
    return unsigned(i.x) < unsigned(size_.x) && unsigned(i.y) < unsigned(size_.y) &&
           unsigned(i.z) < unsigned(size_.z);
  }

  /// @return the bit, or outside() if the grid does not contain i
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
  const Word* row(int y, int z) const { return chunks_[chunk_at(y, z)].data() + offset(y, z); }
  /// For writing, until the grid is copied. Padding bits must stay as they are.
  Word* mutable_row(int y, int z) { return chunks_[chunk_at(y, z)].own() + offset(y, z); }

  /// @return the voxels x .. x + 63 of a row, the first in the lowest bit; those beyond the row are
  /// outside(). @pre y and z inside
  Word bits_from(std::int64_t x, int y, int z) const;

  /// @return the voxels lower <= i < lower + size; those beyond this grid are outside()
  /// @pre check_size(size) is ok
  BitGrid window(Index3 lower, Index3 size) const;

  /// @return number of voxels (padding excluded) that are set
  std::int64_t count() const;

  /// @return a grid of the same size whose voxel i is this one's voxel i + (64, 8, 8) bricks, or
  /// `value` if there is none. Chunks are shared as far as x does not move
  BitGrid shifted(Index3 bricks, bool value) const;

  /// Shares the chunks that say the same in another grid, so that both can be compared at once.
  void share_equal_chunks(const BitGrid& other);

  friend bool operator==(const BitGrid& a, const BitGrid& b);

  /// The rows y0 <= y < y1, z0 <= z < z1 of one chunk.
  struct Rows {
    int y0, y1;
    int z0, z1;
  };

  /// Visits the chunks in which two grids differ: visit(Rows). Chunks that both share cost one
  /// comparison of pointers, others one of their words. @pre grids of the same size
  template <typename Visit>
  friend void for_changed_chunks(const BitGrid& before, const BitGrid& after, Visit&& visit) {
    for (std::size_t k = 0; k < after.chunks_.size(); ++k) {
      if (!before.same_chunk(k, after)) visit(after.rows_of(k));
    }
  }

 private:
  std::size_t chunk_at(int y, int z) const {
    return std::size_t(z >> 3) * chunks_y_ + std::size_t(y >> 3);
  }
  std::size_t offset(int y, int z) const {
    return std::size_t(8 * (z & 7) + (y & 7)) * words_per_row_;
  }
  Rows rows_of(std::size_t chunk) const;
  bool same_chunk(std::size_t chunk, const BitGrid& other) const;
  Word padding_mask() const;

  Index3 size_;
  std::size_t words_per_row_ = 0;
  std::size_t chunks_y_ = 0;
  bool outside_ = true;
  std::vector<SharedWords> chunks_;  // y faster than z; each 8 rows in y, and in z as it has layers
};

}  // namespace goshawk
