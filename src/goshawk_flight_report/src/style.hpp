#pragma once

#include <vector>

#include "goshawk/core/trajectory.hpp"
#include "goshawk/visualization/speed_color.hpp"
#include "plot.hpp"

namespace goshawk::flight_report {

inline constexpr Color kFlown{0.05, 0.05, 0.05};
inline constexpr TextStyle kTitle{.size_px = 20.0, .color = {0.1, 0.1, 0.12}, .bold = true};

inline Color speed_color(double ratio) {
  const Vec3 c = visualization::speed_color(ratio);
  return {c.x(), c.y(), c.z()};
}

/// @return steps + 1 states at even times, or none of an empty trajectory
inline std::vector<FlatState> sampled(const Trajectory& trajectory, int steps) {
  std::vector<FlatState> states;
  if (trajectory.pieces.empty()) return states;
  const double duration_s = trajectory.duration_s();
  for (int k = 0; k <= steps; ++k) states.push_back(trajectory.sample(duration_s * k / steps));
  return states;
}

}  // namespace goshawk::flight_report
