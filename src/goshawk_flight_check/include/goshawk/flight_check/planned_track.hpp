#pragma once

#include <array>
#include <functional>
#include <span>
#include <vector>

#include "goshawk/flight_check/flight_check.hpp"

namespace goshawk::flight_check {

/// One quintic Bezier piece as the trajectory message carries it. Frame `map`.
struct PlannedPiece {
  std::array<Vec3, 6> control_points_map;  // [m]
  double duration_s = 0.0;                 // [s] > 0
};

/// The attitude for an acceleration: the body's z axis along acceleration plus gravity, its heading
/// as given. Level in free fall. @param acceleration_map [m/s^2] finite
Quaternion flat_attitude(const Vec3& acceleration_map, double yaw_rad);

/// Turns a planned trajectory into a track that can be judged, by de Casteljau's algorithm, apart
/// from the planner's own evaluation. The attitude is what a quadrotor needs for the acceleration:
/// its z axis along acceleration plus gravity, yaw as given (Mellinger and Kumar, ICRA 2011).
/// @param step_s [s] longest time between two samples, > 0
/// @param yaw_rad_at heading [rad] at a time [s]; none: 0
/// @param start_s [s] when the first piece begins; the samples and yaw_rad_at count from there
/// @return samples from start_s to the end of the last piece; invalid_input for no piece, a number
/// that is not finite, a duration or a step that is not above zero, or more than 10^7 samples
Result<std::vector<Sample>> planned_track(std::span<const PlannedPiece> pieces,
                                          double step_s = 0.01,
                                          const std::function<double(double)>& yaw_rad_at = {},
                                          double start_s = 0.0);

}  // namespace goshawk::flight_check
