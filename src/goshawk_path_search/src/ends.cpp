#include "goshawk/path_search/ends.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "goshawk/core/line_of_sight.hpp"

namespace goshawk::path_search {
namespace {

// goshawk::locate builds its sentence before it knows whether one is needed, and so allocates:
// asked only where there is something to say.
Result<Index3> find_voxel(const VoxelGrid& map, const Vec3& p_map, Endpoint endpoint) {
  if (is_finite(p_map)) {
    const auto index = map.geometry.index_of(p_map);
    if (index && !map.grown.get(*index)) return *index;
  }
  return locate(map, p_map, endpoint);
}

// What a point on the very face of its voxel touches.
std::string face_of(const VoxelGrid& map, const Vec3& p_map) {
  const Vec3 from_lower = map.geometry.to_grid(p_map);
  if (from_lower.z() == 0.0) {
    return fmt::format("on the map's floor, at z = {:g} m", map.geometry.origin_map.z());
  }
  if (from_lower.x() == 0.0 || from_lower.y() == 0.0) return "on the map's outermost face";
  return "on the face of a blocked voxel";
}

// A free voxel's face may be an obstacle's: no segment from a point on it clears that obstacle.
Status check_clear_of_faces(const VoxelGrid& map, const Vec3& p_map, Endpoint endpoint) {
  if (line_is_free(map, p_map, p_map)) return success();
  const bool start = endpoint == Endpoint::start;
  return fail(start ? ErrorCode::start_occupied : ErrorCode::goal_occupied,
              fmt::format("{} {} lies {}: move it a little into the free voxel, or use corner_rule "
                          "squeeze",
                          start ? "start" : "goal", to_text(p_map), face_of(map, p_map)));
}

bool may_be_moved(ErrorCode code) {
  return code == ErrorCode::start_occupied || code == ErrorCode::goal_occupied ||
         code == ErrorCode::start_unknown || code == ErrorCode::goal_unknown;
}

// The lowest index wins among centres that are equally near.
std::optional<Index3> nearest_free(const VoxelGrid& map, const Vec3& p_map, double radius_m) {
  const GridGeometry& g = map.geometry;
  const Vec3 p = g.to_grid(p_map);
  const double radius = radius_m / g.resolution_m;
  const auto from = [&](int a) { return int(std::max(0.0, std::ceil(p[a] - 0.5 - radius))); };
  const auto to = [&](int a, int n) {
    return int(std::min(double(n) - 1.0, std::floor(p[a] - 0.5 + radius)));
  };
  std::optional<Index3> best;
  double best_squared = radius * radius;
  for (int z = from(2); z <= to(2, g.size.z); ++z) {
    for (int y = from(1); y <= to(1, g.size.y); ++y) {
      for (int x = from(0); x <= to(0, g.size.x); ++x) {
        const double squared = (Vec3(x + 0.5, y + 0.5, z + 0.5) - p).squaredNorm();
        if (best ? squared >= best_squared : squared > best_squared) continue;
        if (map.grown.get({x, y, z})) continue;
        best = Index3{x, y, z};
        best_squared = squared;
      }
    }
  }
  return best;
}

}  // namespace

Result<PlacedEnd> place_end(const VoxelGrid& map, CornerRule rule, const Vec3& p_map,
                            Endpoint endpoint, double move_within_m) {
  const auto cell = find_voxel(map, p_map, endpoint);
  Status status = cell ? success() : Status(cell.error());
  if (status && rule == CornerRule::no_squeeze) {
    status = check_clear_of_faces(map, p_map, endpoint);
  }
  if (status) return PlacedEnd{p_map, {*cell, map.geometry.to_grid(p_map)}, 0.0};
  if (!(move_within_m > 0.0) || !may_be_moved(status.code())) return status.error();
  const auto free = nearest_free(map, p_map, move_within_m);
  if (!free) {
    return fail(status.code(),
                fmt::format("{} (no voxel within move_within_m, {:g} m, is free)",
                            status.error().message, move_within_m));
  }
  const Vec3 center = map.geometry.center(*free);
  return PlacedEnd{center, End::center_of(*free), (center - p_map).norm()};
}

}  // namespace goshawk::path_search
