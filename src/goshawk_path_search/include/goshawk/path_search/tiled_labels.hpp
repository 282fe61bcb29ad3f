#pragma once

#include <cstdint>
#include <cstdlib>

#include "goshawk/path_search/labels.hpp"

namespace goshawk::path_search {

/// Labels in tiles of 4 x 4 x 4 voxels, 512 bytes each, made in the order in which searches first
/// touch them. The neighbours of a node lie in few cache lines, the labels of a search in few
/// pages, and a big map takes memory only for what its widest search reached.
///
/// A directory says where each tile of the map is: 8 bytes a tile. An entry counts if it bears the
/// number of the query, so nothing is cleared.
class TiledLabels : public QueryLabels {
 public:
  /// All labels empty. @return false if there is no memory for so many
  bool resize(Index3 size, std::int64_t nodes);

  /// Asks now for the memory of the directory, and of as many labels as a search of some length
  /// needs.
  void populate();

  /// Forgets all labels. Once in 32767 queries they are renewed, at the price of resize().
  /// @return false if that found no memory
  bool start_query();

  /// @pre inside the map
  Label& at(std::uint32_t, Index3 voxel) {
    std::uint64_t& entry = directory_[tile_of(voxel)];
    if (entry >> 32 != query_) entry = query_ << 32 | used_++;
    return memory_.data()[place_in(entry, voxel)];
  }
  /// @return 0, which is worse than any label of this query, for a tile that no search touched
  Label held(std::uint32_t, Index3 voxel) const {
    const std::uint64_t entry = directory_[tile_of(voxel)];
    return entry >> 32 == query_ ? memory_.data()[place_in(entry, voxel)] : 0;
  }

 private:
  std::size_t tile_of(Index3 v) const {
    return (std::size_t(v.z >> 2) * tiles_y_ + std::size_t(v.y >> 2)) * tiles_x_ +
           std::size_t(v.x >> 2);
  }
  static std::size_t place_in(std::uint64_t entry, Index3 v) {
    return std::size_t(entry & 0xFFFFFFFF) * 64 +
           std::size_t((v.z & 3) << 4 | (v.y & 3) << 2 | (v.x & 3));
  }

  static constexpr std::size_t kPopulated = std::size_t{1} << 18;  // labels

  Index3 size_;
  std::size_t tiles_x_ = 0;
  std::size_t tiles_y_ = 0;
  std::size_t tiles_ = 0;
  struct Free {
    void operator()(std::uint64_t* tiles) const { std::free(tiles); }
  };

  std::unique_ptr<std::uint64_t[], Free> directory_;  // query << 32 | number in memory_, by tile
  std::uint64_t used_ = 0;                            // tiles, in this query
  LabelMemory memory_;
};

}  // namespace goshawk::path_search
