#pragma once

#include <concepts>
#include <string>
#include <type_traits>

#include "goshawk/core/landing.hpp"
#include "goshawk/core/parameter.hpp"
#include "goshawk/core/result.hpp"
#include "goshawk/core/words.hpp"

namespace goshawk::tracker {

/// What the verdict of flight_check on a committed trajectory means to the tracker.
enum class SecondOpinion {
  off,      // nothing
  heed,     // a trajectory that it finds touching is not flown, or braked for
  require,  // also: only a trajectory that it found free is flown
};

constexpr auto words_of(SecondOpinion) {
  using enum SecondOpinion;
  return std::to_array<Named<SecondOpinion>>({{off, "off"}, {heed, "heed"}, {require, "require"}});
}

/// Defaults are tuned for the default vehicle of goshawk_simulator; README.md, Tuning.
struct Config {
  std::string controller = "pd";
  std::string yaw = "plan";

  double mass_kg = 1.0;
  double min_thrust_n = 2.0;
  double max_thrust_n = 25.0;
  double max_tilt_rad = 0.8;
  double linear_drag_xy_kg_s = 0.25;
  double linear_drag_z_kg_s = 0.15;
  double actuation_delay_s = 0.02;

  double position_xy_1_s2 = 16.0;
  double position_z_1_s2 = 20.0;
  double velocity_xy_1_s = 6.8;
  double velocity_z_1_s = 7.8;
  double max_position_error_m = 0.2;
  double max_feedback_m_s2 = 6.0;
  double disturbance_bandwidth_rad_s = 6.0;
  double max_disturbance_m_s2 = 4.0;
  double max_yaw_rate_rad_s = 1.0;
  double max_body_rate_rad_s = 10.0;

