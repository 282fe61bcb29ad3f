#pragma once

#include <concepts>
#include <type_traits>

#include "goshawk/core/parameter.hpp"

namespace goshawk::obstacle_tracker {

struct Config {
  // What moves against what stands
  double range_m = 22.0;   // farther points are not looked at
  double height_m = 12.0;  // of the space that is remembered, its middle at the sensor
  double cell_m = 0.25;    // edge of its cells
  double settle_s = 1.5;   // what is hit that long stands
  double memory_s = 60.0;  // how long a cell that was seen free is remembered
  // Clusters
  double vertical_gap_m = 0.75;  // between rings of one thing, at most
  int points_needed = 4;
  double largest_m = 8.0;  // longest edge of a thing that moves
  // Filter
  double position_noise_m = 0.08;   // one standard deviation of a cluster's centre
  double acceleration_m_s2 = 2.0;   // one standard deviation, from scan to scan
  double confirm_distance_m = 0.4;  // that a thing must have moved before it is told
  double confirm_speed_m_s = 0.3;   // slower things stand
  double lost_s = 1.0;              // a thing that is not seen for longer is forgotten
  double rest_s = 5.0;              // a thing that rests for longer stands again
  // Predictions
  double horizon_s = 2.0;
  double agility_m_s = 0.5;    // how much a thing may change its velocity at once
  double top_speed_m_s = 4.0;  // of a thing after the horizon, at least
  double margin_m = 0.1;       // added to the half extents
};

template <typename Self, typename Visitor>
requires std::same_as<std::remove_const_t<Self>, Config>
void describe(Self& c, Visitor&& visit) {
  visit("range_m", c.range_m, "m", "farther points are not looked at", Range{2.0, 50.0});
  visit("height_m", c.height_m, "m",
        "height of the space that is remembered, its middle at the sensor", Range{2.0, 50.0});
  visit("cell_m", c.cell_m, "m", "edge of the cells in which free space is remembered",
        Range{0.1, 1.0});
  visit("settle_s", c.settle_s, "s", "what is hit for this long stands", Range{0.5, 60.0});
  visit("memory_s", c.memory_s, "s", "how long it is remembered that a cell was seen free",
        Range{1.0, 3600.0});
  visit("vertical_gap_m", c.vertical_gap_m, "m",
        "largest vertical gap between points of one thing: the rings of a lidar", Range{0.0, 3.0});
  visit("points_needed", c.points_needed, "", "fewest points of a thing in a cloud",
        Range{1.0, 1000.0});
  visit("largest_m", c.largest_m, "m", "longest edge of a thing that moves", Range{0.1, 50.0});
  visit("position_noise_m", c.position_noise_m, "m", "standard deviation of a measured centre",
        Range{0.005, 1.0});
  visit("acceleration_m_s2", c.acceleration_m_s2, "m/s^2",
        "standard deviation of a thing's acceleration", Range{0.05, 50.0});
  visit("confirm_distance_m", c.confirm_distance_m, "m",
        "how far a thing must have moved before it is published", Range{0.0, 10.0});
  visit("confirm_speed_m_s", c.confirm_speed_m_s, "m/s", "slower things stand", Range{0.0, 10.0});
  visit("lost_s", c.lost_s, "s", "a thing that is not seen for this long is forgotten",
        Range{0.1, 10.0});
  visit("rest_s", c.rest_s, "s", "a thing that rests for this long stands again", Range{0.5, 60.0});
  visit("horizon_s", c.horizon_s, "s", "how far ahead is predicted", Range{0.1, 10.0});
  visit("agility_m_s", c.agility_m_s, "m/s",
        "how much a thing may change its velocity at once: the bound grows by this",
        Range{0.0, 20.0});
  visit("top_speed_m_s", c.top_speed_m_s, "m/s",
        "how fast a thing may be after the horizon; faster ones keep their speed",
        Range{0.0, 100.0});
  visit("margin_m", c.margin_m, "m", "added to the half extents that were seen", Range{0.0, 5.0});
}

}  // namespace goshawk::obstacle_tracker
