#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "goshawk/core/result.hpp"
#include "goshawk/core/vector.hpp"

namespace goshawk::mission {

/// A point that a mission leads to.
struct Waypoint {
  Vec3 position_map = Vec3::Zero();
  std::optional<double> yaw_rad = {};  // heading there, map x to y; none: that of the leg
  double hold_s = 0.0;                 // at rest there, before the next leg
  double v_max_m_s = 0.0;              // of the leg that leads there; 0: the navigator's
  double pass_radius_m = 0.0;          // the next leg begins this near; 0: once the vehicle rests

  bool passes() const { return pass_radius_m > 0.0; }
};

/// Waypoints to fly to, one after another.
struct Mission {
  std::uint64_t id = 0;
  std::string client = {};
  std::string name = {};
  std::vector<Waypoint> waypoints = {};
};

/// More would be a track, not waypoints.
inline constexpr std::size_t kMostWaypoints = 10'000;

/// @return invalid_input: not finite, below zero, or a pass with a hold
Status check(const Waypoint& waypoint);
/// @return invalid_input that names the waypoint, counted from 1; also if there is none, there are
/// more than kMostWaypoints, or the last one is passed: the vehicle rests somewhere
Status check(const Mission& mission);

/// [m] along straight lines from a place to waypoint `next` (counted from 0) and on to the last.
/// @pre next < size of waypoints
double length_from(const Mission& mission, std::size_t next, const Vec3& place_map);

}  // namespace goshawk::mission
