#pragma once

#include <span>
#include <vector>

#include "goshawk/map_server/live_map.hpp"

namespace goshawk::map_server::testing {

/// A scan from one place, as a value.
inline Result<ScanResult> insert(LiveMap& map, std::span<const Vec3> points_map,
                                 const Vec3& origin_map, double max_range_m) {
  ScanResult result;
  const Scan scan{.points_map = points_map, .origins_map = {&origin_map, 1},
                  .max_range_m = max_range_m};
  if (auto status = map.insert_scan(scan, result); !status) return status.error();
  return result;
}

/// The part of a ray [share of its length] inside a cube that is widened by `margin` to all sides;
/// below 0 if it misses the cube. All in voxels.
inline double share_inside(const Vec3& from, const Vec3& to, const Vec3& lower, double margin) {
  double enter = 0.0, leave = 1.0;
  for (int a = 0; a < 3; ++a) {
    const double way = to[a] - from[a];
    const double low = lower[a] - margin - from[a], high = lower[a] + 1.0 + margin - from[a];
    if (way == 0.0) {
      if (low > 0.0 || high < 0.0) return -1.0;
      continue;
    }
    enter = std::max(enter, std::min(low / way, high / way));
    leave = std::min(leave, std::max(low / way, high / way));
  }
  return leave - enter;
}

}  // namespace goshawk::map_server::testing
