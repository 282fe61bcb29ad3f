#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "goshawk/core/grid_geometry.hpp"

namespace goshawk {
namespace {

constexpr double kFarthestReserve = 4.0;  // [inflations] within which a cause is looked for
constexpr int kMostReach = 50;  // [voxels] around a point in which the cause is looked for

/// The nearest voxel that keeps a point's voxel blocked, of one kind.
struct Cause {
  Index3 voxel;
  double squared = std::numeric_limits<double>::infinity();  // [voxels^2] between the two cubes

  bool found() const { return std::isfinite(squared); }
};

// Cubes that touch are 0 apart, as in inflate().
double squared_gap(Index3 d) {
  const auto gap = [](int steps) { return double(std::max(0, std::abs(steps) - 1)); };
  return gap(d.x) * gap(d.x) + gap(d.y) * gap(d.y) + gap(d.z) * gap(d.z);
}

// The nearest voxel that is_cause(voxel) within the radius; of equally near ones the one whose
// centre is nearest. Nothing outside the grid grows into it.
template <typename IsCause>
Cause nearest(const VoxelGrid& grid, Index3 at, double radius_m, const IsCause& is_cause) {
  const double radius = radius_m / grid.geometry.resolution_m;
  const int reach = int(std::min(std::ceil(radius) + 1.0, double(kMostReach)));
  Cause cause;
  int best_steps = std::numeric_limits<int>::max();
  for (int z = -reach; z <= reach; ++z) {
    for (int y = -reach; y <= reach; ++y) {
      for (int x = -reach; x <= reach; ++x) {
        const Index3 d{x, y, z};
        const double squared = squared_gap(d);
        const int steps = x * x + y * y + z * z;
        if (squared >= radius * radius ||
            std::pair(squared, steps) >= std::pair(cause.squared, best_steps)) {
          continue;
        }
        if (!grid.grown.contains(at + d) || !is_cause(at + d)) continue;
        cause = {at + d, squared};
        best_steps = steps;
      }
    }
  }
  return cause;
}

std::string direction(Index3 from, Index3 to) {
  const Index3 d = to - from;
  if (std::abs(d.z) < std::max(std::abs(d.x), std::abs(d.y))) return "beside it";
  return d.z < 0 ? "below it" : "above it";
}

std::string unknown_nearby(const VoxelGrid& grid) {
  return fmt::format(
      "is closer than {:.3g} m to unknown space, which counts as an obstacle: choose a point "
      "farther inside what was measured, or let unknown space not grow (unknown: blocked) or be "
      "free (unknown: free)",
      grid.inflation_m);
}

// Why a voxel that is known is blocked. What is not in the grid cannot be told: without raw
// obstacles, whether one is near as well.
std::string why_blocked(const VoxelGrid& grid, Index3 at) {
  const bool raw = !grid.raw.empty();
  if (raw && grid.raw.get(at)) return "lies in an obstacle: choose a free point";
  const auto is_obstacle = [&](Index3 i) { return grid.raw.get(i) && grid.is_known(i); };
  const Cause obstacle = raw ? nearest(grid, at, grid.inflation_m, is_obstacle) : Cause{};
  if (obstacle.found()) {
    return fmt::format(
        "is closer than {:.3g} m to the obstacle at {}, {}: choose a point with more clearance, or "
        "a smaller radius or margin",
        grid.inflation_m, to_text(grid.geometry.center(obstacle.voxel)),
        direction(at, obstacle.voxel));
  }
  const bool unknown =
      grid.unknown_is_occupied && grid.unknown_grows &&
      nearest(grid, at, grid.inflation_m, [&](Index3 i) { return !grid.is_known(i); }).found();
  if (unknown && raw) return unknown_nearby(grid);
  if (raw && !grid.unknown_is_occupied) {
    const Cause in_reserve = nearest(grid, at, kFarthestReserve * grid.inflation_m, is_obstacle);
    if (in_reserve.found()) {
      return fmt::format(
          "is nearer to the obstacle at {} than plans may come, {:.3g} m and the reserve: choose a "
          "point with more clearance, or a smaller reserve_m of the map server",
          to_text(grid.geometry.center(in_reserve.voxel)), grid.inflation_m);
    }
  }
  if (unknown) return unknown_nearby(grid) + "; or it is as close to an obstacle";
  return fmt::format(
      "lies in an obstacle, or closer than {:.3g} m to one: choose a point with more "
      "clearance, or a smaller radius or margin",
      grid.inflation_m);
}

}  // namespace

Result<Index3> locate(const VoxelGrid& grid, const Vec3& p_map, Endpoint endpoint) {
  const bool start = endpoint == Endpoint::start;
  const std::string name = (start ? "start " : "goal ") + to_text(p_map);
  if (!is_finite(p_map)) {
    return fail(ErrorCode::invalid_input, name + " is not finite: give three numbers in metres");
  }
  const auto index = grid.geometry.index_of(p_map);
  if (!index) {
    return fail(
        start ? ErrorCode::start_outside : ErrorCode::goal_outside,
        fmt::format("{} is outside the map, which spans {} to {} m", name,
                    to_text(grid.geometry.origin_map), to_text(grid.geometry.upper_corner_map())));
  }
  if (!grid.grown.test(*index)) return *index;
  if (grid.unknown_is_occupied && !grid.is_known(*index)) {
    return fail(start ? ErrorCode::start_unknown : ErrorCode::goal_unknown,
                name +
                    " lies in unknown space, which counts as an obstacle: choose a point that was "
                    "measured free, or let unknown space be free (unknown: free)");
  }
  return fail(start ? ErrorCode::start_occupied : ErrorCode::goal_occupied,
              name + " " + why_blocked(grid, *index));
}

}  // namespace goshawk
