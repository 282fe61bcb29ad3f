#pragma once

#include <array>
#include <concepts>
#include <type_traits>

#include "goshawk/core/words.hpp"
#include "goshawk/obstacle_tracker/config.hpp"

namespace goshawk::obstacle_tracker {

/// Where obstacles come from.
enum class Source {
  clouds,  // clouds on cloud_in
  movers   // boxes on movers: a simulator's truth, or another tracker's estimate
};

constexpr auto words_of(Source) {
  using enum Source;
  return std::to_array<Named<Source>>({{clouds, "clouds"}, {movers, "movers"}});
}

struct ComponentConfig {
  Config tracker;
  Source source = Source::clouds;
  int max_points = 500'000;
  double pose_wait_s = 0.5;
  double pose_max_gap_s = 0.25;
};

template <typename Self, typename Visitor>
requires std::same_as<std::remove_const_t<Self>, ComponentConfig>
void describe(Self& c, Visitor&& visit) {
  describe(c.tracker, visit);
  visit("source", c.source, "",
        "where obstacles come from: clouds (on cloud_in) or movers (boxes on movers: a simulator's "
        "truth, or another tracker's estimate)",
        Anything{});
  visit("max_points", c.max_points, "", "larger clouds are refused", Range{1.0, 1e7});
  visit("pose_wait_s", c.pose_wait_s, "s", "how long a cloud waits for the odometry of its end",
        Range{0.0, 10.0});
  visit("pose_max_gap_s", c.pose_max_gap_s, "s",
        "longer pauses of odometry are not bridged: clouds in them are refused", Range{0.01, 10.0});
}

}  // namespace goshawk::obstacle_tracker
