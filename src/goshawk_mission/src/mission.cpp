#include "goshawk/mission/mission.hpp"

#include <fmt/format.h>

#include <cmath>

namespace goshawk::mission {
namespace {

Error wrong(std::string message) {
  return fail(ErrorCode::invalid_input, std::move(message));
}

bool is_amount(double value) {
  return std::isfinite(value) && value >= 0.0;
}

}  // namespace

Status check(const Waypoint& w) {
  if (!w.position_map.allFinite()) {
    return wrong(fmt::format("its position {} is not finite", to_text(w.position_map)));
  }
  if (w.yaw_rad && !std::isfinite(*w.yaw_rad)) return wrong("its yaw is not finite");
  if (!is_amount(w.hold_s)) {
    return wrong(fmt::format("its hold of {:g} s is not 0 or more", w.hold_s));
  }
  if (!is_amount(w.v_max_m_s)) {
    return wrong(fmt::format("its speed limit of {:g} m/s is not 0 or more", w.v_max_m_s));
  }
  if (!is_amount(w.pass_radius_m)) {
    return wrong(fmt::format("its pass radius of {:g} m is not 0 or more", w.pass_radius_m));
  }
  if (w.passes() && w.hold_s > 0.0) {
    return wrong(
        fmt::format("it is passed within {:g} m, but also holds for {:g} s: give one of "
                    "them",
                    w.pass_radius_m, w.hold_s));
  }
  return success();
}

Status check(const Mission& mission) {
  const std::size_t count = mission.waypoints.size();
  if (count == 0) return wrong("the mission has no waypoints");
  if (count > kMostWaypoints) {
    return wrong(fmt::format("the mission has {} waypoints, more than {}", count, kMostWaypoints));
  }
  for (std::size_t i = 0; i < count; ++i) {
    if (auto status = check(mission.waypoints[i]); !status) {
      return wrong(fmt::format("waypoint {}: {}", i + 1, status.error().message));
    }
  }
  if (mission.waypoints.back().passes()) {
    return wrong(
        fmt::format("waypoint {}, the last one, is passed: the vehicle must come to rest "
                    "there",
                    count));
  }
  return success();
}

double length_from(const Mission& mission, std::size_t next, const Vec3& place_map) {
  Vec3 from = place_map;
  double length_m = 0.0;
  for (std::size_t i = next; i < mission.waypoints.size(); ++i) {
    length_m += (mission.waypoints[i].position_map - from).norm();
    from = mission.waypoints[i].position_map;
  }
  return length_m;
}

}  // namespace goshawk::mission
