#pragma once

#include <cstdint>
#include <cstring>
#include <vector>

#include "goshawk/core/brick_map.hpp"

namespace goshawk::map_server {

/// The rays of one scan as bits: which voxels of a box of bricks they end in, and which they pass
/// through. Rays are walked exactly, row by row: every voxel whose inside they cross is met, and
/// no other (a ray along a face belongs to the upper voxel).
class RayScan {
 public:
  using Word = BrickMap::Word;
  static constexpr int kLine = 8;  // rows of a line: those of one brick with the same z

  /// Clears, for the bricks lower <= b < lower + counts of the map.
  void begin(Index3 lower, Index3 counts);

  /// @param from, to [voxels] from the map's corner, within 2^30 of it; what lies outside the box
  /// is cut off
  /// @param hits whether the ray ends at something; the last voxel is not passed through
  /// @param held may be null; obstacles in it that the ray grazes just before it ends at the same
  /// surface are not passed through
  void cast(const Vec3& from, const Vec3& to, bool hits, const BrickMap* held);

  /// visit(Index3 brick, int first row, const Word* missed, const Word* hit) for each line that
  /// was touched; both point to 8 words. A voxel may be in both.
  template <typename Visit>
  void for_lines(Visit&& visit) const {
    for_touched([&](std::size_t line) {
      const std::size_t rest = line / std::size_t(counts_.y);
      const int z = int(rest % std::size_t(size_.z));
      const Index3 brick{lower_.x + int(rest / std::size_t(size_.z)),
                         lower_.y + int(line % std::size_t(counts_.y)), lower_.z + z / 8};
      const std::size_t at = line * kLine;
      visit(brick, 8 * (z % 8), missed_.data() + at, hit_.data() + at);
    });
  }

  std::size_t memory_bytes() const { return 8 * (missed_.size() + hit_.size()) + touched_.size(); }

 private:
  struct Ray;
  struct Marks;
  template <bool kInside>
  void walk(const Ray& ray, Index3 last, int steps_y, int steps_z);
  // In the order of their place; lines that were not touched are passed over by eights.
  template <typename Visit>
  void for_touched(Visit&& visit) const {
    const std::size_t lines = std::size_t(plane_) / kLine * std::size_t(counts_.x);
    for (std::size_t first = 0; first < lines; first += 8) {
      std::uint64_t eight;  // counts_.z brings 8 lines each: always whole
      std::memcpy(&eight, touched_.data() + first, sizeof eight);
      if (eight == 0) continue;
      for (std::size_t line = first; line < first + 8; ++line) {
        if (touched_[line] != 0) visit(line);
      }
    }
  }
  Index3 first_held(const Ray& ray, const BrickMap& map) const;
  bool grazes(const Ray& ray, Index3 voxel, const BrickMap& map) const;

  Index3 lower_, counts_;       // [bricks]
  Index3 size_;                 // [voxels]
  std::int64_t plane_ = 0;      // words of all rows with the same 64 x
  std::vector<Word> missed_, hit_;     // ((x / 64) * size z + z) * size y + y
  std::vector<std::uint8_t> touched_;  // of each line
};

}  // namespace goshawk::map_server
