#pragma once

#include <array>
#include <cstdint>
#include <cstring>
#include <vector>

#include "goshawk/core/bit_grid.hpp"
#include "goshawk/path_search/lazy_words.hpp"
#include "goshawk/path_search/move_rules.hpp"

namespace goshawk::path_search {

/// The obstacles as the search reads them: one bit a voxel in three copies, one with each axis as
/// the fastest, so that a scan along any axis looks at a word at a time. A blocked layer
/// surrounds the map, so that no index needs a bounds test; neighbouring rows share it.
/// Memory: 3 bits a voxel and the layer, and 6 more for jumps.
///
/// The position of a voxel in the copy with x fastest is also its node number.
class ObstacleBits {
 public:
  using Node = std::uint32_t;
  static constexpr std::int64_t kMaxNodes = std::int64_t{0xFFFFFFFF};
  static constexpr int kLongestJump = 63;  // what one 64-bit window sees

  /// @return nodes that a map of this size needs, or 0 where it is more than kMaxNodes
  static std::int64_t nodes_for(Index3 size);

  /// Takes over `blocked`, and keeps a copy of it, which shares its chunks. Of a map of the same
  /// size as before only chunks that differ are looked at; work for each voxel that differs.
  /// @pre nodes_for(blocked.size()) > 0
  /// @return did any voxel change, or the size?
  bool assign(const BitGrid& blocked);

  /// For those who will jump: asks for the memory of straight_jump() now.
  void populate_jumps();

  /// The map as it was assigned.
  const BitGrid& map() const { return held_; }

  Index3 size() const { return size_; }
  std::int64_t nodes() const { return size_.x == 0 ? 0 : nodes_for(size_); }
  bool contains(Index3 i) const {
    return unsigned(i.x) < unsigned(size_.x) && unsigned(i.y) < unsigned(size_.y) &&
           unsigned(i.z) < unsigned(size_.z);
  }

  Node node(Index3 i) const { return Node(position(axes_[0], i.x, i.y, i.z)); }
  Index3 index(Node node) const {
    const std::uint64_t row = divide(node, row_magic_);
    const std::uint64_t layer = divide(row, layer_magic_);
    return {int(node - row * axes_[0].stride_u) - 1, int(row - layer * rows_per_layer_) - 1,
            int(layer) - 1};
  }
  /// Node number of the neighbour minus that of the node.
  std::int64_t offset(int direction) const { return offsets_[std::size_t(direction)]; }

  bool blocked(Node node) const { return get(axes_[0], node); }

  /// The blocked voxels of the 3x3x3 block around a node, by direction_of().
  BlockMask block(Node node) const {
    BlockMask blocked = 0;
    const std::int64_t first = std::int64_t{node} - 1;
    for (std::size_t r = 0; r < 9; ++r) {
      const std::int64_t p = first + offsets_[3 * r + 1];
      std::uint16_t pair;
      std::memcpy(&pair, axes_[0].bytes() + (p >> 3), sizeof pair);
      blocked |= BlockMask((pair >> (p & 7)) & 7U) << (3 * r);
    }
    return blocked;
  }

  /// The straight jump: goes on from `from` by up to kLongestJump voxels. Where it has to stop is
  /// worked out for 64 voxels at a time, when first asked, and kept until the map changes there.
  /// @param rule of all jumps (another one than before costs all that is kept)
  /// @param axis 0, 1, 2 @param sign -1 or +1
  /// @return steps to the first voxel that may have a forced neighbour, or kLongestJump; the
  /// negated number of free steps where an obstacle comes first
  int straight_jump(CornerRule rule, int axis, int sign, Index3 from);

 private:
  // One copy: bit position = u + 1 + stride_u (v + 1) + stride_v (w + 1) for the axes u, v, w.
  struct Copy {
    std::vector<std::uint64_t> words;  // kSpare more at either end, for unaligned loads
    std::int64_t stride_u = 0;         // bits from one v to the next
    std::int64_t stride_v = 0;         // bits from one w to the next
    LazyWords ahead;                   // where a jump towards higher u stops
    LazyWords behind;                  // towards lower u
    const char* bytes() const { return reinterpret_cast<const char*>(words.data() + kSpare); }
    std::uint64_t from(std::int64_t p) const {
      const std::uint64_t* w = words.data() + (p >> 6) + kSpare;
      const int shift = int(p & 63);
      return shift == 0 ? w[0] : w[0] >> shift | w[1] << (64 - shift);
    }
  };
  static constexpr int kSpare = 4;

  static std::int64_t position(const Copy& c, int u, int v, int w) {
    return u + 1 + c.stride_u * (v + 1) + c.stride_v * (w + 1);
  }
  static bool get(const Copy& c, std::int64_t p) {
    return (c.words[std::size_t(p >> 6) + kSpare] >> (p & 63)) & 1U;
  }
  static void flip(Copy& c, std::int64_t p) {
    c.words[std::size_t(p >> 6) + kSpare] ^= std::uint64_t{1} << (p & 63);
  }
  // floor(n / d) for n < 2^32 with magic = ceil(2^64 / d), d >= 2.
  static std::uint64_t divide(std::uint64_t n, std::uint64_t magic) {
    __extension__ using Wide = unsigned __int128;
    return std::uint64_t((Wide{magic} * n) >> 64);
  }

  void resize(Index3 size);
  void clear(Copy& copy, int u_size, int v_size, int w_size);
  bool assign_row(const BitGrid& blocked, int y, int z);
  void apply_changes(std::uint64_t changes, int x0, int y, int z);
  void forget_around(Copy& copy, std::int64_t p);
  void forget_derived();
  [[gnu::noinline]] void find_stops(Copy& copy, std::size_t word);

  Index3 size_;
  BitGrid held_;              // what the copies say
  std::array<Copy, 3> axes_;  // x, y, z fastest; then the other two in the order x, y, z
  CornerRule rule_ = CornerRule::no_squeeze;  // of the stops
  std::int64_t changes_ = 0;                  // of assign() at work
  std::array<std::int64_t, kDirections> offsets_{};
  std::uint64_t rows_per_layer_ = 0;
  std::uint64_t row_magic_ = 0;
  std::uint64_t layer_magic_ = 0;
};

}  // namespace goshawk::path_search
