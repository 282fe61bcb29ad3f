#include "goshawk/core/landing.hpp"

#include <fmt/format.h>

#include <cmath>

namespace goshawk {
namespace {

std::string metres(double value) {
  return fmt::format("{:.3g} m", value);
}

/// The highest layer that the ground, grown, can block; negative if the map begins above it.
int highest_of_ground(const VoxelGrid& grid, double land_height_m) {
  const auto& g = grid.geometry;
  const double layer = std::floor((land_height_m - g.origin_map.z()) / g.resolution_m);
  if (!(layer >= 0.0)) return -1;
  // Strictly nearer than the inflation is blocked (inflate()); rounding must not add a layer.
  const double grown = std::ceil(grid.inflation_m / g.resolution_m - 1e-9);
  return int(std::min(layer + grown, double(g.size.z)));
}

Status check_column(const VoxelGrid& grid, Index3 top, int lowest) {
  for (Index3 i = top; i.z >= lowest; --i.z) {
    if (!grid.is_known(i)) {
      return fail(ErrorCode::goal_unknown,
                  "the space below, at " + to_text(grid.geometry.center(i)) + ", was not measured");
    }
    if (grid.grown.get(i)) {
      return fail(ErrorCode::goal_occupied, "something is below, at " +
                                                to_text(grid.geometry.center(i)) + " or within " +
                                                metres(grid.inflation_m) + " of there");
    }
  }
  return success();
}

}  // namespace

Status check_way_down(const VoxelGrid& grid, const Vec3& from_map, double land_height_m) {
  if (!from_map.allFinite() || !std::isfinite(land_height_m)) {
    return fail(ErrorCode::invalid_input, "the place to land from is not finite");
  }
  const int ground = highest_of_ground(grid, land_height_m);
  if (ground < 0) {
    return fail(ErrorCode::goal_outside,
                "the map begins at a height of " + metres(grid.geometry.origin_map.z()) +
                    ", above the ground at " + metres(land_height_m) + ": set land_height_m");
  }
  // A place on the face between two voxels is safe where either of them is.
  constexpr double kOnFace = 1e-6;
  Status answer = fail(ErrorCode::goal_outside, to_text(from_map) + " is outside the map");
  for (const auto& [x, y] : {std::pair{0, 0}, {-1, -1}, {-1, 1}, {1, -1}, {1, 1}}) {
    const Vec3 beside = kOnFace * grid.geometry.resolution_m * Vec3(x, y, 0.0);
    const auto top = grid.geometry.index_of(from_map + beside);
    if (!top) continue;
    Status column = check_column(grid, *top, ground + 1);
    if (column) return column;
    if (answer.code() == ErrorCode::goal_outside) answer = column;
  }
  return answer;
}

Status LandingGuard::check(const Vec3& from_map) const {
  if (rule_ == LandingRule::anywhere) return success();
  if (rule_ == LandingRule::never)
    return fail(ErrorCode::cancelled, "the parameter landing is never");
  if (grid_ == nullptr) {
    return fail(ErrorCode::no_map,
                "no map has come yet on map/voxels to look for a free way down: is the map server "
                "running?");
  }
  return check_way_down(*grid_, from_map, land_height_m_);
}

}  // namespace goshawk
