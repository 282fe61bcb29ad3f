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
        OneOf{{"scale", "fixed", "thesis", "minimum_snap", "polynomial"}});
  visit("piece_duration_s", c.piece_duration_s, "s",
        "longest piece of the first cut: shorter pieces fly faster and cost more to compute "
        "(not used by thesis)",
        Range{0.02, 100.0});
  visit("min_pieces", c.min_pieces, "", "pieces of the shortest flight (not used by thesis)",
        Range{2.0, 1000.0});
  visit("refinement_passes", c.refinement_passes, "",
        "how often the durations of the pieces are balanced and solved again (scale only)",
        Range{0.0, 20.0});
  visit("extra_time", c.extra_time, "",
        "how much longer than the soonest flight may last so as to be smoother: 0.1 is 10 %, and "
        "then the flight with the least jerk of that duration is flown",
        Range{0.0, 10.0});
  visit("max_iterations", c.max_iterations, "", "of the interior-point method, in each solve",
        Range{5.0, 1000.0});
  visit("max_stretch", c.max_stretch, "",
        "longest duration that is tried, in trapezoid durations (fixed and moving starts)",
        Range{1.0, 1000.0});
}

}  // namespace goshawk::trajectory_optimizer
