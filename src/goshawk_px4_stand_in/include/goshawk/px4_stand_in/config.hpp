#pragma once

#include <concepts>
#include <type_traits>

#include "goshawk/core/parameter.hpp"
#include "goshawk/px4_wire/release.hpp"
#include "goshawk/simulator/config.hpp"

namespace goshawk::px4_stand_in {

/// What the stand-in does when Offboard's signal is lost (COM_OBL_RC_ACT).
enum class LossAction { hold, land };
constexpr auto words_of(LossAction) {
  return std::to_array<Named<LossAction>>({{LossAction::hold, "hold"}, {LossAction::land, "land"}});
}

/// What the pilot's sticks do.
enum class Sticks { centred, moved };
constexpr auto words_of(Sticks) {
  return std::to_array<Named<Sticks>>({{Sticks::centred, "centred"}, {Sticks::moved, "moved"}});
}

struct Config {
  px4::Release release = px4::Release::v1_17;
  double start_x_m = 3.0, start_y_m = 0.0, start_z_m = 1.0, start_yaw_rad = 0.0;
  double ground_below_m = 0.9;
  double origin_x_m = 0.0, origin_y_m = 0.0, origin_z_m = 0.0, origin_yaw_rad = 0.0;
  double position_deviation_m = 0.02;
  double offboard_loss_s = 0.3;
  LossAction offboard_loss_action = LossAction::hold;
  double spool_up_s = 1.0;
  double takeoff_ramp_s = 3.0;
  double takeoff_height_m = 1.0;
  double hover_thrust = 0.5;
  int failed_armings = 1;
  double battery = 0.8;
  Sticks sticks = Sticks::centred;
  simulator::Config vehicle;  // its physics, its attitude loop and the wind
};

template <typename Self, typename Visitor>
void describe_place(Self& c, Visitor& visit) {
  visit("px4_release", c.release, "", "the PX4 release that it takes the place of", Anything{});
  visit("start_x_m", c.start_x_m, "m", "map x of the point above which it stands at first",
        Anything{});
  visit("start_y_m", c.start_y_m, "m", "map y of that point", Anything{});
  visit("start_z_m", c.start_z_m, "m", "map z of that point", Anything{});
  visit("start_yaw_rad", c.start_yaw_rad, "rad", "heading there, from map x to y",
        Range{-3.1416, 3.1416});
  visit("ground_below_m", c.ground_below_m, "m",
        "how far below that point the vehicle's centre is when it stands", Range{0.0, 100.0});
  visit("origin_x_m", c.origin_x_m, "m", "map x of the origin of PX4's local frame", Anything{});
  visit("origin_y_m", c.origin_y_m, "m", "map y of it", Anything{});
  visit("origin_z_m", c.origin_z_m, "m", "map z of it", Anything{});
  visit("origin_yaw_rad", c.origin_yaw_rad, "rad", "heading of its east in the map",
        Range{-3.1416, 3.1416});
  visit("position_deviation_m", c.position_deviation_m, "m",
        "standard deviation that it claims for its position", AtRunTime{Range{0.0, 100.0}});
}

template <typename Self, typename Visitor>
requires std::same_as<std::remove_const_t<Self>, Config>
void describe(Self& c, Visitor&& visit) {
  describe_place(c, visit);
  visit("offboard_loss_s", c.offboard_loss_s, "s", "COM_OF_LOSS_T", Range{0.05, 60.0});
  visit("offboard_loss_action", c.offboard_loss_action, "", "COM_OBL_RC_ACT", Anything{});
  visit("spool_up_s", c.spool_up_s, "s", "COM_SPOOLUP_TIME", Range{0.0, 30.0});
  visit("takeoff_ramp_s", c.takeoff_ramp_s, "s", "MPC_TKO_RAMP_T", Range{0.0, 30.0});
  visit("takeoff_height_m", c.takeoff_height_m, "m", "MIS_TAKEOFF_ALT", Range{0.3, 100.0});
  visit("hover_thrust", c.hover_thrust, "", "MPC_THR_HOVER, which is true here", Range{0.1, 0.8});
  visit("failed_armings", c.failed_armings, "",
        "so many first attempts to arm are rejected, as PX4 may do while its checks settle",
        Range{0.0, 100.0});
  visit("battery", c.battery, "", "charge from 0 to 1: low below 0.15, critical below 0.07",
        AtRunTime{Range{0.0, 1.0}});
  visit("sticks", c.sticks, "", "moved: the pilot takes over, in Position", AtRunTime{Anything{}});
  describe(c.vehicle.vehicle, visit);
  describe(c.vehicle.attitude, visit);
  const Range wind{-30.0, 30.0};
  visit("wind_x_m_s", c.vehicle.wind_x_m_s, "m/s", "constant wind towards map x", wind);
  visit("wind_y_m_s", c.vehicle.wind_y_m_s, "m/s", "constant wind towards map y", wind);
}

/// [m] map height of the vehicle's centre when it stands
inline double ground_z_m(const Config& config) {
  return config.start_z_m - config.ground_below_m;
}

/// Below it nobody arms.
inline constexpr double kCriticalCharge = 0.07;

/// @return invalid_parameter with every fault
Status check(const Config& config);

}  // namespace goshawk::px4_stand_in
