#pragma once

#include <concepts>
#include <string>

#include "goshawk/core/parameter.hpp"

namespace goshawk::runtime_test {

enum class Planner { jastar, astar };

constexpr auto words_of(Planner) {
  return std::to_array<Named<Planner>>({{Planner::jastar, "jastar"}, {Planner::astar, "astar"}});
}

/// One parameter of each kind and each rule; every other one can change at run time.
struct Config {
  double radius_m = 0.3;
  double speed_m_s = 2.0;
  int count = 5;
  bool enabled = true;
  Planner planner = Planner::jastar;
  std::string label = "";
};

template <typename Self, typename Visitor>
requires std::same_as<std::remove_const_t<Self>, Config>
void describe(Self& c, Visitor&& visit) {
  visit("radius_m", c.radius_m, "m", "radius of the body", Range{0.0, 10.0});
  visit("speed_m_s", c.speed_m_s, "m/s", "largest speed", AtRunTime{Range::positive()});
  visit("count", c.count, "", "how many", Range{1, 100});
  visit("enabled", c.enabled, "", "whether at all", AtRunTime{Anything{}});
  visit("planner", c.planner, "", "which search", Anything{});
  visit("label", c.label, "", "free text", AtRunTime{Anything{}});
}

}  // namespace goshawk::runtime_test
