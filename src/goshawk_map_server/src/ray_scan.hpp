#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "goshawk/core/brick_map.hpp"
#include "ray.hpp"
#include "ray_walk.hpp"

namespace goshawk::map_server {

/// The rays of one scan as bits: which voxels of a box of bricks they end in, and which they pass
/// through. Rays are walked exactly, row by row: every voxel whose inside they cross is met, and
/// no other (a ray along a face belongs to the upper voxel). The rows of a ray lie along x or y,
/// whichever it follows more closely: so a word takes as many of its voxels as possible.
class RayScan {
 public:
  using Word = BrickMap::Word;
  static constexpr int kLine = 8;  // rows of a line: those of one brick with the same z

  /// How rays are walked. The bits are the same.
  enum class Walking { fastest, one_by_one };
  explicit RayScan(Walking walking = Walking::fastest);

  /// Clears, for the bricks lower <= b < lower + counts of the map.
  void begin(Index3 lower, Index3 counts);

  /// @param from, to [voxels] from the map's corner, within 2^30 of it; what lies outside the box
  /// is cut off
  /// @param hits whether the ray ends at something; the last voxel is not passed through
  /// @param held may be null; obstacles in it that the ray grazes just before it ends at the same
  /// surface are not passed through
  void cast(const Vec3& from, const Vec3& to, bool hits, const BrickMap* held);

  /// visit(Index3 brick, int first row, const Word* missed, const Word* hit) for each line that
  /// was touched, in the order of their place; both point to 8 words. A voxel may be in both.
  template <typename Visit>
  void for_lines(Visit&& visit) {
    walk_waiting();
    add_columns();
    for (int x = 0; x < counts_.x; ++x) {
      for (int z = 0; z < size_.z; ++z) {
        for (int y = 0; y < counts_.y; ++y) {
          const auto at = std::size_t(x * rows_.plane + std::int64_t{z} * size_.y + y * kLine);
          const Word* missed = rows_.missed.data() + at;
          const Word* hit = hit_.data() + at;
          Word any = 0;
          for (int k = 0; k < kLine; ++k) any |= missed[k] | hit[k];
          if (any == 0) continue;
          visit(Index3{lower_.x + x, lower_.y + y, lower_.z + z / 8}, 8 * (z % 8), missed, hit);
        }
      }
    }
  }

  std::size_t memory_bytes() const {
    return 8 * (rows_.missed.size() + columns_.missed.size() + hit_.size()) +
           waiting_.size() * waiting_.front().walks.size() * sizeof(RayWalk);
  }

 private:
  /// Voxels with 64 neighbours along their first axis in a word.
  struct Bits {
    Index3 size;               // [voxels]
    std::int64_t plane = 0;    // words of all rows with the same 64 of the first axis
    std::vector<Word> missed;  // as RowBits

    void clear(Index3 voxels);
    RowBits rows() { return {missed.data(), plane}; }
  };
  /// Rays that are walked together, once there are enough: of one direction along the same rows.
  struct Waiting {
    std::vector<RayWalk> walks;
    std::size_t count = 0;
  };

  template <bool kUp>
  static void walk_through(Bits& bits, const Ray& ray, Index3 last);
  void walk(Bits& bits, Waiting& waiting, bool up);
  void walk_waiting();
  void add_columns();

  Index3 lower_, counts_;  // [bricks]
  Index3 size_;            // [voxels]
  Bits rows_, columns_;    // along x; along y, with x and y exchanged
  std::vector<Word> hit_;  // as rows_
  WalkRows walk_rows_;
  std::array<Waiting, 4> waiting_;    // along y: + 2; up: + 1
  std::vector<std::uint16_t> order_;  // of the rays that are walked together
};

}  // namespace goshawk::map_server
