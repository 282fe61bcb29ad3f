#include "goshawk/corridor_builder/corridor_builder.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "box_expansion.hpp"
#include "chain.hpp"
#include "path_wrapper.hpp"
#include "waypoints.hpp"

namespace goshawk::corridor_builder {
namespace {

constexpr double kLeastOverlap_m = 1e-6;
constexpr double kMostRadius = 1000.0;  // [voxel edges] of a vehicle
constexpr double kMostRounding = 1e-5;  // [voxel edges] beyond it planes are not worth the name

std::string segment_text(std::span<const Vec3> path, int k) {
  const auto i = std::size_t(k);
  return fmt::format("segment {} from {} to {}", k, to_text(path[i]), to_text(path[i + 1]));
}

// Is a voxel at p, or one that touches it, blocked because it was never measured?
bool touches_unknown(const VoxelGrid& grid, const Vec3& p) {
  if (!grid.unknown_is_occupied) return false;
  for (unsigned corner = 0; corner < 8; ++corner) {
    const Vec3 side((corner & 1U) ? 1e-6 : -1e-6, (corner & 2U) ? 1e-6 : -1e-6,
                    (corner & 4U) ? 1e-6 : -1e-6);
    const Vec3 f = (p + side).array().floor();
    const Index3 i{int(f.x()), int(f.y()), int(f.z())};
    if (grid.grown.contains(i) && grid.grown.get(i) && !grid.is_known(i)) return true;
  }
  return false;
}

// A path of no length at all is a vehicle that stays, or turns, where it is. Within a path that
// leads somewhere, a segment of no length is a fault of the sender.
Status check_lengths(std::span<const Vec3> path) {
  const auto differs = [&](const Vec3& p) { return p != path.front(); };
  if (std::ranges::none_of(path, differs)) return success();
  const auto twice = std::ranges::adjacent_find(path);
  if (twice == path.end()) return success();
  return fail(ErrorCode::invalid_input, segment_text(path, int(twice - path.begin())) +
                                            " has no length: leave one of its points out");
}

}  // namespace

class CorridorBuilder::Impl {
 public:
  explicit Impl(const Config& c) : config(c), path_wrapper_(c), box_expansion_(c) {}

  Status build(const VoxelGrid& grid, std::span<const Vec3> path, Corridor& corridor);

  Config config;

 private:
  Status check_grid(const VoxelGrid& grid);
  Status check_raw(const VoxelGrid& grid) const;
  Status check_path(const VoxelGrid& grid, std::span<const Vec3> path) const;
  Status check_room(std::span<const Vec3> path) const;
  ObstacleLayers layers(const VoxelGrid& grid) const;
  void improve(double resolution_m);
  void write(Corridor& corridor) const;
  Error blocked(const VoxelGrid& grid, std::span<const Vec3> path, const Blockage& at) const;

  PathWrapper path_wrapper_;
  BoxExpansion box_expansion_;
  Margins margins_;
  std::vector<PathPoint> points_;
  Chain chain_;
};

Status CorridorBuilder::Impl::build(const VoxelGrid& grid, std::span<const Vec3> path,
                                    Corridor& corridor) {
  if (auto status = check_grid(grid); !status) return status;
  if (auto status = check_raw(grid); !status) return status;
  if (auto status = check_path(grid, path); !status) return status;
  split_path(grid.geometry, path, config.max_segment_m, points_);
  const auto blockage = config.generator == Generator::box
                            ? box_expansion_.build(grid, points_, margins_, chain_)
                            : path_wrapper_.wrap(grid, layers(grid), margins_, points_, chain_);
  if (blockage) return blocked(grid, path, *blockage);
  improve(grid.geometry.resolution_m);
  if (auto status = check_room(path); !status) return status;
  settle_waypoints(config.waypoint_clearance_voxels * grid.geometry.resolution_m, chain_);
  write(corridor);
  return success();
}

ObstacleLayers CorridorBuilder::Impl::layers(const VoxelGrid& grid) const {
  if (config.margin != Margin::sphere) {
    return {{{{{.set = &grid.grown}, 0.0}, {}}}, grid.geometry};
  }
  const BitGrid* known = grid.unknown_is_occupied && !grid.known.empty() ? &grid.known : nullptr;
  const double radius = grid.inflation_m / grid.geometry.resolution_m;
  if (grid.unknown_grows) return {{{{{&grid.raw, known}, radius}, {}}}, grid.geometry};
  return {{{{{.set = &grid.raw}, radius}, {{.known = known}, 0.0}}}, grid.geometry};
}

void CorridorBuilder::Impl::improve(double resolution_m) {
  if (config.generator == Generator::box) measure_overlaps(chain_);
  if (!config.drop_covered) return;
  const bool boxes = config.generator == Generator::box;  // which measure no room around points
  auto room_m = [&](const PathPoint& point) {
    return (boxes ? kHalfVoxel : point.wanted) * resolution_m;
  };
  drop_covered(resolution_m, room_m(points_.front()), room_m(points_.back()), chain_);
}

// Into memory that the caller keeps.
void CorridorBuilder::Impl::write(Corridor& corridor) const {
  corridor.waypoints_map.assign(chain_.waypoints_map.begin(), chain_.waypoints_map.end());
  corridor.overlaps.assign(chain_.overlaps.begin(), chain_.overlaps.end());
  corridor.polytopes.resize(chain_.size());
  for (std::size_t k = 0; k < chain_.size(); ++k) {
    corridor.polytopes[k] = chain_[k];
  }
}

// Sets the margins for the map's coordinates as well.
Status CorridorBuilder::Impl::check_grid(const VoxelGrid& grid) {
  if (auto status = grid.check(); !status) return status;
  const Vec3 origin = grid.geometry.origin_map.cwiseAbs() / grid.geometry.resolution_m;
  const Index3 size = grid.geometry.size;
  margins_ = Margins::for_coordinates(origin.maxCoeff() + std::max({size.x, size.y, size.z}));
  if (margins_.rounding < kMostRounding) return success();
  return fail(ErrorCode::invalid_input,
              "the map's origin " + to_text(grid.geometry.origin_map) +
                  " is too far away for exact planes: choose a map frame nearer to the map");
}

Status CorridorBuilder::Impl::check_raw(const VoxelGrid& grid) const {
  if (config.margin != Margin::sphere || config.generator == Generator::box) return success();
  if (grid.raw.empty()) {
    return fail(ErrorCode::invalid_input,
                "margin 'sphere' needs the obstacles as measured, which this map does not bring: "
                "set publish_raw of map_server, or use margin 'grown_grid'");
  }
  const double radius = grid.inflation_m / grid.geometry.resolution_m;
  if (radius >= 0.0 && radius <= kMostRadius) return success();
  return fail(ErrorCode::invalid_input,
              fmt::format("the map's obstacles were inflated by {:.3g} m: for margin 'sphere' it "
                          "must be at least 0 and at most {:g} voxels",
                          grid.inflation_m, kMostRadius));
}

Status CorridorBuilder::Impl::check_path(const VoxelGrid& grid, std::span<const Vec3> path) const {
  if (path.size() < 2) {
    return fail(
        ErrorCode::invalid_input,
        fmt::format("the path has {} points: a corridor needs a start and a goal", path.size()));
  }
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (is_finite(path[i])) continue;
    return fail(ErrorCode::invalid_input,
                fmt::format("waypoint {} of the path, an end of segment {}, is not finite", i,
                            i == 0 ? 0 : i - 1));
  }
  if (auto status = check_lengths(path); !status) return status;
  const Vec3 upper(grid.geometry.size.x, grid.geometry.size.y, grid.geometry.size.z);
  for (std::size_t i = 0; i < path.size(); ++i) {
    const Vec3 p = grid.geometry.to_grid(path[i]);
    if ((p.array() >= -margins_.touch).all() &&
        (p.array() <= upper.array() + margins_.touch).all()) {
      continue;
    }
    return fail(ErrorCode::segment_blocked, fmt::format("{} leaves the map, which spans {} to {}",
                                                        segment_text(path, int(i == 0 ? 0 : i - 1)),
                                                        to_text(grid.geometry.origin_map),
                                                        to_text(grid.geometry.upper_corner_map())));
  }
  return success();
}

