#include "goshawk/corridor_builder/horizon.hpp"

namespace goshawk::corridor_builder {
namespace {

constexpr double kWhole = 1.2;  // of the horizon: a path no longer than that stays whole

}  // namespace

FirstPart within_horizon(std::span<const Vec3> path_map, double horizon_m) {
  double length_m = 0.0;
  for (std::size_t i = 1; i < path_map.size(); ++i) {
    length_m += (path_map[i] - path_map[i - 1]).norm();
  }
  if (!(horizon_m > 0.0 && length_m > kWhole * horizon_m)) {
    return {{path_map.begin(), path_map.end()}};
  }
  FirstPart part{{path_map.front()}, length_m - horizon_m};
  double left_m = horizon_m;
  for (std::size_t i = 1;; ++i) {
    const Vec3 step = path_map[i] - path_map[i - 1];
    const double step_m = step.norm();
    if (step_m >= left_m) {
      part.waypoints_map.push_back(path_map[i - 1] + left_m / step_m * step);
      return part;
    }
    part.waypoints_map.push_back(path_map[i]);
    left_m -= step_m;
  }
}

}  // namespace goshawk::corridor_builder
