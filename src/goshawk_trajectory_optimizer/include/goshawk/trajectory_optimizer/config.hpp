#pragma once

#include <concepts>
#include <string>
#include <type_traits>

#include "goshawk/core/parameter.hpp"

namespace goshawk::trajectory_optimizer {

struct Config {
  std::string method = "scale";
  double piece_duration_s = 0.45;  // [s]
  int min_pieces = 8;
  int refinement_passes = 2;
  double extra_time = 0.0;
  int max_iterations = 60;
  double max_stretch = 20.0;
  double max_thrust_m_s2 = 0.0;  // [m/s^2] over the mass
  double min_thrust_m_s2 = 0.0;  // [m/s^2] over the mass
  double max_tilt_rad = 0.0;     // [rad]
  std::string yaw = "none";
  double yaw_rate_max_rad_s = 0.8;  // [rad/s]
  double yaw_point_x_m = 0.0;       // [m]
  double yaw_point_y_m = 0.0;       // [m]
};

template <typename Self, typename Visitor>
requires std::same_as<std::remove_const_t<Self>, Config>
void describe(Self& c, Visitor&& visit) {
  visit("method", c.method, "",
        "scale: durations and shape together, near time-optimal; fixed: minimum jerk with the "
        "durations of a trapezoid over the whole path, stretched until feasible; thesis: one "
        "quintic a segment, trapezoid durations, limits per axis, never stretched; minimum_snap "
        "(thesis Ref. [40]): a polynomial through the waypoints that does not know the corridor; "
        "polynomial (Ref. [42]): minimum jerk through the waypoints, planned again with more "
        "waypoints where it leaves the corridor",
        AtRunTime{OneOf{{"scale", "fixed", "thesis", "minimum_snap", "polynomial"}}});
  visit("piece_duration_s", c.piece_duration_s, "s",
        "longest piece of the first cut: shorter pieces fly faster and cost more to compute "
        "(not used by thesis)",
        AtRunTime{Range{0.02, 100.0}});
  visit("min_pieces", c.min_pieces, "", "pieces of the shortest flight (not used by thesis)",
        AtRunTime{Range{2.0, 1000.0}});
  visit("refinement_passes", c.refinement_passes, "",
        "how often, at most, the times of the change from polytope to polytope are bettered and "
        "all is solved again (scale only)",
        AtRunTime{Range{0.0, 20.0}});
  visit("extra_time", c.extra_time, "",
        "how much longer than the soonest flight may last so as to be smoother: 0.1 is 10 %, and "
        "then the flight with the least jerk of that duration is flown",
        AtRunTime{Range{0.0, 10.0}});
  visit("max_iterations", c.max_iterations, "", "of the interior-point method, in each solve",
        AtRunTime{Range{5.0, 1000.0}});
  visit("max_stretch", c.max_stretch, "",
        "longest duration that is tried, in trapezoid durations (fixed and moving starts)",
        AtRunTime{Range{1.0, 1000.0}});
  visit("max_thrust_m_s2", c.max_thrust_m_s2, "m/s^2",
        "most thrust over the mass that the vehicle has; a flight that needs more is slowed where "
        "it does (0: not checked)",
        AtRunTime{Range{0.0, 1e3}});
  visit("min_thrust_m_s2", c.min_thrust_m_s2, "m/s^2",
        "least thrust over the mass, likewise (0: not checked)", AtRunTime{Range{0.0, 9.0}});
  visit("max_tilt_rad", c.max_tilt_rad, "rad",
        "how far the thrust may lean from the vertical, likewise (0: not checked)",
        AtRunTime{Range{0.0, 1.5}});
  visit("yaw", c.yaw, "",
        "where to look: none (no wish), fixed (the request's goal yaw), along_motion or "
        "towards_point",
        AtRunTime{OneOf{{"none", "fixed", "along_motion", "towards_point"}}});
  visit("yaw_rate_max_rad_s", c.yaw_rate_max_rad_s, "rad/s",
        "how fast yaw may turn; the tracker's max_yaw_rate_rad_s is to be above it",
        AtRunTime{Range::positive(100.0)});
  visit("yaw_point_x_m", c.yaw_point_x_m, "m", "what towards_point looks at, map",
        AtRunTime{Anything{}});
  visit("yaw_point_y_m", c.yaw_point_y_m, "m", "what towards_point looks at, map",
        AtRunTime{Anything{}});
}

}  // namespace goshawk::trajectory_optimizer
