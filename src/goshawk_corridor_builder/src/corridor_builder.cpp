#include "goshawk/corridor_builder/corridor_builder.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>
#include <vector>

#include "box_growth.hpp"
#include "chain.hpp"
#include "joint_relaxation.hpp"
#include "joints.hpp"
#include "segment_polytope.hpp"

namespace goshawk::corridor_builder {
namespace {

constexpr double kLeastOverlap_m = 1e-6;
constexpr double kSpare = 0.499;        // [voxel edges] half a voxel, less what planes keep away
constexpr double kMostRounding = 1e-5;  // [voxel edges] beyond it planes are not worth the name

std::string segment_text(std::span<const Vec3> path, int k) {
  const auto i = std::size_t(k);
  return "segment " + std::to_string(k) + " from " + to_text(path[i]) + " to " +
         to_text(path[i + 1]);
}

std::string number_text(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.3g", value);
  return text;
}

// Every fault of a config, by its own description.
struct Faults {
  std::string text;

  void note(const char* name, const std::string& rule) {
    text += (text.empty() ? "" : "; ") + std::string(name) + " " + rule;
  }
  template <typename Value>
  void operator()(const char* name, const Value& value, const char*, const char*, Range range) {
    if (range.contains(double(value))) return;
    note(name, "is " + number_text(double(value)) + ", must be " +
                   (range.above_lo ? "above " : "at least ") + number_text(range.lo) +
                   " and at most " + number_text(range.hi));
  }
  void operator()(const char* name, const std::string& value, const char*, const char*,
                  const OneOf& words) {
    const auto& all = words.choices;
    if (std::find(all.begin(), all.end(), value) != all.end()) return;
    std::string list;
    for (const std::string& word : all) list += (list.empty() ? "" : ", ") + word;
    note(name, "is '" + value + "', must be one of " + list);
  }
  void operator()(const char*, bool, const char*, const char*, Anything) {}
};

}  // namespace

class CorridorBuilder::Impl {
 public:
  explicit Impl(const Config& c) : config(c), segment_polytope_(c), box_growth_(c) {}

  Result<Corridor> build(const VoxelGrid& grid, std::span<const Vec3> path);

  Config config;

 private:
  Status check_grid(const VoxelGrid& grid);
  Status check_path(const VoxelGrid& grid, std::span<const Vec3> path) const;
  Status check_room(std::span<const Vec3> path) const;
  void split(const VoxelGrid& grid, std::span<const Vec3> path);
  std::optional<Blockage> wrap(const VoxelGrid& grid);
  std::size_t covered_until(const Polytope& polytope, std::size_t end, double spare_m) const;
  Error blocked(const VoxelGrid& grid, std::span<const Vec3> path, const Blockage& at) const;

