#include "goshawk/mission_messages/messages.hpp"

#include "goshawk/conversions/geometry.hpp"
#include "goshawk/conversions/status.hpp"

namespace goshawk::mission {
namespace {

namespace msg = goshawk_msgs::msg;
namespace nav = goshawk_msgs::msg::NavigatorState_Constants;
namespace constants = goshawk_msgs::msg::MissionState_Constants;

static_assert(std::uint8_t(State::none) == constants::STATE_NONE &&
              std::uint8_t(State::flying) == constants::STATE_FLYING &&
              std::uint8_t(State::waiting) == constants::STATE_WAITING &&
              std::uint8_t(State::paused) == constants::STATE_PAUSED &&
              std::uint8_t(State::done) == constants::STATE_DONE &&
              std::uint8_t(State::failed) == constants::STATE_FAILED &&
              std::uint8_t(State::cancelled) == constants::STATE_CANCELLED);

std::optional<NavigatorNews::Does> does_of(std::uint8_t state) {
  using enum NavigatorNews::Does;
  switch (state) {
    case nav::STATE_IDLE:
      return idle;
    case nav::STATE_PLANNING:
    case nav::STATE_FLYING:
      return pursues;
    case nav::STATE_ARRIVED:
      return arrived;
    case nav::STATE_FAILED:
      return failed;
    case nav::STATE_HELD:
      return held;
    default:
      return {};
  }
}

}  // namespace

Result<Mission> from_msg(const msg::Mission& m) {
  if (auto s = conversions::check_frame(m.header(), conversions::kMapFrame, "a mission"); !s) {
    return s.error();
  }
  Mission mission{.id = m.id(), .client = m.client(), .name = m.name()};
  mission.waypoints.reserve(m.waypoints().size());
  for (const auto& w : m.waypoints()) {
    Waypoint waypoint{.position_map = conversions::from_msg(w.position()),
                      .hold_s = w.hold(),
                      .v_max_m_s = w.v_max(),
                      .pass_radius_m = w.pass_radius()};
    if (w.has_yaw()) waypoint.yaw_rad = w.yaw();
    mission.waypoints.push_back(waypoint);
  }
  return mission;
}

msg::Mission to_msg(const Mission& mission, std::int64_t stamp_ns) {
  msg::Mission m;
  m.header(conversions::make_header(stamp_ns));
  m.id(mission.id);
  m.client(mission.client);
  m.name(mission.name);
  for (const Waypoint& waypoint : mission.waypoints) {
    msg::MissionWaypoint w;
    w.position(conversions::to_point(waypoint.position_map));
    w.has_yaw(waypoint.yaw_rad.has_value());
    w.yaw(waypoint.yaw_rad.value_or(0.0));
    w.hold(waypoint.hold_s);
    w.v_max(waypoint.v_max_m_s);
    w.pass_radius(waypoint.pass_radius_m);
    m.waypoints().push_back(w);
  }
  return m;
}

msg::Goal to_msg(const Goal& goal, std::int64_t stamp_ns) {
  msg::Goal m;
  m.header(conversions::make_header(stamp_ns));
  m.position(conversions::to_point(goal.position_map));
  m.yaw(goal.yaw_rad);
  m.v_max(goal.v_max_m_s);
  return m;
}

std::optional<NavigatorNews> from_msg(const msg::NavigatorState& m) {
  const auto does = does_of(m.state());
  if (!does) return {};
  return NavigatorNews{.does = *does,
                       .goal_map = conversions::from_msg(m.goal()),
                       .reason = {conversions::error_code_of(m.code()), m.message()},
                       .stamp_ns = conversions::to_ns(m.header().stamp())};
}

msg::MissionState to_msg(const Mission& mission, const Progress& progress, std::int64_t stamp_ns) {
  msg::MissionState m;
  m.header(conversions::make_header(stamp_ns));
  m.state(std::uint8_t(progress.state));
  m.id(mission.id);
  m.client(mission.client);
  m.name(mission.name);
  m.waypoint(std::uint32_t(progress.waypoint));
  m.waypoints(std::uint32_t(mission.waypoints.size()));
  m.position(conversions::to_point(progress.position_map));
  m.distance_left(progress.left_m);
  m.hold_left(progress.hold_left_s);
  m.code(std::string(to_string(progress.reason.code)));
  m.message(progress.reason.message);
  return m;
}

State mission_state_of(std::uint8_t value) {
  return value <= constants::STATE_CANCELLED ? State(value) : State::none;
}

}  // namespace goshawk::mission
