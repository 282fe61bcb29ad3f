#include "goshawk/core/grid_geometry.hpp"

#include <fmt/format.h>

#include <cmath>

namespace goshawk {

Status GridGeometry::check() const {
  if (!is_finite(origin_map)) {
    return fail(ErrorCode::invalid_input, "the grid's origin is not finite");
  }
  if (!(std::isfinite(resolution_m) && resolution_m > 0.0)) {
    return fail(ErrorCode::invalid_input,
                fmt::format("the grid's resolution is {:g} m: it must be finite and above zero",
                            resolution_m));
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
  const auto agree = [&](const BitGrid& bits, const char* what) {
    if (bits.size() == geometry.size) return success();
    return Status(fail(ErrorCode::invalid_input,
                       fmt::format("the {} bits are of {} voxels, the grid of {}", what,
                                   to_text(bits.size()), to_text(geometry.size))));
  };
  if (auto status = agree(grown, "grown"); !status) return status;
  if (!known.empty()) {
    if (auto status = agree(known, "known"); !status) return status;
  }
  return raw.empty() ? success() : agree(raw, "raw");
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
                fmt::format("{} is outside the map, which spans {} to {} m", name,
                            to_text(grid.geometry.origin_map),
                            to_text(grid.geometry.upper_corner_map())));
  }
  if (!grid.grown.test(*index)) return *index;
  if (grid.unknown_is_occupied && !grid.is_known(*index)) {
    return fail(start ? ErrorCode::start_unknown : ErrorCode::goal_unknown,
                name +
                    " lies in unknown space, which counts as occupied: choose a point that was "
                    "measured free, or treat unknown space as free");
  }
  return fail(start ? ErrorCode::start_occupied : ErrorCode::goal_occupied,
              fmt::format("{} lies in an obstacle, or closer than {:.3g} m to one: choose a point "
                          "with more clearance, or a smaller radius or margin",
                          name, grid.inflation_m));
}

}  // namespace goshawk
