#include "goshawk/core/grid_geometry.hpp"

#include <cmath>
#include <cstdio>

namespace goshawk {

Status GridGeometry::check() const {
  if (!is_finite(origin_map)) {
    return fail(ErrorCode::invalid_input, "the grid's origin is not finite");
  }
  if (!(std::isfinite(resolution_m) && resolution_m > 0.0)) {
    return fail(ErrorCode::invalid_input, "the grid's resolution is " +
                                              std::to_string(resolution_m) +
                                              " m: it must be finite and above zero");
  }
  return BitGrid::check_size(size);
}

std::optional<Index3> GridGeometry::index_of(const Vec3& p_map) const {
  const Vec3 g = to_grid(p_map);
  // Compared as doubles first: a cast of a huge or NaN value to int is undefined.
  const auto inside = [](double v, int n) { return v >= 0.0 && v < double(n); };
  if (!inside(g.x(), size.x) || !inside(g.y(), size.y) || !inside(g.z(), size.z)) return {};
  return Index3{int(g.x()), int(g.y()), int(g.z())};
}

Status VoxelGrid::check() const {
  if (auto status = geometry.check(); !status) return status;
  if (!(occupied.size() == geometry.size)) {
    return fail(ErrorCode::invalid_input, "the occupied bits are of " + to_text(occupied.size()) +
                                              " voxels, the grid of " + to_text(geometry.size));
  }
  if (!known.empty() && !(known.size() == geometry.size)) {
    return fail(ErrorCode::invalid_input, "the known bits are of " + to_text(known.size()) +
                                              " voxels, the grid of " + to_text(geometry.size));
  }
  return success();
}

Result<Index3> locate(const VoxelGrid& grid, const Vec3& p_map, Endpoint endpoint) {
  const bool start = endpoint == Endpoint::start;
  const std::string name = (start ? "start " : "goal ") + to_text(p_map);
  if (!is_finite(p_map)) {
    return fail(ErrorCode::invalid_input, name + " is not finite: give three numbers in metres");
  }
  const auto index = grid.geometry.index_of(p_map);
  if (!index) {
    return fail(start ? ErrorCode::start_outside : ErrorCode::goal_outside,
                name + " is outside the map, which spans " + to_text(grid.geometry.origin_map) +
                    " to " + to_text(grid.geometry.upper_corner_map()) + " m");
  }
  if (grid.occupied.test(*index)) {
    if (grid.unknown_is_occupied && !grid.is_known(*index)) {
      return fail(start ? ErrorCode::start_unknown : ErrorCode::goal_unknown,
                  name +
                      " lies in unknown space, which counts as occupied: choose a point that "
                      "was measured free, or treat unknown space as free");
    }
    char inflation[32];
    std::snprintf(inflation, sizeof inflation, "%.3f", grid.inflation_m);
    return fail(start ? ErrorCode::start_occupied : ErrorCode::goal_occupied,
                name + " lies in an obstacle, or closer than " + inflation +
                    " m to one: choose a point with more clearance, or a smaller radius or margin");
  }
  return *index;
}

}  // namespace goshawk
