#pragma once

#include <concepts>
#include <type_traits>

#include "goshawk/core/parameter.hpp"
#include "goshawk/flight_check/flight_check.hpp"

namespace goshawk::flight_check {

/// Parameters of the second opinion.
struct Config {
  Body body;
  Options options;
  double period_s = 0.2;
  std::string movers_file = "";
  double movers_start_s = 0.0;
};

template <typename Self, typename Visitor>
requires std::same_as<std::remove_const_t<Self>, Config>
void describe(Self& c, Visitor&& visit) {
  visit("radius_m", c.body.radius_m, "m", "radius of the body's cylinder, propellers included",
        Range::positive(100.0));
  visit("height_m", c.body.height_m, "m", "height of the body's cylinder or box",
        Range::positive(100.0));
  visit("is_box", c.body.is_box, "", "the body is a box instead of a cylinder", Anything{});
  visit("length_m", c.body.length_m, "m", "length of the body's box along x",
        Range::positive(100.0));
  visit("width_m", c.body.width_m, "m", "width of the body's box along y", Range::positive(100.0));
  visit("count_unknown_as_obstacle", c.options.count_unknown_as_obstacle, "",
        "unknown voxels, and everything outside of the map, are obstacles", Anything{});
  visit("tolerance_m", c.options.tolerance_m, "m",
        "the smallest clearance is found to within this distance", Range{1e-5, 1.0});
  visit("period_s", c.period_s, "s", "how often the latest part of the flight is judged",
        Range{0.01, 10.0});
  visit("movers_file", c.movers_file, "",
        "what moves in the true world (docs/movers.md): what was flown is judged against it too",
        Anything{});
  visit("movers_start_s", c.movers_start_s, "s",
        "stamp at which the movers' time is 0; the same for all that read the file",
        Range{0.0, 1e10});
}

}  // namespace goshawk::flight_check