// Obstacles that touch each other leave a path between them, but no room to fly.
Status CorridorBuilder::Impl::check_room(std::span<const Vec3> path) const {
  const char* squeezes = ": the path squeezes between obstacles that touch; search it without";
  const Polytope& first = chain_[0];
  const Vec3 middle = 0.5 * (chain_.waypoints_map[0] + chain_.waypoints_map[1]);
  if (chain_.overlaps.empty() && -first.violation(middle) < kLeastOverlap_m &&
      !(chebyshev_ball(first).radius_m > kLeastOverlap_m)) {
    return fail(ErrorCode::segment_blocked, segment_text(path, 0) + " has no room" + squeezes);
  }
  for (std::size_t k = 0; k < chain_.overlaps.size(); ++k) {
    if (chain_.overlaps[k].radius_m > kLeastOverlap_m) continue;
    return fail(ErrorCode::corridor_disjoint,
                fmt::format("polytopes {} and {} share no ball near {}{}", k, k + 1,
                            to_text(chain_.waypoints_map[k + 1]), squeezes));
  }
  return success();
}

Error CorridorBuilder::Impl::blocked(const VoxelGrid& grid, std::span<const Vec3> path,
                                     const Blockage& at) const {
  const Vec3 place = grid.geometry.origin_map + grid.geometry.resolution_m * at.p_grid;
  const std::string what =
      touches_unknown(grid, at.p_grid)
          ? "space that was never measured counts as an obstacle there"
          : fmt::format("an obstacle (inflated by {:.3g} m) is in the way", grid.inflation_m);
  return fail(ErrorCode::segment_blocked,
              fmt::format("{} is blocked near {}: {}; search the path on this map again",
                          segment_text(path, at.segment), to_text(place), what));
}

Result<CorridorBuilder> CorridorBuilder::create(const Config& config) {
  ParameterFaults faults;
  describe(config, faults);
  if (auto status = faults.status(); !status) return status.error();
  return CorridorBuilder(std::make_unique<Impl>(config));
}

Status CorridorBuilder::reconfigure(const Config& config) {
  auto other = create(config);
  if (!other) return other.error();
  *this = *std::move(other);
  return success();
}

CorridorBuilder::CorridorBuilder(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
CorridorBuilder::CorridorBuilder(CorridorBuilder&&) noexcept = default;
CorridorBuilder& CorridorBuilder::operator=(CorridorBuilder&&) noexcept = default;
CorridorBuilder::~CorridorBuilder() = default;

Result<Corridor> CorridorBuilder::build(const VoxelGrid& grid,
                                        std::span<const Vec3> waypoints_map) {
  Corridor corridor;
  if (auto status = impl_->build(grid, waypoints_map, corridor); !status) return status.error();
  return corridor;
}

Status CorridorBuilder::build(const VoxelGrid& grid, std::span<const Vec3> waypoints_map,
                              Corridor& corridor) {
  return impl_->build(grid, waypoints_map, corridor);
}

std::string_view CorridorBuilder::implementation() const {
  return to_word(impl_->config.generator);
}

}  // namespace goshawk::corridor_builder
