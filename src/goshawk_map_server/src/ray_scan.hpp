#pragma once

#include <cstdint>
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
    for (const std::uint32_t line : lines_) {
      const std::uint32_t y = line % std::uint32_t(counts_.y);
      const std::uint32_t rest = line / std::uint32_t(counts_.y);
      const std::uint32_t z = rest % std::uint32_t(8 * counts_.z);
      const Index3 brick{lower_.x + int(rest / std::uint32_t(8 * counts_.z)), lower_.y + int(y),
                         lower_.z + int(z / 8)};
      const std::size_t at = std::size_t(line) * kLine;
      visit(brick, int(8 * (z % 8)), missed_.data() + at, hit_.data() + at);
    }
  }

  std::size_t memory_bytes() const { return 8 * (missed_.size() + hit_.size()) + touched_.size(); }

 private:
  struct Ray;
  template <bool kInside>
  void walk(const Ray& ray, Index3 last, int steps_y, int steps_z);
  void mark(std::int64_t row, int x0, int x1);
  void touch(std::size_t word);
  Index3 first_held(const Ray& ray, const BrickMap& map) const;
  bool grazes(const Ray& ray, Index3 voxel, const BrickMap& map) const;

  Index3 lower_, counts_;       // [bricks]
  Index3 size_;                 // [voxels]
  std::int64_t plane_ = 0;      // words of all rows with the same 64 x
  std::vector<Word> missed_, hit_;     // ((x / 64) * size z + z) * size y + y
  std::vector<std::uint8_t> touched_;  // of each line
  std::vector<std::uint32_t> lines_;
};

}  // namespace goshawk::map_server
