#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "goshawk/core/grid_update.hpp"

namespace goshawk {

/// How obstacles and unknown space become what blocks the vehicle's centre.
struct BrickGrowth {
  double inflation_m = 0.0;   // [m] finite, >= 0
  double resolution_m = 0.2;  // [m] finite, > 0
  bool unknown_is_occupied = true;
  bool unknown_grows = false;  // only if unknown_is_occupied
};

/// A window of the world as sparse bricks of 64 x 8 x 8 voxels with raw, known and grown bits, for
/// maps that change a few bricks at a time. Bricks of which nothing is known take no memory.
/// Growth is incremental and exact: after regrow() the grown bits are those that inflate() gives
/// for the whole window, and the cost goes with what changed. Nothing is allocated unless a brick
/// becomes known for the first time.
class BrickMap {
 public:
  using Word = BitGrid::Word;
  using Words = Brick::Words;
  struct Bits {
    Words raw{};    // obstacles as measured; only known voxels are set
    Words known{};  // measured at all
    Words grown{};  // blocked for the vehicle's centre
  };

  /// A window of unknown space. @param size voxels
  /// @return map_empty, map_too_large; invalid_input for a growth that is not allowed
  static Result<BrickMap> make(Index3 size, const BrickGrowth& growth);

  Index3 size() const { return size_; }      // [voxels]
  Index3 counts() const { return counts_; }  // [bricks]
  const BrickGrowth& growth() const { return growth_; }
  std::size_t bricks_held() const { return pool_.size() - unused_.size(); }
  std::size_t memory_bytes() const;

  /// @return the bits of a brick, or nullptr if nothing is known of it. Valid until the next
  /// write, regrow or shift. @pre inside the counts
  const Bits* find(Index3 brick) const {
    const std::int32_t slot = slots_[flat(brick)];
    return slot < 0 ? nullptr : &pool_[std::size_t(slot)];
  }
  bool is_raw(Index3 voxel) const { return bit(voxel, &Bits::raw); }      // false outside
  bool is_known(Index3 voxel) const { return bit(voxel, &Bits::known); }  // false outside

  /// Writes the row 8 (z % 8) + y % 8 of a brick; bits outside the window are dropped.
  /// @pre raw is a part of known, the brick is inside
  void write(Index3 brick, int row, Word raw, Word known);

  /// Grows anew around what was written since the last call.
  /// @return the bricks that changed since then, in the order of their place
  const std::vector<Index3>& regrow();

  /// Called with each brick that is known and leaves the window, by its index before the move.
  using Leave = std::function<void(Index3 brick, const Bits& bits)>;

  /// Moves the window, as GridUpdate::shift: what comes in is unknown.
  /// @pre the size is whole bricks (throws else)
  void shift(Index3 bricks, const Leave& leave);

  /// @return a brick as updates carry it, with raw. @pre inside the counts
  Brick brick(Index3 index) const;
  /// Writes the dense view of the window. @pre grids of size() with default_grown() and false as
  /// the value of every voxel
  void write_dense(BitGrid& grown, BitGrid& known, BitGrid& raw) const;
  /// Is any voxel of the window free for the vehicle's centre?
  bool any_free() const;
  /// Is a voxel blocked of which nothing is known, far from all that is?
  bool default_grown() const { return growth_.unknown_is_occupied; }

 private:
  BrickMap(Index3 size, const BrickGrowth& growth);

  std::size_t flat(Index3 b) const {
    return (std::size_t(b.z) * std::size_t(counts_.y) + std::size_t(b.y)) * std::size_t(counts_.x) +
           std::size_t(b.x);
  }
  bool contains(Index3 b) const {
    return unsigned(b.x) < unsigned(counts_.x) && unsigned(b.y) < unsigned(counts_.y) &&
           unsigned(b.z) < unsigned(counts_.z);
  }
  bool bit(Index3 v, Words Bits::*words) const {
    if (unsigned(v.x) >= unsigned(size_.x) || unsigned(v.y) >= unsigned(size_.y) ||
        unsigned(v.z) >= unsigned(size_.z)) {
      return false;
    }
    const Bits* bits = find({v.x >> 6, v.y >> 3, v.z >> 3});
    return bits != nullptr &&
           ((bits->*words)[std::size_t(8 * (v.z & 7) + (v.y & 7))] >> (v.x & 63) & 1U);
  }
  Bits& own(Index3 brick);
  Word growing(const Bits* bits, int row, Word inside) const;
  void mark_rows(Index3 brick, std::uint64_t rows);
  void mark_around(Index3 brick, int row, Word changed);
  void mark_moved(Index3 bricks);
  void mark_changed(Index3 brick);
  void grow_brick(Index3 brick, std::uint64_t rows);
  void gather(Index3 brick, Index3 lower, Index3 upper);
  void dilate(Index3 lower, Index3 upper, std::uint64_t rows, Words& grown);

  struct Row {
    int dy, dz, half_extent;
  };

  Index3 size_, counts_;
  BrickGrowth growth_;
  std::vector<Row> element_;  // narrow rows first
  Index3 reach_;              // [voxels] of the growth
  int side_words_ = 0;        // words to each side that may grow into one

  std::vector<std::int32_t> slots_;  // of each brick of the window; -1: nothing known
  std::vector<Bits> pool_;
  std::vector<std::int32_t> unused_;

  std::vector<std::uint64_t> dirty_;  // rows of each brick to grow anew
  std::vector<Index3> dirty_bricks_;
  std::vector<std::uint8_t> changed_;  // of each brick
  std::vector<Index3> changed_bricks_, answer_;
  std::vector<Word> local_, scratch_;  // rows around the brick that grows
};

}  // namespace goshawk
