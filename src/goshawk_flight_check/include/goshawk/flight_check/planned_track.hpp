#pragma once

#include <array>
#include <span>
#include <vector>

#include "goshawk/flight_check/flight_check.hpp"

namespace goshawk::flight_check {

/// One quintic Bezier piece as the trajectory message carries it. Frame `map`.
struct PlannedPiece {
  std::array<Vec3, 6> control_points_map;  // [m]
  double duration_s = 0.0;                 // [s] > 0
};

/// The yaw of a flight: a uniform quadratic B-spline over time, or one yaw throughout.
struct PlannedYaw {
  double yaw_rad = 0.0;              // if there are no points
  double step_s = 0.0;               // [s] > 0, between the spline's knots
  std::vector<double> points_rad{};  // none, or at least three

  /// @param t_s [s] after the flight's start; before and after the spline, the yaw of its end
  double at(double t_s) const;
};

/// The attitude for an acceleration: the body's z axis along acceleration plus gravity, its heading
/// as given. Level in free fall. @param acceleration_map [m/s^2] finite
Eigen::Quaterniond flat_attitude(const Vec3& acceleration_map, double yaw_rad);

/// Turns a planned trajectory into a track that can be judged, by de Casteljau's algorithm, apart
/// from the planner's own evaluation. The attitude is what a quadrotor needs for the acceleration:
/// its z axis along acceleration plus gravity, yaw as given (Mellinger and Kumar, ICRA 2011).
/// @param step_s [s] longest time between two samples, > 0
/// @param start_s [s] when the first piece begins, as the samples and the yaw count
/// @return samples from start_s to the end of the last piece; invalid_input for no piece, a number
/// that is not finite, a duration or a step that is not above zero, a spline of one or two points,
/// or more than 10^7 samples
Result<std::vector<Sample>> planned_track(std::span<const PlannedPiece> pieces,
                                          double step_s = 0.01, const PlannedYaw& yaw = {},
                                          double start_s = 0.0);

}  // namespace goshawk::flight_check
