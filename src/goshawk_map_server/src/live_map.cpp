#include "goshawk/map_server/live_map.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <new>

#include "growth.hpp"
#include "live_window.hpp"

namespace goshawk::map_server {
namespace {

constexpr double kFarthest_voxels = double(1 << 29);  // voxels are numbered in 32 bits

Status check_scan(const Scan& scan, const GridGeometry& geometry) {
  const bool counts =
      scan.origins_map.size() == 1 ||
      (!scan.origins_map.empty() && scan.origins_map.size() == scan.points_map.size());
  if (!counts || !std::ranges::all_of(scan.origins_map, is_finite) ||
      !(std::isfinite(scan.max_range_m) && scan.max_range_m > 0.0)) {
    return fail(ErrorCode::invalid_input,
                "a scan needs a finite range above zero, and a finite sensor origin for all points "
                "or one for each");
  }
  if (!std::ranges::all_of(scan.body_path_map, is_finite) ||
      !(std::isfinite(scan.body_radius_m) && scan.body_radius_m >= 0.0)) {
    return fail(ErrorCode::invalid_input,
                "a scan's body needs finite places and a finite radius of at least zero");
  }
  const double reach_m = kFarthest_voxels * geometry.resolution_m - scan.max_range_m;
  const auto near = [&](const Vec3& p) { return p.cwiseAbs().maxCoeff() <= reach_m; };
  if (!std::ranges::all_of(scan.origins_map, near) ||
      !std::ranges::all_of(scan.body_path_map, near)) {
    return fail(ErrorCode::map_too_large,
                fmt::format("the sensor at {} m is more than 2^29 voxels of {:g} m from the origin "
                            "of the map frame: choose an origin near the flight",
                            to_text(scan.origins_map.front()), geometry.resolution_m));
  }
  return success();
}

Status check_map(const GridGeometry& map, const GridGeometry& window, bool follows) {
  const double resolution_m = window.resolution_m;
  if (std::abs(map.resolution_m - resolution_m) > 1e-9 * resolution_m) {
    return fail(ErrorCode::invalid_input,
                fmt::format("the map has voxels of {:g} m, the map server of {:g} m: they must be "
                            "of one size",
                            map.resolution_m, resolution_m));
  }
  const Vec3 lower = map.origin_map, upper = map.upper_corner_map();
  if (std::max(lower.cwiseAbs().maxCoeff(), upper.cwiseAbs().maxCoeff()) >
      kFarthest_voxels * resolution_m) {
    return fail(
        ErrorCode::map_too_large,
        fmt::format("the map reaches more than 2^29 voxels of {:g} m from the origin of the "
                    "map frame",
                    resolution_m));
  }
  const bool meets = (lower.array() < window.upper_corner_map().array()).all() &&
                     (upper.array() > window.origin_map.array()).all();
  if (!meets && !follows) {
    return fail(
        ErrorCode::invalid_input,
        fmt::format("the map, from {} to {} m, lies outside of the map server's box, from {} "
                    "to {} m: nothing of it is taken",
                    to_text(lower), to_text(upper), to_text(window.origin_map),
                    to_text(window.upper_corner_map())));
  }
  return success();
}

}  // namespace

struct LiveMap::Parts {
  LiveWindow window;
  Growth growth;
  LiveOptions options;
  std::uint64_t version = 1;
};

LiveMap::LiveMap(std::unique_ptr<Parts> parts) : parts_(std::move(parts)) {}
LiveMap::LiveMap(LiveMap&&) noexcept = default;
LiveMap& LiveMap::operator=(LiveMap&&) noexcept = default;
LiveMap::~LiveMap() = default;

Result<LiveMap> LiveMap::from_source(const MapSource& source, const VoxelizeOptions& options,
                                     const Growth& growth, const LiveOptions& live) try {
  VoxelizeOptions what = options;
  if (live.follows) what.box = {};  // all of it: what lies outside the window is kept
  const auto raw = voxelize(source, what);
  if (!raw) return raw.error();
  GridGeometry geometry = raw->geometry;
  if (live.follows && options.box) {
    const auto chosen = raster_of(*options.box, geometry.resolution_m, live.max_voxels);
    if (!chosen) return chosen.error();
    geometry = *chosen;
  }
  auto window = LiveWindow::make(geometry, growth, live);
  if (!window) return window.error();
  window->fill(*raw);
  window->grow();
  if (!live.follows && !window->map().any_free()) return nothing_free(growth);
  return LiveMap(std::make_unique<Parts>(Parts{*std::move(window), growth, live}));
} catch (const std::bad_alloc&) {
  return fail(ErrorCode::map_too_large, "the map does not fit into memory: give a smaller box");
}

Result<LiveMap> LiveMap::unknown_space(const Box& box, double resolution_m, const Growth& growth,
                                       const LiveOptions& live) {
  const auto geometry = raster_of(box, resolution_m, live.max_voxels);
  if (!geometry) return geometry.error();
  auto window = LiveWindow::make(*geometry, growth, live);
  if (!window) return window.error();
  return LiveMap(std::make_unique<Parts>(Parts{*std::move(window), growth, live}));
}

GridGeometry LiveMap::geometry() const {
  return parts_->window.geometry();
}
const Growth& LiveMap::growth() const {
  return parts_->growth;
}
std::uint64_t LiveMap::version() const {
  return parts_->version;
}

VoxelGrid LiveMap::grid() const {
  const BrickMap& map = parts_->window.map();
  VoxelGrid grid{.geometry = geometry(),
                 .grown = BitGrid(map.size(), true, map.default_grown()),
                 .known = BitGrid(map.size(), false),
                 .raw = BitGrid(map.size(), true),
                 .version = parts_->version,
                 .inflation_m = parts_->growth.inflation_m,
                 .unknown_is_occupied = map.growth().unknown_is_occupied,
                 .unknown_grows = map.growth().unknown_grows};
  map.write_dense(grid.grown, grid.known, grid.raw);
  return grid;
}

Status LiveMap::insert_scan(const Scan& scan, ScanResult& result) {
  LiveWindow& window = parts_->window;
  if (auto status = check_scan(scan, window.geometry()); !status) return status;
  GridUpdate& update = result.update;
  update.shift = {};
  if (parts_->options.follows) {
    update.shift = window.follow(scan.body_path_map.empty() ? scan.origins_map.front()
                                                            : scan.body_path_map.back());
  }
  window.insert(scan, result);
  window.clear_body(scan.body_path_map, scan.body_radius_m);
  window.list_changes(update.bricks);
  update.from_version = parts_->version;
  update.to_version = ++parts_->version;
  return success();
}

Status LiveMap::insert_map(const RawVoxels& map, GridUpdate& update) {
  LiveWindow& window = parts_->window;
  if (auto s = check_map(map.geometry, window.geometry(), parts_->options.follows); !s) return s;
  update.shift = {};
  window.fill(map);
  window.list_changes(update.bricks);
  update.from_version = parts_->version;
  update.to_version = ++parts_->version;
  return success();
}

Result<RawVoxels> LiveMap::world(std::int64_t max_voxels) const {
  return parts_->window.world(max_voxels);
}
std::vector<JournalBrick> LiveMap::bricks_outside() const {
  return parts_->window.bricks_outside();
}

std::int64_t LiveMap::memory_bytes() const {
  return parts_->window.memory_bytes();
}
std::int64_t LiveMap::bricks_kept() const {
  return std::int64_t(parts_->window.archive().bricks());
}
std::int64_t LiveMap::bricks_forgotten() const {
  return parts_->window.archive().forgotten();
}

}  // namespace goshawk::map_server
