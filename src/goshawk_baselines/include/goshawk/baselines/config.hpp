#pragma once

#include <concepts>
#include <type_traits>

#include "goshawk/core/parameter.hpp"

namespace goshawk::baselines {

/// The thesis' own planner, and those of its Ref. [40] and Ref. [42].
enum class Method { thesis, minimum_snap, minimum_jerk };
constexpr auto words_of(Method) {
  using enum Method;
  return std::to_array<Named<Method>>(
      {{thesis, "thesis"}, {minimum_snap, "minimum_snap"}, {minimum_jerk, "minimum_jerk"}});
}

struct Config {
  Method method = Method::thesis;
};

template <typename Self, typename Visitor>
requires std::same_as<std::remove_const_t<Self>, Config>
void describe(Self& c, Visitor&& visit) {
  visit("method", c.method, "",
        "thesis: one quintic a segment, durations from rest to rest, limits per axis, never "
        "stretched; minimum_snap (thesis Ref. [40]): a polynomial through the waypoints that does "
        "not know the corridor; minimum_jerk (Ref. [42]): a polynomial through the waypoints, "
        "planned again with more waypoints until it stays in the corridor",
        AtRunTime{Anything{}});
}

}  // namespace goshawk::baselines
