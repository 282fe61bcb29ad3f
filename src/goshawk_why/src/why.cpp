#include "goshawk/why/why.hpp"

#include <fmt/format.h>

#include <array>

#include "causes.hpp"

namespace goshawk::why {
namespace {

constexpr double kMoves_m_s = 0.1;

using Nav = Snapshot::Navigator::State;

std::string doing_of(const Snapshot& s) {
  if (!s.vehicle || s.vehicle->age_s > kSilent_s) return "The vehicle's position is unknown.";
  const std::string place = goshawk::to_text(s.vehicle->position_map);
  if (s.vehicle->speed_m_s < kMoves_m_s) return fmt::format("The vehicle hovers at {}.", place);
  return fmt::format("The vehicle flies at {:.2f} m/s at {}.", s.vehicle->speed_m_s, place);
}

// A part that is not heard at all.
std::optional<Reason> silent_part(const Snapshot& s) {
  if (!s.navigator || s.navigator->age_s > kSilent_s) {
    return Reason{.binds = Binds::no_navigator,
                  .because = s.navigator
                                 ? fmt::format("The navigator has been silent for {:.1f} s.",
                                               s.navigator->age_s)
                                 : "No navigator is heard.",
                  .mend =
                      "Check that a flight runs with the same ROS_DOMAIN_ID and namespace "
                      "(goshawk node list), and look at the navigator's log.",
                  .stage = StageRole::navigator};
  }
  if (!s.vehicle || s.vehicle->age_s > kSilent_s) {
    return Reason{
        .binds = Binds::no_odometry,
        .because = s.vehicle ? fmt::format("No odometry has come for {:.1f} s.", s.vehicle->age_s)
                             : "No odometry comes.",
        .mend = "Look at the simulator's log, or at the autopilot's bridge.",
        .stage = StageRole::vehicle};
  }
  if (!s.tracker || s.tracker->age_s > kSilent_s) {
    return Reason{.binds = Binds::silent_stage,
                  .because = "The tracker is silent, so no setpoint reaches the vehicle.",
                  .mend = "Check that it runs (goshawk node list), and look at its log.",
                  .stage = StageRole::tracker};
  }
  return {};
}

// Somebody else decides.
std::optional<Reason> other_hand(const Snapshot& s) {
  using Control = Snapshot::Status::Control;
  if (s.status && !s.status->armed) {
    return Reason{.binds = Binds::disarmed,
                  .because = "The vehicle is disarmed.",
                  .mend = "Arm it with the autopilot's own tool.",
                  .stage = StageRole::vehicle};
  }
  if (s.status && s.status->control == Control::pilot) {
    return Reason{.binds = Binds::other_control,
                  .because = "A person flies it with a remote control.",
                  .mend = "Setpoints are flown again when the pilot hands over.",
                  .stage = StageRole::vehicle};
  }
  if (s.status && (s.status->failsafe || s.status->control == Control::autopilot)) {
    return Reason{.binds = Binds::other_control,
                  .because = "The vehicle flies by its own failsafe: no setpoints reach it.",
                  .mend = "Look at the tracker's log.",
                  .stage = StageRole::tracker};
  }
  if (s.navigator->state == Nav::held) {
    return Reason{.binds = Binds::operator_hold,
                  .because = "An operator holds it.",
                  .mend = "goshawk resume flies on."};
  }
  return {};
}

std::optional<Reason> by_navigator(const Snapshot& s) {
  switch (s.navigator->state) {
    case Nav::idle:
      return Reason{.binds = Binds::no_goal,
                    .because = "It has no goal.",
                    .mend = "goshawk goto x,y,z sends one."};
    case Nav::arrived:
      return Reason{.binds = Binds::nothing, .because = "It has arrived at its goal."};
    case Nav::failed:
      return failure(s);
    case Nav::planning:
      return planning(s);
    default:
      return flight(s);
  }
}

std::optional<Reason> first_cause(const Snapshot& s) {
  if (auto reason = silent_part(s)) return reason;
  if (auto reason = other_hand(s)) return reason;
  if (auto reason = tracker_stop(s)) return reason;
  if (s.map == nullptr) {
    return Reason{.binds = Binds::no_map,
                  .because = "No map has come, so nothing can be planned or checked.",
                  .mend = "Look at the map server's log.",
                  .stage = StageRole::map_server};
  }
  if (s.mission && s.mission->waits && s.navigator->state != Nav::flying &&
      s.navigator->state != Nav::failed) {
    return Reason{.binds = Binds::mission_waits,
                  .because = fmt::format("Its mission waits: {}.", s.mission->message),
                  .mend = "goshawk resume flies on."};
  }
  return by_navigator(s);
}

}  // namespace

std::string_view to_string(Binds binds) {
  constexpr std::array<std::string_view, 23> words{
      "nothing",       "no_navigator",  "no_odometry",  "disarmed",      "other_control",
      "operator_hold", "mission_waits", "no_goal",      "no_map",        "silent_stage",
      "goal_blocked",  "goal_unknown",  "goal_outside", "start_blocked", "unreachable",
      "refused",       "tracker_stops", "unseen_ahead", "speed_limit",   "acceleration_limit",
      "jerk_limit",    "end_ahead",     "way"};
  return words.at(std::size_t(binds));
}

Reason explain(const Snapshot& snapshot) {
  Reason reason = first_cause(snapshot).value_or(Reason{});
  reason.doing = doing_of(snapshot);
  return reason;
}

}  // namespace goshawk::why
