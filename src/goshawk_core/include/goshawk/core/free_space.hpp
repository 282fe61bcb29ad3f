#pragma once

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "goshawk/core/grid_geometry.hpp"

namespace goshawk {

/// The space that a map lets the vehicle's centre fly through. If the map leaves unknown space free
/// (for planning), a voxel is free here only if the whole body was seen free there: it is not
/// grown, and every voxel of the map within the inflation is known. The body may stick out of the
/// map's faces, which do not grow (docs/adr/0005). If the map counts unknown space as
/// occupied, its grown bits say all.
///
/// A map may keep a reserve: its grown bits then reach farther than its inflation, so that plans
/// keep more than what is flown must keep. If such a map brings raw voxels, these decide here, with
/// the inflation alone: a voxel that becomes an obstacle within the reserve blocks new plans, but
/// not what is flown.
///
/// The body is looked at only where it is asked for: nothing is grown for the whole map.
class FreeSpace {
 public:
  /// No map yet. @param fly_unknown what the map leaves free is flown through, seen or not
  explicit FreeSpace(bool fly_unknown = false) : fly_unknown_(fly_unknown) {}
  FreeSpace(std::shared_ptr<const VoxelGrid> grid, bool fly_unknown = false)
      : FreeSpace(fly_unknown) {
    set_map(std::move(grid));
  }

  /// Allocates only if the inflation in voxels changes. @pre grid->check() ok
  void set_map(std::shared_ptr<const VoxelGrid> grid);
  /// nullptr before the first.
  const VoxelGrid* grid() const { return grid_.get(); }
  const std::shared_ptr<const VoxelGrid>& map() const { return grid_; }

  /// Does it count as blocked what the map leaves free, since it was not seen?
  bool asks_for_known() const { return asks_for_known_; }
  /// @return false outside of the map. @pre a map has come
  bool is_free(Index3 voxel) const;

  /// A row of the body's voxels, around the centre's.
  struct Row {
    int dy, dz, half_extent;
  };
  /// What decides, for code that looks at rows of voxels.
  struct View {
    const VoxelGrid* grid;
    std::span<const Row> body = {};  // empty: grown bits alone decide
    bool asks_for_known = false;     // what was not seen is blocked
    bool asks_for_raw = false;       // raw voxels decide, not the grown ones
  };
  /// @pre a map has come
  View view() const { return {grid_.get(), body_, asks_for_known_, asks_for_raw_}; }

 private:
  bool fly_unknown_;
  std::shared_ptr<const VoxelGrid> grid_;
  std::vector<Row> body_;
  double body_voxels_ = -1.0;  // the inflation that body_ was made for
  Index3 body_size_;
  bool asks_for_known_ = false;
  bool asks_for_raw_ = false;
};

/// The first voxel x0 <= x <= x1 of a row that is blocked. @pre the row lies inside the grid
std::optional<Index3> first_blocked(const FreeSpace::View& space, int x0, int x1, int y, int z);

}  // namespace goshawk
