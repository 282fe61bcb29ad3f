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

}  // namespace goshawk
