#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "brick_archive.hpp"
#include "goshawk/map_server/live_map.hpp"
#include "goshawk/map_server/map_journal.hpp"
#include "odds_store.hpp"
#include "ray_scan.hpp"

namespace goshawk::map_server {

/// The window of a LiveMap: bits, confidence, and what left. Places are voxels on the raster of the
/// world, which does not move.
class LiveWindow {
 public:
  /// @param geometry of the first window; its origin is on the raster of voxels of this size
  static Result<LiveWindow> make(const GridGeometry& geometry, const Growth& growth,
                                 const LiveOptions& options);

  const BrickMap& map() const { return map_; }
  GridGeometry geometry() const;

  /// What a file knows takes the place of what was known there: in the window, and kept beside it
  /// if the window follows.
  void fill(const RawVoxels& raw);
  void grow() { map_.regrow(); }

  /// @return by how many bricks the window moved to have this point near its middle
  Index3 follow(const Vec3& p_map);

  /// @pre finite numbers, origins within 2^29 voxels of the window
  void insert(const Scan& scan, ScanResult& result);
  void clear_body(std::span<const Vec3> path_map, double radius_m);
  /// Grows anew, and lists what changed since the last call.
  void list_changes(std::vector<Brick>& bricks);

  const BrickArchive& archive() const { return archive_; }
  /// What left the window or was never in it.
  std::vector<JournalBrick> bricks_outside() const;
  /// The window and what is kept beside it. @return map_too_large beyond max_voxels
  Result<RawVoxels> world(std::int64_t max_voxels) const;
  std::int64_t memory_bytes() const;

 private:
  LiveWindow(BrickMap map, const GridGeometry& geometry, const LiveOptions& options);

  void cast(const Scan& scan, ScanResult& result);
  void choose_box(const Scan& scan);
  void integrate();
  void clear_voxel(Index3 voxel);
  void fill_brick(Index3 brick, const BrickMap::Bits& bits);
  Index3 corner_of(Index3 brick) const;
  Vec3 lower_voxel() const;  // of the window, on the raster
  Vec3 to_voxels(const Vec3& p_map) const;
  std::size_t flat(Index3 brick) const;
  void bring_back();

  BrickMap map_;
  LiveOptions options_;
  double resolution_m_;
  Index3 lower_voxel_;  // of the first window, on the raster
  Index3 moved_;        // [bricks] since then
  OddsStore odds_;
  RayScan rays_;
  BrickArchive archive_;
  bool box_empty_ = true;  // no ray of the scan can meet the window
};

}  // namespace goshawk::map_server
