#include "goshawk/flight_report/flight.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace goshawk::flight_report {

namespace {

constexpr double kFarthest_m = 1e6;

Error wrong(const std::string& what) {
  return fail(ErrorCode::invalid_input, "the flight cannot be drawn: " + what);
}

bool usable(const Vec3& p) {
  return p.allFinite() && p.cwiseAbs().maxCoeff() <= kFarthest_m;
}

bool usable(const std::vector<Vec3>& points) {
  for (const Vec3& p : points) {
    if (!usable(p)) return false;
  }
  return true;
}

Status check_grid(const VoxelGrid* grid, const char* name) {
  if (grid == nullptr) return success();
  if (auto status = grid->check(); !status) {
    return wrong(std::string("its ") + name + ": " + status.error().message);
  }
  if (!usable(grid->geometry.origin_map) || !usable(grid->geometry.upper_corner_map())) {
    return wrong(std::string("its ") + name + " reach beyond 1e6 m");
  }
  return success();
}

Status check_leg(const Leg& leg, const std::string& name) {
  if (!usable(leg.raw_path_map) || !usable(leg.waypoints_map)) {
    return wrong(name + " has a path point that is not finite or beyond 1e6 m");
  }
  for (const Polytope& polytope : leg.corridor) {
    if (auto status = polytope.check(); !status) {
      return wrong(name + " has a bad polytope: " + status.error().message);
    }
  }
  if (!std::isfinite(leg.start_t_s)) return wrong(name + " has a start time that is not finite");
  if (!std::isfinite(leg.yaw_rad)) return wrong(name + " has a yaw that is not finite");
  if (leg.yaw_curve) {
    if (auto status = leg.yaw_curve->check(); !status) {
      return wrong(name + ": " + status.error().message);
    }
  }
  if (!std::isfinite(leg.stop_after_s)) return wrong(name + " has a stop that is not finite");
  if (!leg.nominal.pieces.empty()) {
    if (auto status = leg.nominal.check(); !status) {
      return wrong(name + " has a bad nominal part: " + status.error().message);
    }
  }
  if (leg.trajectory.pieces.empty()) return success();
  if (auto status = leg.trajectory.check(); !status) {
    return wrong(name + " has a bad trajectory: " + status.error().message);
  }
  for (const BezierPiece& piece : leg.trajectory.pieces) {
    if (piece.control_points.cwiseAbs().maxCoeff() > kFarthest_m) {
      return wrong(name + " has a control point beyond 1e6 m");
    }
  }
  return success();
}

Status check_flown(const std::vector<FlownSample>& flown) {
  for (std::size_t i = 0; i < flown.size(); ++i) {
    const FlownSample& s = flown[i];
    const std::string name = fmt::format("flown sample {}", i);
    if (!std::isfinite(s.t_s) || !usable(s.position_map) || !usable(s.velocity_map) ||
        !s.q_map_base.coeffs().allFinite()) {
      return wrong(name + " has a number that is not finite or beyond 1e6");
    }
    if (i > 0 && s.t_s < flown[i - 1].t_s) return wrong(name + " goes back in time");
  }
  return success();
}

Status check_maps(const std::vector<MapMoment>& maps) {
  for (const MapMoment& moment : maps) {
    if (!std::isfinite(moment.t_s)) return wrong("a map has a time that is not finite");
    if (auto status = check_grid(&moment.grid, "maps"); !status) return status;
  }
  return success();
}

/// From its start to its end, as far as it is known.
std::vector<Vec3> line_of(const Leg& leg) {
  if (!leg.waypoints_map.empty()) return leg.waypoints_map;
  if (!leg.raw_path_map.empty()) return leg.raw_path_map;
  if (leg.trajectory.pieces.empty()) return {};
  return {leg.trajectory.sample(0.0).position,
          leg.trajectory.sample(leg.trajectory.duration_s()).position};
}

bool empty(const Leg& leg) {
  return leg.raw_path_map.empty() && leg.waypoints_map.empty() && leg.trajectory.pieces.empty() &&
         leg.corridor.empty();
}

}  // namespace

