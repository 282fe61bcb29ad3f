#pragma once

#include <concepts>
#include <type_traits>

#include "goshawk/core/parameter.hpp"
#include "goshawk/px4_wire/release.hpp"

namespace goshawk::px4 {

/// How Goshawk gets control: PX4's Offboard mode, or a mode of its own that PX4 lists beside its
/// own modes.
enum class ModeKind { offboard, external };
constexpr auto words_of(ModeKind) {
  return std::to_array<Named<ModeKind>>(
      {{ModeKind::offboard, "offboard"}, {ModeKind::external, "external"}});
}

/// What is sent: position, velocity and acceleration for PX4's position controller, or thrust and
/// attitude.
enum class SetpointLevel { trajectory, attitude };
constexpr auto words_of(SetpointLevel) {
  return std::to_array<Named<SetpointLevel>>(
      {{SetpointLevel::trajectory, "trajectory"}, {SetpointLevel::attitude, "attitude"}});
}

/// Who arms and takes off: a person, or Goshawk, once, as soon as it can.
enum class Takeoff { pilot, automatic };
constexpr auto words_of(Takeoff) {
  return std::to_array<Named<Takeoff>>(
      {{Takeoff::pilot, "pilot"}, {Takeoff::automatic, "automatic"}});
}

struct Config {
  Release release = Release::v1_17;
  ModeKind mode = ModeKind::offboard;
  SetpointLevel setpoint = SetpointLevel::trajectory;
  Takeoff takeoff = Takeoff::pilot;
  double takeoff_height_m = 1.0;
  double takeoff_speed_m_s = 0.5;
  double land_height_m = 0.15;
  double origin_x_m = 0.0, origin_y_m = 0.0, origin_z_m = 0.0, origin_yaw_rad = 0.0;
  double v_max_m_s = 0.5;
  double a_max_m_s2 = 0.5;
  double margin_m = 0.35;
  double offboard_loss_s = 0.3;
  double brake_m_s2 = 3.0;
  double max_position_deviation_m = 0.1;
  double max_reset_m = 0.3;
  double max_heading_reset_rad = 0.2;
  double engage_distance_m = 0.5;
  double hand_over_after_s = 10.0;
  double mass_kg = 1.0;
  double hover_thrust = 0.5;
  double thrust_curve = 0.0;
};

template <typename Self, typename Visitor>
void describe_control(Self& c, Visitor& visit) {
  visit("px4_release", c.release, "", "PX4's release: its messages differ from release to release",
        Anything{});
  visit("mode", c.mode, "",
        "offboard: PX4's Offboard mode; external: a mode named Goshawk that PX4 lists with its own",
        Anything{});
  visit("setpoint", c.setpoint, "",
        "trajectory: position, velocity and acceleration; attitude: thrust and attitude of the "
        "tracker",
        Anything{});
  visit("takeoff", c.takeoff, "",
        "pilot: a person arms, takes off and selects the mode; automatic: this node does, once",
        Anything{});
  visit("takeoff_height_m", c.takeoff_height_m, "m",
        "automatic takeoff in Offboard: how far it climbs", Range{0.3, 100.0});
  visit("takeoff_speed_m_s", c.takeoff_speed_m_s, "m/s", "speed of that climb", Range{0.1, 3.0});
  visit(
      "land_height_m", c.land_height_m, "m",
      "a tracker that rests at this map height or below wants to land: PX4's Land mode takes over",
      Anything{});
}

template <typename Self, typename Visitor>
void describe_origin(Self& c, Visitor& visit) {
  visit("origin_x_m", c.origin_x_m, "m", "map x of the origin of PX4's local frame", Anything{});
  visit("origin_y_m", c.origin_y_m, "m", "map y of it", Anything{});
  visit("origin_z_m", c.origin_z_m, "m", "map z of it", Anything{});
  visit("origin_yaw_rad", c.origin_yaw_rad, "rad",
        "heading of PX4's east in the map, from x to y: 0 if the map is ENU",
        Range{-3.1416, 3.1416});
}

template <typename Self, typename Visitor>
void describe_margin(Self& c, Visitor& visit) {
  visit("v_max_m_s", c.v_max_m_s, "m/s",
        "fastest reference that is sent on: at least the navigator's v_max_m_s",
        Range::positive(30.0));
  visit("a_max_m_s2", c.a_max_m_s2, "m/s^2",
        "largest acceleration of the trajectories: the navigator's a_max_m_s2",
        Range::positive(30.0));
  visit("margin_m", c.margin_m, "m",
        "free space beside every trajectory: at most the map server's margin_m. It must cover how "
        "far PX4 flies on without setpoints",
        Range::positive(100.0));
  visit("offboard_loss_s", c.offboard_loss_s, "s",
        "PX4's COM_OF_LOSS_T: how long it follows the last setpoint in Offboard",
        Range{0.05, 60.0});
  visit("brake_m_s2", c.brake_m_s2, "m/s^2",
        "how hard PX4 brakes in its own hold, at least (MPC_ACC_HOR)", Range::positive(30.0));
  visit("max_position_deviation_m", c.max_position_deviation_m, "m",
        "largest standard deviation of PX4's position with which Goshawk flies",
        Range::positive(10.0));
  visit("max_reset_m", c.max_reset_m, "m",
        "a larger reset of PX4's position hands control to PX4's own Hold", Range::positive(100.0));
  visit("max_heading_reset_rad", c.max_heading_reset_rad, "rad",
        "a larger reset of PX4's heading does the same", Range::positive(3.1416));
  visit("engage_distance_m", c.engage_distance_m, "m",
        "the tracker's reference is flown only if the vehicle is this near to it",
        Range::positive(10.0));
  visit(
      "hand_over_after_s", c.hand_over_after_s, "s",
      "a silent tracker: how long its last stop is flown and held before PX4's own Hold takes over",
      Range{0.5, 3600.0});
}

template <typename Self, typename Visitor>
void describe_thrust(Self& c, Visitor& visit) {
  visit("mass_kg", c.mass_kg, "kg", "setpoint attitude: mass of the vehicle, as the tracker has it",
        Range::positive(1000.0));
  visit("hover_thrust", c.hover_thrust, "",
        "setpoint attitude: thrust from 0 to 1 with which it hovers (MPC_THR_HOVER)",
        Range{0.05, 0.95});
  visit("thrust_curve", c.thrust_curve, "",
        "setpoint attitude: share f of the square in thrust = f u^2 + (1 - f) u; 0 if PX4's "
        "THR_MDL_FAC makes it linear",
        Range{0.0, 1.0});
}

template <typename Self, typename Visitor>
requires std::same_as<std::remove_const_t<Self>, Config>
void describe(Self& c, Visitor&& visit) {
  describe_control(c, visit);
  describe_origin(c, visit);
  describe_margin(c, visit);
  describe_thrust(c, visit);
}

/// [s] How long PX4 may fly on with the last setpoint of a process that has died: in Offboard until
/// COM_OF_LOSS_T, in an external mode until four arming checks in a row were missed (1.15: three).
double follows_on_s(const Config& config);

/// [m] How far from the last setpoint the vehicle may come to rest then: for follows_on_s it goes
/// on with that speed, and with a_max_m_s2 more and more, then it brakes.
double flies_on_m(const Config& config, double speed_m_s);

/// @return invalid_parameter with every fault: out of range, or a margin that does not cover
/// flies_on_m() at v_max_m_s
Status check(const Config& config);

}  // namespace goshawk::px4
