#pragma once

#include <span>
#include <vector>

#include "goshawk/core/certificate.hpp"
#include "goshawk/core/trajectory.hpp"

namespace goshawk::trajectory_optimizer {

/// The trapezoid over a whole polyline: on each segment accelerate, cruise and brake along the
/// line; through each corner no faster than a circle that fits it allows; at rest, or as fast as
/// told, at the ends. The first estimate of the durations (thesis, time allocation, as corrected:
/// one trapezoid over the path instead of a stop at each waypoint).
class TimeProfile {
 public:
  /// @param start_speed_m_s, goal_speed_m_s lowered if the path is too short to brake
  /// @pre two waypoints or more, limits.check() ok
  TimeProfile(std::span<const Vec3> waypoints_map, const Limits& limits, double start_speed_m_s,
              double goal_speed_m_s);

  int segments() const { return int(segments_.size()); }
  double duration_s(int segment) const { return segments_[std::size_t(segment)].duration; }
  double duration_s() const;
  /// Position and velocity t_s after the beginning of a segment; acceleration is left zero.
  FlatState state(int segment, double t_s) const;

 private:
  struct Segment {
    Vec3 from, direction;
    double length = 0.0, v_max = 0.0, a_max = 0.0;
    double v_in = 0.0, v_out = 0.0, v_peak = 0.0;
    double accelerate = 0.0, cruise = 0.0, duration = 0.0;  // [s]
  };
  std::vector<Segment> segments_;
};

/// One segment of length L from rest to rest: 2 sqrt(L / a) if L <= v^2 / a (the thesis prints
/// another quantity, which is no time), else L / v + v / a.
double rest_to_rest_duration_s(double length_m, double v_max_m_s, double a_max_m_s2);

}  // namespace goshawk::trajectory_optimizer
