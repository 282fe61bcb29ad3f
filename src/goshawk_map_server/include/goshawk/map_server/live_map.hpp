#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "goshawk/core/brick_map.hpp"
#include "goshawk/map_server/map_file.hpp"
#include "goshawk/map_server/map_journal.hpp"
#include "goshawk/map_server/odds_model.hpp"
#include "goshawk/map_server/voxel_map.hpp"

namespace goshawk::map_server {

struct LiveOptions {
  OddsModel odds = {};
  /// A ray that grazes a surface just before it ends in it does not count against the surface.
  bool keep_grazed = true;
  /// The window moves with the vehicle; its size is rounded up to whole bricks. What leaves it is
  /// kept, and comes back with it.
  bool follows = false;
  std::int64_t max_kept_bytes =
      1'000'000'000;                        // of what left; then the oldest is forgotten: unknown
  std::int64_t max_voxels = 1'000'000'000;  // of the window
};

/// One scan, frame map [m].
struct Scan {
  std::span<const Vec3> points_map;
  std::span<const Vec3> origins_map;  // where the sensor was: one for all points, or one a point
  double max_range_m = 30.0;          // longer rays clear space up to there and hit nothing
  /// Where the body has been since the last scan, the present place last. May be empty.
  std::span<const Vec3> body_path_map = {};
  /// Points nearer than this to the present place are the vehicle itself and count for nothing;
  /// voxels with their centre nearer than this to a place of the path are free. 0: neither.
  double body_radius_m = 0.0;
};

struct ScanResult {
  GridUpdate update;                 // brings the grid of before to that of now; may be empty
  std::int64_t points_left_out = 0;  // not finite, or at the sensor itself: missing returns
  std::int64_t points_on_body = 0;
  std::int64_t points_far = 0;  // farther from the sensor than SensorWatch::kNear_m
};

/// A window of the world that scans keep up to date (BrickMap), with the confidence of each voxel.
class LiveMap {
 public:
  /// @return as voxelize() and make_voxel_grid(); the grid has version 1. A map that follows takes
  /// options.box as its first window, and keeps the rest of the source
  static Result<LiveMap> from_source(const MapSource& source, const VoxelizeOptions& voxelize,
                                     const Growth& growth, const LiveOptions& options = {});

  /// A map that knows nothing yet. @param box [m] what the window covers at first
  /// @return invalid_parameter, map_too_large
  static Result<LiveMap> unknown_space(const Box& box, double resolution_m, const Growth& growth,
                                       const LiveOptions& options = {});

  LiveMap(LiveMap&&) noexcept;
  LiveMap& operator=(LiveMap&&) noexcept;
  ~LiveMap();

  GridGeometry geometry() const;
  const Growth& growth() const;
  std::uint64_t version() const;
  /// The window as a dense grid with raw voxels; its bits are its own.
  VoxelGrid grid() const;

  /// Moves the window if it follows, inserts a scan, and grows anew around what changed. The
  /// version rises by one, even if no brick changed. Allocates nothing once the bricks are known
  /// and `result` is used again.
  /// @return invalid_input, map_too_large; then nothing was inserted
  Status insert_scan(const Scan& scan, ScanResult& result);

  /// What another map knows takes the place of what was known there, as sure as a file. Bricks
  /// outside of a window that follows are kept beside it. The version rises by one.
  /// @return invalid_input for voxels of another size, or a map that the window does not meet;
  /// map_too_large; then nothing has changed
  Status insert_map(const RawVoxels& map, GridUpdate& update);

  /// All that is known: the window and what is kept beside it, on whole bricks.
  /// @return map_too_large beyond max_voxels
  Result<RawVoxels> world(std::int64_t max_voxels) const;
  /// What is kept beside the window, as a journal has it.
  std::vector<JournalBrick> bricks_outside() const;

  std::int64_t memory_bytes() const;
  /// Bricks that left the window and are kept, and those that were forgotten for want of memory.
  std::int64_t bricks_kept() const;
  std::int64_t bricks_forgotten() const;

 private:
  struct Parts;
  explicit LiveMap(std::unique_ptr<Parts> parts);

  std::unique_ptr<Parts> parts_;
};

}  // namespace goshawk::map_server
