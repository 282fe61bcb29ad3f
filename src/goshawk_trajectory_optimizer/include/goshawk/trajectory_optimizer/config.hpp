#pragma once

#include <concepts>
#include <type_traits>

#include "goshawk/core/parameter.hpp"

namespace goshawk::trajectory_optimizer {

/// What a flight is optimised for.
enum class Method { scale, fixed };
constexpr auto words_of(Method) {
  return std::to_array<Named<Method>>({{Method::scale, "scale"}, {Method::fixed, "fixed"}});
}

/// Where the vehicle looks. none: the optimizer does not say.
enum class YawMode { none, fixed, along_motion, towards_point };
constexpr auto words_of(YawMode) {
  using enum YawMode;
  return std::to_array<Named<YawMode>>({{none, "none"},
                                        {fixed, "fixed"},
                                        {along_motion, "along_motion"},
                                        {towards_point, "towards_point"}});
}

struct Config {
  Method method = Method::scale;
  double piece_duration_s = 0.45;  // [s]
  int min_pieces = 8;
  int refinement_passes = 2;
  double extra_time = 0.0;
  int max_iterations = 60;
  double max_stretch = 20.0;
  double max_thrust_m_s2 = 0.0;  // [m/s^2] over the mass
  double min_thrust_m_s2 = 0.0;  // [m/s^2] over the mass
  double max_tilt_rad = 0.0;     // [rad]
  YawMode yaw = YawMode::none;
  double yaw_rate_max_rad_s = 0.8;  // [rad/s]
  double yaw_point_x_m = 0.0;       // [m]
  double yaw_point_y_m = 0.0;       // [m]
};

template <typename Self, typename Visitor>
requires std::same_as<std::remove_const_t<Self>, Config>
void describe(Self& c, Visitor&& visit) {
  visit("method", c.method, "",
        "scale: durations and shape together, near time-optimal; fixed: minimum jerk with the "
        "durations of a trapezoid over the whole path, stretched until feasible",
        AtRunTime{Anything{}});
  visit("piece_duration_s", c.piece_duration_s, "s",
        "longest piece of the first cut: shorter pieces fly faster and take longer to compute",
        AtRunTime{Range{0.02, 100.0}});
  visit("min_pieces", c.min_pieces, "", "pieces of the shortest flight",
        AtRunTime{Range{2.0, 1000.0}});
  visit(
      "refinement_passes", c.refinement_passes, "",
      "how often, at most, the changes from polytope to polytope move to save time and the flight "
      "is solved again (scale only)",
      AtRunTime{Range{0.0, 20.0}});
  visit("extra_time", c.extra_time, "",
        "how much longer than the soonest flight a flight may last to be smoother: 0.1 allows 10 % "
        "and flies the least jerk of that duration",
        AtRunTime{Range{0.0, 10.0}});
  visit("max_iterations", c.max_iterations, "", "of the interior-point method, in each solve",
        AtRunTime{Range{5.0, 1000.0}});
  visit("max_stretch", c.max_stretch, "",
        "longest duration that is tried, in trapezoid durations (fixed and moving starts)",
        AtRunTime{Range{1.0, 1000.0}});
  visit("max_thrust_m_s2", c.max_thrust_m_s2, "m/s^2",
        "largest thrust over mass of the vehicle; a flight that needs more is slowed (0: not "
        "checked)",
        AtRunTime{Range{0.0, 1e3}});
  visit("min_thrust_m_s2", c.min_thrust_m_s2, "m/s^2",
        "smallest thrust over mass of the vehicle; a flight that needs less is slowed (0: not "
        "checked)",
        AtRunTime{Range{0.0, 9.0}});
  visit("max_tilt_rad", c.max_tilt_rad, "rad",
        "largest tilt of the thrust from the vertical; a flight that needs more is slowed (0: not "
        "checked)",
        AtRunTime{Range{0.0, 1.5}});
  visit("yaw", c.yaw, "",
        "where to look: none (leave it to the tracker), fixed (the request's goal yaw), "
        "along_motion or towards_point",
        AtRunTime{Anything{}});
  visit("yaw_rate_max_rad_s", c.yaw_rate_max_rad_s, "rad/s",
        "yaw rate limit; keep it below the tracker's max_yaw_rate_rad_s",
        AtRunTime{Range::positive(100.0)});
  visit("yaw_point_x_m", c.yaw_point_x_m, "m", "the point of towards_point, map",
        AtRunTime{Anything{}});
  visit("yaw_point_y_m", c.yaw_point_y_m, "m", "the point of towards_point, map",
        AtRunTime{Anything{}});
}

}  // namespace goshawk::trajectory_optimizer