Leg Leg::of(const CommittedTrajectory& committed, std::int64_t origin_ns) {
  Leg leg;
  leg.corridor = committed.flown_polytopes();
  leg.trajectory = committed.flown();
  leg.start_t_s = double(committed.start_time_ns() - origin_ns) * 1e-9;
  leg.yaw_rad = committed.yaw_rad();
  leg.yaw_curve = committed.yaw_curve();
  if (const auto& stop = committed.stop()) {
    leg.stop_after_s = stop->after_s;
    leg.nominal = committed.nominal().trajectory();
  }
  return leg;
}

Status Flight::check() const {
  if (auto status = limits.check(); !status) return wrong(status.error().message);
  if (!(body_radius_m > 0.0 && body_radius_m <= kFarthest_m)) {
    return wrong("the body's radius is not above zero");
  }
  if (auto status = check_grid(obstacles, "obstacles"); !status) return status;
  if (auto status = check_grid(grown, "grown obstacles"); !status) return status;
  if (auto status = check_flown(flown); !status) return status;
  if (auto status = check_maps(maps); !status) return status;
  if (auto status = check_movers(movers, predictions); !status)
    return wrong(status.error().message);
  if (!usable(goals_map)) return wrong("a goal is not finite or beyond 1e6 m");
  bool anything = !flown.empty() || obstacles != nullptr || grown != nullptr;
  for (std::size_t i = 0; i < legs.size(); ++i) {
    if (auto status = check_leg(legs[i], fmt::format("leg {}", i)); !status) return status;
    anything = anything || !empty(legs[i]);
  }
  return anything ? success() : Status(wrong("there is no map, no path and no track in it"));
}

std::vector<Vec3> Flight::stops_map() const {
  std::vector<Vec3> stops;
  if (!goals_map.empty() && !flown.empty()) stops = {flown.front().position_map};
  for (const Leg& leg : legs) {
    const std::vector<Vec3> line = line_of(leg);
    if (line.empty()) continue;
    if (stops.empty()) stops.push_back(line.front());
    if (goals_map.empty()) stops.push_back(line.back());
  }
  if (!stops.empty()) {
    stops.insert(stops.end(), goals_map.begin(), goals_map.end());
  } else if (!flown.empty()) {
    stops = {flown.front().position_map, flown.back().position_map};
  }
  return stops;
}

std::vector<FollowedLeg> Flight::followed() const {
  std::vector<FollowedLeg> parts;
  double next_s = std::numeric_limits<double>::infinity();
  for (auto leg = legs.rbegin(); leg != legs.rend(); ++leg) {
    if (leg->trajectory.pieces.empty()) continue;
    const double whole_s = leg->trajectory.duration_s(), most_s = next_s - leg->start_t_s;
    next_s = std::min(next_s, leg->start_t_s);
    if (most_s <= 0.0) continue;
    const bool whole = most_s >= whole_s;
    parts.push_back({&*leg, whole ? leg->trajectory : leg->trajectory.until(most_s),
                     std::min(most_s, whole_s), whole});
  }
  std::ranges::reverse(parts);
  return parts;
}

std::vector<const Leg*> Flight::kept_legs() const {
  const auto parts = followed();
  std::vector<const Leg*> kept;
  for (const Leg& leg : legs) {
    const auto is_it = [&](const FollowedLeg& part) { return part.leg == &leg && part.whole; };
    if (leg.trajectory.pieces.empty() || std::ranges::any_of(parts, is_it)) kept.push_back(&leg);
  }
  return kept;
}

std::optional<FlatState> Flight::planned_at(double t_s) const {
  // Not the one that began last: stamps of the same moment differ by microseconds from message to
  // message.
  const auto current = std::find_if(legs.rbegin(), legs.rend(), [&](const Leg& leg) {
    return !leg.trajectory.pieces.empty() && leg.start_t_s <= t_s;
  });
  if (current == legs.rend()) return std::nullopt;
  const double in_leg_s = std::min(t_s - current->start_t_s, current->trajectory.duration_s());
  return current->trajectory.sample(in_leg_s);
}

}  // namespace goshawk::flight_report
