#pragma once

#include <concepts>
#include <string>
#include <type_traits>

#include "goshawk/core/parameter.hpp"

namespace goshawk::baselines {

struct Config {
  std::string method = "thesis";
};

template <typename Self, typename Visitor>
requires std::same_as<std::remove_const_t<Self>, Config>
void describe(Self& c, Visitor&& visit) {
  visit("method", c.method, "",
        "thesis: one quintic a segment, durations from rest to rest, limits per axis, never "
        "stretched; minimum_snap (thesis Ref. [40]): a polynomial through the waypoints that does "
        "not know the corridor; polynomial (Ref. [42]): minimum jerk through the waypoints, "
        "planned again with more waypoints until it stays in the corridor",
        AtRunTime{OneOf{{"thesis", "minimum_snap", "polynomial"}}});
}

}  // namespace goshawk::baselines