  SegmentPolytope segment_polytope_;
  BoxGrowth box_growth_;
  JointRelaxation relaxation_;
  Margins margins_;
  std::vector<PathPoint> points_;
  Chain chain_;
  std::vector<Ball> overlaps_;
};

Result<Corridor> CorridorBuilder::Impl::build(const VoxelGrid& grid, std::span<const Vec3> path) {
  if (auto status = check_grid(grid); !status) return status.error();
  if (auto status = check_path(grid, path); !status) return status.error();
  split(grid, path);
  const auto blockage =
      config.generator == "box" ? box_growth_.build(grid, points_, margins_, chain_) : wrap(grid);
  if (blockage) return blocked(grid, path, *blockage);
  measure_overlaps(chain_.polytopes, overlaps_);
  for (int k = 0; k < config.relax_passes && config.generator != "box"; ++k) {
    relaxation_.relax(grid, config.wanted_overlap_voxels * grid.geometry.resolution_m, margins_,
                      segment_polytope_, chain_, overlaps_);
  }
  if (config.drop_covered) drop_covered(grid.geometry.resolution_m, chain_, overlaps_);
  if (auto status = check_room(path); !status) return status.error();
  settle_joints(config.joint_clearance_voxels * grid.geometry.resolution_m, overlaps_, chain_);
  // The answer is moved out: nothing else is allocated once the working memory has grown.
  return Corridor{std::move(chain_.joints_map), std::move(chain_.polytopes), std::move(overlaps_)};
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

Status CorridorBuilder::Impl::check_path(const VoxelGrid& grid, std::span<const Vec3> path) const {
  if (path.size() < 2) {
    return fail(ErrorCode::invalid_input, "the path has " + std::to_string(path.size()) +
                                              " points: a corridor needs a start and a goal");
  }
  for (std::size_t i = 0; i < path.size(); ++i) {
    if (is_finite(path[i])) continue;
    return fail(ErrorCode::invalid_input,
                "waypoint " + std::to_string(i) + " of the path is not finite");
  }
  const Vec3 upper(grid.geometry.size.x, grid.geometry.size.y, grid.geometry.size.z);
  for (std::size_t i = 0; i < path.size(); ++i) {
    const Vec3 p = grid.geometry.to_grid(path[i]);
    if ((p.array() >= -margins_.touch).all() &&
        (p.array() <= upper.array() + margins_.touch).all()) {
      continue;
    }
    return fail(ErrorCode::segment_blocked, segment_text(path, int(i == 0 ? 0 : i - 1)) +
                                                " leaves the map, which spans " +
                                                to_text(grid.geometry.origin_map) + " to " +
                                                to_text(grid.geometry.upper_corner_map()));
  }
  return success();
}

// Obstacles that touch each other leave a path between them, but no room to fly.
Status CorridorBuilder::Impl::check_room(std::span<const Vec3> path) const {
  const char* squeezes = ": the path squeezes between obstacles that touch; search it without";
  const Polytope& first = chain_.polytopes.front();
  const Vec3 middle = 0.5 * (chain_.joints_map[0] + chain_.joints_map[1]);
  if (overlaps_.empty() && first.violation(middle) > -kLeastOverlap_m &&
      !(chebyshev_ball(first).radius_m > kLeastOverlap_m)) {
    return fail(ErrorCode::segment_blocked, segment_text(path, 0) + " has no room" + squeezes);
  }
  for (std::size_t k = 0; k < overlaps_.size(); ++k) {
    if (overlaps_[k].radius_m > kLeastOverlap_m) continue;
    return fail(ErrorCode::corridor_disjoint, "polytopes " + std::to_string(k) + " and " +
                                                  std::to_string(k + 1) + " share no ball near " +
                                                  to_text(chain_.joints_map[k + 1]) + squeezes);
  }
  return success();
}

// Long segments in equal parts; waypoints that repeat are left out, but for a path of no length.
void CorridorBuilder::Impl::split(const VoxelGrid& grid, std::span<const Vec3> path) {
  points_.clear();
  auto add = [&](const Vec3& p, std::size_t segment) {
    points_.push_back({p, grid.geometry.to_grid(p), int(segment)});
  };
  add(path[0], 0);
  for (std::size_t i = 0; i + 1 < path.size(); ++i) {
    const double length = (path[i + 1] - path[i]).norm();
    const bool last = i + 2 == path.size();
    if (length == 0.0 && !(last && points_.size() == 1)) continue;
    points_.back().segment = int(i);
    const double parts = std::max(1.0, std::ceil(length / config.max_segment_m));
    for (double k = 1.0; k < parts; ++k) {
      add(path[i] + (k / parts) * (path[i + 1] - path[i]), i);
    }
    add(path[i + 1], i);
  }
  points_.back().p_map = path.back();
}

// The ellipsoid generator, segment by segment; parts of the path that the polytope before holds
// with half a voxel to spare need none of their own.
std::optional<Blockage> CorridorBuilder::Impl::wrap(const VoxelGrid& grid) {
  chain_.clear();
  chain_.joints_map.push_back(points_.front().p_map);
  for (std::size_t i = 0; i + 1 < points_.size();) {
    Polytope polytope;
    const auto at =
        segment_polytope_.build(grid, points_[i].p_grid, points_[i + 1].p_grid, margins_, polytope);
    if (at) return Blockage{points_[i].segment, *at};
    i = config.drop_covered ? covered_until(polytope, i + 1, kSpare * grid.geometry.resolution_m)
                            : i + 1;
    chain_.joints_map.push_back(points_[i].p_map);
    chain_.polytopes.push_back(std::move(polytope));
  }
  return std::nullopt;
}

std::size_t CorridorBuilder::Impl::covered_until(const Polytope& polytope, std::size_t end,
                                                 double spare_m) const {
  while (end + 1 < points_.size() && polytope.violation(points_[end + 1].p_map) <= -spare_m) ++end;
  return end;
}

Error CorridorBuilder::Impl::blocked(const VoxelGrid& grid, std::span<const Vec3> path,
                                     const Blockage& at) const {
  const Vec3 place = grid.geometry.origin_map + grid.geometry.resolution_m * at.p_grid;
  return fail(ErrorCode::segment_blocked,
              segment_text(path, at.segment) + " is blocked near " + to_text(place) +
                  ": an obstacle (grown by " + number_text(grid.inflation_m) +
                  " m) is in the way; search the path on this map again");
}

Result<CorridorBuilder> CorridorBuilder::create(const Config& config) {
  Faults faults;
  describe(config, faults);
  if (!faults.text.empty()) return fail(ErrorCode::invalid_parameter, faults.text);
  return CorridorBuilder(std::make_unique<Impl>(config));
}

CorridorBuilder::CorridorBuilder(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
CorridorBuilder::CorridorBuilder(CorridorBuilder&&) noexcept = default;
CorridorBuilder& CorridorBuilder::operator=(CorridorBuilder&&) noexcept = default;
CorridorBuilder::~CorridorBuilder() = default;

Result<Corridor> CorridorBuilder::build(const VoxelGrid& grid,
                                        std::span<const Vec3> waypoints_map) {
  return impl_->build(grid, waypoints_map);
}

std::string_view CorridorBuilder::implementation() const {
  return impl_->config.generator;
}

}  // namespace goshawk::corridor_builder
