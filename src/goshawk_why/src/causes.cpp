// Why the vehicle does not fly to its goal.

#include "causes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "voxels.hpp"

namespace goshawk::why {
namespace {

constexpr double kLate_s = 0.5;  // a plan from rest takes some milliseconds

constexpr std::array kPlanners{StageRole::path_search, StageRole::corridor_builder,
                               StageRole::trajectory_optimizer};

std::string map_text(const Snapshot& s) {
  return fmt::format("in map {}, {:.1f} s old", s.map->version, s.map_age_s);
}

// The first planning stage that has not answered the newest request.
std::optional<StageRole> unanswered(const Snapshot& s) {
  for (const StageRole stage : kPlanners) {
    const bool answered = std::ranges::any_of(s.reports, [&](const Snapshot::Report& r) {
      return r.stage == stage && r.request_id == s.navigator->request_id;
    });
    if (!answered) return stage;
  }
  return {};
}

Reason silent_planner(const Snapshot& s, StageRole stage, double waited_s) {
  return {
      .binds = Binds::silent_stage,
      .because = fmt::format("{} has not answered request {} for {:.1f} s.", to_string(stage),
                             s.navigator->request_id, waited_s),
      .mend = fmt::format("Check that {} runs (goshawk node list), and look at its log. If plans "
                          "take long, raise navigator plan_timeout_s.",
                          to_string(stage)),
      .stage = stage,
      .parameter = "navigator plan_timeout_s"};
}

// A place that the vehicle's centre cannot have.
Reason blocked_place(const Snapshot& s, const Vec3& place_map, const char* what, Binds binds) {
  const auto voxel = blocking_voxel(*s.map, place_map);
  Reason reason{.binds = binds, .voxel = voxel};
  if (!voxel) {  // the map has changed since
    reason.because = fmt::format("{} {} was refused: {}.", what, goshawk::to_text(place_map),
                                 s.navigator->reason.message);
    reason.mend = "The newest map shows it free: send the goal again.";
    return reason;
  }
  reason.because = fmt::format("{} {} is {:.2f} m from {} {}; the vehicle's centre keeps {:.2f} m.",
                               what, goshawk::to_text(place_map), voxel->distance_m,
                               to_text(*voxel), map_text(s), s.map->inflation_m);
  if (!voxel->known) {
    reason.mend = "Let the sensor see it, or take unknown space as free: map_server unknown.";
    reason.parameter = "map_server unknown";
  } else {
    reason.mend = "Choose another place, or lower map_server radius_m or margin_m.";
    reason.parameter = "map_server margin_m";
  }
  return reason;
}

Reason refused(const Snapshot& s) {
  const Error& why = s.navigator->reason;
  const auto report = std::ranges::find_if(s.reports, [&](const Snapshot::Report& r) {
    return r.request_id == s.navigator->request_id && r.outcome.code == why.code;
  });
  Reason reason{.binds = Binds::refused,
                .because = fmt::format("{}: {}.", goshawk::to_string(why.code), why.message),
                .mend = fmt::format("docs/troubleshooting.md lists what to do about {}.",
                                    goshawk::to_string(why.code))};
  if (report != s.reports.end()) reason.stage = report->stage;
  return reason;
}

}  // namespace

std::optional<Reason> tracker_stop(const Snapshot& s) {
  using Mode = Snapshot::Tracker::Mode;
  const bool lands = s.tracker->mode == Mode::land;
  if (s.tracker->mode != Mode::brake && !lands) return {};
  const auto report = std::ranges::find_if(s.reports, [](const Snapshot::Report& r) {
    return r.stage == StageRole::tracker && r.outcome.code != ErrorCode::ok;
  });
  Reason reason{.binds = Binds::tracker_stops,
                .because = lands ? "The tracker lands it" : "The tracker brakes it",
                .mend = lands ? "Look at the navigator's log: the tracker has not heard it."
                              : "The navigator plans to the goal again once the vehicle rests.",
                .stage = StageRole::tracker};
  if (report == s.reports.end()) {
    reason.because += ".";
  } else {
    reason.because += fmt::format(": {}.", report->outcome.message);
  }
  return reason;
}

Reason failure(const Snapshot& s) {
  using enum ErrorCode;
  const Vec3& goal_map = s.navigator->goal_map;
  const std::string goal = goshawk::to_text(goal_map);
  switch (s.navigator->reason.code) {
    case goal_occupied:
      return blocked_place(s, goal_map, "Its goal", Binds::goal_blocked);
    case goal_unknown:
      return blocked_place(s, goal_map, "Its goal", Binds::goal_unknown);
    case start_occupied:
    case start_unknown:
      return blocked_place(s, s.vehicle->position_map, "Its own place", Binds::start_blocked);
    case goal_outside:
      // The search may be kept to a part of the map.
      if (s.map->geometry.index_of(goal_map)) return refused(s);
      return {.binds = Binds::goal_outside,
              .because = fmt::format("Its goal {} lies outside of the map.", goal),
              .mend = fmt::format("Choose one between {} and {}.",
                                  goshawk::to_text(s.map->geometry.origin_map),
                                  goshawk::to_text(s.map->geometry.upper_corner_map()))};
    case no_path:
      return {.binds = Binds::unreachable,
              .because = fmt::format("No path leads to its goal {} {}.", goal, map_text(s)),
              .mend =
                  "Look for a closed door. A smaller map_server radius_m or margin_m opens narrow "
                  "gaps; map_server unknown opens space that was never seen.",
              .stage = StageRole::path_search,
              .parameter = "map_server margin_m"};
    case stage_silent:
      if (const auto stage = unanswered(s)) return silent_planner(s, *stage, s.navigator->since_s);
      return refused(s);
    default:
      return refused(s);
  }
}

Reason planning(const Snapshot& s) {
  if (s.navigator->reason.code != ErrorCode::ok) return refused(s);
  const auto stage = unanswered(s);
  if (stage && s.navigator->since_s > kLate_s) {
    return silent_planner(s, *stage, s.navigator->since_s);
  }
  return {.binds = Binds::nothing,
          .because = fmt::format("It asked for a plan {:.1f} s ago.", s.navigator->since_s)};
}

}  // namespace goshawk::why
