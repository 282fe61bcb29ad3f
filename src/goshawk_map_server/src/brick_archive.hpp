#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <unordered_map>
#include <vector>

#include "goshawk/core/brick_map.hpp"

namespace goshawk::map_server {

/// What left the window: raw and known bits of bricks, without the rows that are all alike. A
/// brick of free space takes about 100 bytes.
class BrickArchive {
 public:
  /// @param max_bytes beyond it the bricks that left first are forgotten
  explicit BrickArchive(std::int64_t max_bytes) : max_bytes_(max_bytes) {}

  /// @param brick on the raster of the whole world @pre not in here
  void keep(Index3 brick, const BrickMap::Bits& bits);

  struct Kept {
    Brick::Words raw{}, known{};
  };
  /// @return the brick, which is forgotten here; nothing if it never left
  std::optional<Kept> take(Index3 brick);

  /// visit(Index3 brick, const Kept&) for each one, in no order
  template <typename Visit>
  void for_each(Visit&& visit) const {
    for (const auto& [brick, entry] : kept_) visit(brick, unpacked(entry));
  }

  std::size_t bricks() const { return kept_.size(); }
  std::int64_t forgotten() const { return forgotten_; }
  std::int64_t memory_bytes() const { return bytes_; }

 private:
  struct Hash {
    std::size_t operator()(const Index3& i) const {
      std::uint64_t h = std::uint64_t(std::uint32_t(i.x)) * 0x9E3779B97F4A7C15U;
      h = (h ^ std::uint32_t(i.y)) * 0xC2B2AE3D27D4EB4FU;
      return std::size_t((h ^ (h >> 29) ^ std::uint32_t(i.z)) * 0x165667B19E3779F9U);
    }
  };
  struct Entry {
    std::vector<std::uint64_t> words;
    std::uint64_t number = 0;  // when it came
  };
  static std::int64_t bytes_of(const Entry& entry);
  static Kept unpacked(const Entry& entry);
  void drop_taken();

  std::int64_t max_bytes_;
  std::int64_t bytes_ = 0, forgotten_ = 0;
  std::uint64_t next_number_ = 0;
  std::unordered_map<Index3, Entry, Hash> kept_;
  std::deque<std::pair<std::uint64_t, Index3>> order_;  // some may have been taken since
};

}  // namespace goshawk::map_server