  double start_tolerance_m = 0.05;
  double start_velocity_tolerance_m_s = 0.2;
  bool require_map = true;
  bool fly_unknown = false;
  double map_wait_s = 0.5;
  SecondOpinion second_opinion = SecondOpinion::heed;
  double second_opinion_wait_s = 0.5;
  double error_allowance_m = 0.05;
  double max_jump_m = 0.1;
  double odometry_timeout_s = 0.1;
  double brake_acceleration_m_s2 = 2.0;
  double stop_acceleration_m_s2 = 5.0;
  double fallback_after_s = 0.15;
  double navigator_timeout_s = 2.0;
  LandingRule landing = LandingRule::map;
  double land_after_s = 10.0;
  double land_speed_m_s = 0.3;
  double land_height_m = 0.1;
};

namespace detail {

template <typename Self, typename Visitor>
void describe_vehicle(Self& c, Visitor& visit) {
  visit("mass_kg", c.mass_kg, "kg", "mass of the vehicle", Range::positive(1000.0));
  visit("min_thrust_n", c.min_thrust_n, "N", "least collective thrust that is asked for",
        Range{0.0, 1e5});
  visit("max_thrust_n", c.max_thrust_n, "N",
        "most collective thrust that is asked for; leave the motors some for attitude control",
        Range::positive(1e5));
  visit("max_tilt_rad", c.max_tilt_rad, "rad", "steepest tilt that is asked for", Range{0.05, 1.2});
  visit("linear_drag_xy_kg_s", c.linear_drag_xy_kg_s, "kg/s",
        "known horizontal drag per speed, compensated by feedforward", Range{0.0, 100.0});
  visit("linear_drag_z_kg_s", c.linear_drag_z_kg_s, "kg/s", "the same, vertical",
        Range{0.0, 100.0});
  visit("actuation_delay_s", c.actuation_delay_s, "s",
        "feedforward is taken this far ahead: lag of motors and attitude loop, and transport",
        Range{0.0, 0.3});
}

template <typename Self, typename Visitor>
void describe_gains(Self& c, Visitor& visit) {
  visit("position_xy_1_s2", c.position_xy_1_s2, "1/s^2",
        "acceleration for a horizontal position error", Range::positive(100.0));
  visit("position_z_1_s2", c.position_z_1_s2, "1/s^2", "acceleration for a height error",
        Range::positive(100.0));
  visit("velocity_xy_1_s", c.velocity_xy_1_s, "1/s", "acceleration for a horizontal velocity error",
        Range::positive(50.0));
  visit("velocity_z_1_s", c.velocity_z_1_s, "1/s", "acceleration for a climb rate error",
        Range::positive(50.0));
  visit("max_position_error_m", c.max_position_error_m, "m",
        "largest position error that is corrected at once; times position over velocity gain, it "
        "bounds the speed of catching up",
        Range::positive(100.0));
  visit("max_feedback_m_s2", c.max_feedback_m_s2, "m/s^2",
        "largest acceleration that position and velocity errors may ask for",
        Range::positive(50.0));
  visit("disturbance_bandwidth_rad_s", c.disturbance_bandwidth_rad_s, "rad/s",
        "how fast unknown steady forces (wind) are learnt and cancelled; 0: not at all",
        Range{0.0, 20.0});
  visit("max_disturbance_m_s2", c.max_disturbance_m_s2, "m/s^2",
        "largest unknown acceleration that is cancelled", Range{0.0, 20.0});
  visit("max_yaw_rate_rad_s", c.max_yaw_rate_rad_s, "rad/s", "how fast the vehicle is turned",
        Range::positive(10.0));
  visit("max_body_rate_rad_s", c.max_body_rate_rad_s, "rad/s", "body-rate feedforward limit",
        Range::positive(50.0));
}

template <typename Self, typename Visitor>
void describe_safety(Self& c, Visitor& visit) {
  visit("start_tolerance_m", c.start_tolerance_m, "m",
        "how far from the vehicle, or from the trajectory flown, a new one may begin",
        Range::positive(10.0));
  visit("start_velocity_tolerance_m_s", c.start_velocity_tolerance_m_s, "m/s",
        "the same for its velocity", Range::positive(10.0));
  visit("require_map", c.require_map, "",
        "only what the map shows free is flown; false: without any map, trajectories are flown "
        "unchecked",
        Anything{});
  visit("fly_unknown", c.fly_unknown, "",
        "if the map leaves unknown space free, it is flown through as if it were free; false: only "
        "space in which the whole body was seen to be free",
        Anything{});
  visit("map_wait_s", c.map_wait_s, "s",
        "how long a trajectory waits for the map version that it names, before it is refused",
        Range{0.0, 60.0});
  visit("second_opinion", c.second_opinion, "",
        "verdicts of flight_check: not heard (off), a trajectory that it finds touching is not "
        "flown (heed), or only one that it found free is flown (require)",
        Anything{});
  visit("second_opinion_wait_s", c.second_opinion_wait_s, "s",
        "require: how long a trajectory waits for its verdict, before it is refused",
        Range{0.0, 60.0});
  visit("error_allowance_m", c.error_allowance_m, "m",
        "tracking error that the safety margin covers (margin_m of map_server); beyond it the "
        "vehicle is stopped where it is",
        Range::positive(100.0));
  visit("max_jump_m", c.max_jump_m, "m",
        "odometry that moves this much more than its velocity explains has jumped",
        Range::positive(100.0));
  visit("odometry_timeout_s", c.odometry_timeout_s, "s",
        "older odometry is not flown on; after a pause of its own of this length the tracker stops "
        "the vehicle where it is",
        Range{0.001, 10.0});
  visit("brake_acceleration_m_s2", c.brake_acceleration_m_s2, "m/s^2",
        "deceleration of the reference when it brakes along its path", Range{0.1, 20.0});
  visit("stop_acceleration_m_s2", c.stop_acceleration_m_s2, "m/s^2",
        "hardest deceleration of a vehicle that is stopped where it is; at least "
        "brake_acceleration_m_s2",
        Range{0.1, 20.0});
  visit("fallback_after_s", c.fallback_after_s, "s",
        "the fallback stop that the vehicle gets in advance brakes this long after it was made: "
        "the vehicle's own command_timeout_s, and 0.05 s between two of them",
        Range{0.0, 10.0});
  visit("navigator_timeout_s", c.navigator_timeout_s, "s",
        "a navigator that was heard once and then is silent for this long is lost",
        AtRunTime{Range{0.1, 3600.0}});
  visit("landing", c.landing, "",
        "without a navigator: land where the map shows the way straight down free (map), as if it "
        "were free everywhere (anywhere), or never",
        Anything{});
  visit("land_after_s", c.land_after_s, "s",
        "without a navigator: how long the vehicle holds at rest before it lands",
        AtRunTime{Range{0.0, 3600.0}});
  visit("land_speed_m_s", c.land_speed_m_s, "m/s", "fastest descent of a landing",
        Range{0.05, 2.0});
  visit("land_height_m", c.land_height_m, "m",
        "height in the map at which a landing ends: the ground, plus the legs", Anything{});
}

}  // namespace detail

template <typename Self, typename Visitor>
requires std::same_as<std::remove_const_t<Self>, Config>
void describe(Self& c, Visitor&& visit) {
  visit("controller", c.controller, "",
        "pd: thesis, PD with feedforward; geometric: on SE(3), after Lee, Leok, McClamroch 2010",
        OneOf{{"pd", "geometric"}});
  visit("yaw", c.yaw, "",
        "plan: the trajectory's yaw, over time where it has a curve; keep: the yaw at the first "
        "odometry",
        AtRunTime{OneOf{{"plan", "keep"}}});
  detail::describe_vehicle(c, visit);
  detail::describe_gains(c, visit);
  detail::describe_safety(c, visit);
}

/// @return invalid_parameter with every fault: out of range, and a vehicle whose thrust bounds do
/// not hold its weight between them
Status check(const Config& config);

}  // namespace goshawk::tracker
