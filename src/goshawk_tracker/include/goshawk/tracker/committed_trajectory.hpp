#pragma once

#include <cstdint>
#include <vector>

#include "goshawk/core/certificate.hpp"

namespace goshawk::tracker {

/// A trajectory with all that its certificate can be recomputed from, and when to fly it.
/// Frame `map`.
struct CommittedTrajectory {
  std::uint64_t id = 0;
  Trajectory trajectory;
  std::vector<Polytope> polytopes;  // each piece names the one it stays in
  Limits limits;
  FlatState start;                 // what it was asked to begin with
  FlatState goal;                  // and to end with
  std::int64_t start_time_ns = 0;  // [ns] on the tracker's clock; may be past
  double yaw_rad = 0.0;            // heading for the flight, where there is no curve
  /// Heading over time: a uniform quadratic B-spline, unwrapped; none, or three points or more.
  double yaw_step_s = 0.0;
  std::vector<double> yaw_points_rad = {};

  /// @param t_s since the beginning, clamped to the curve @pre admit() ok
  double yaw_at(double t_s) const;
};

}  // namespace goshawk::tracker
