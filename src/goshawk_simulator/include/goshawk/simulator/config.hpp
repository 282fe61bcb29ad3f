#pragma once

#include <concepts>
#include <type_traits>

#include "goshawk/core/landing.hpp"
#include "goshawk/core/parameter.hpp"
#include "goshawk/plant/vehicle_parameters.hpp"
#include "goshawk/simulator/attitude_controller.hpp"
#include "goshawk/simulator/sensor.hpp"

namespace goshawk::simulator {

struct Config {
  plant::VehicleParameters vehicle;
  AttitudeGains attitude;
  double command_timeout_s = 0.1;
  double failsafe_tilt_rad = 0.87;
  double fallback_tolerance_m = 0.1;
  double failsafe_hold_s = 10.0;
  LandingRule landing = LandingRule::map;
  double land_speed_m_s = 0.3;
  double land_height_m = 0.1;
  SensorParameters sensor;
  double wind_x_m_s = 0.0;
  double wind_y_m_s = 0.0;
  double wind_z_m_s = 0.0;
  double gust_deviation_m_s = 0.0;
  double gust_time_s = 1.0;
  int gust_seed = 1;
};

template <typename Self, typename Visitor>
requires std::same_as<std::remove_const_t<Self>, SensorParameters>
void describe(Self& s, Visitor&& visit) {
  visit("position_noise_m", s.position_noise_m, "m",
        "odometry: standard deviation of the white noise on each axis of the position",
        Range{0.0, 10.0});
  visit("velocity_noise_m_s", s.velocity_noise_m_s, "m/s",
        "odometry: standard deviation of the white noise on each axis of the velocity",
        Range{0.0, 10.0});
  visit("attitude_noise_rad", s.attitude_noise_rad, "rad",
        "odometry: standard deviation of the white noise of the attitude, about each body axis",
        Range{0.0, 0.5});
  visit("body_rate_noise_rad_s", s.body_rate_noise_rad_s, "rad/s",
        "odometry: standard deviation of the white noise of the body rates", Range{0.0, 10.0});
  visit("odometry_delay_s", s.delay_s, "s",
        "age of odometry when it is published; its stamp is the true time", Range{0.0, 1.0});
  visit("sensor_seed", s.seed, "", "seed of the noise: the same seed gives the same noise",
        Range{0.0, 2147483647.0});
}

template <typename Self, typename Visitor>
requires std::same_as<std::remove_const_t<Self>, AttitudeGains>
void describe(Self& a, Visitor&& visit) {
  visit("attitude_tilt_1_s2", a.tilt_1_s2, "1/s^2",
        "onboard loop: angular acceleration for a roll or pitch error", Range::positive(1e4));
  visit("attitude_tilt_rate_1_s", a.tilt_rate_1_s, "1/s",
        "onboard loop: angular acceleration for a roll or pitch rate error", Range::positive(200));
  visit("attitude_yaw_1_s2", a.yaw_1_s2, "1/s^2",
        "onboard loop: angular acceleration for a yaw error", Range::positive(1e4));
  visit("attitude_yaw_rate_1_s", a.yaw_rate_1_s, "1/s",
        "onboard loop: angular acceleration for a yaw rate error", Range::positive(200));
}

template <typename Self, typename Visitor>
requires std::same_as<std::remove_const_t<Self>, Config>
void describe(Self& c, Visitor&& visit) {
  const Range wind{-30.0, 30.0};
  describe(c.vehicle, visit);
  describe(c.attitude, visit);
  visit("command_timeout_s", c.command_timeout_s, "s",
        "without a command for this long, the failsafe brakes and holds the position",
        Range{0.01, 10.0});
  visit("fallback_tolerance_m", c.fallback_tolerance_m, "m",
        "the failsafe flies the tracker's fallback stop if that passes the vehicle this near, else "
        "it brakes straight ahead; 0: always straight ahead",
        Range{0.0, 10.0});
  visit("failsafe_tilt_rad", c.failsafe_tilt_rad, "rad", "steepest tilt while the failsafe brakes",
        Range{0.05, 1.2});
  visit("failsafe_hold_s", c.failsafe_hold_s, "s",
        "how long the failsafe holds, still without commands, before it lands", Range{0.0, 3600.0});
  visit("landing", c.landing, "",
        "it lands where the map shows the way straight down free (map), as if it were free "
        "everywhere (anywhere), or never",
        Anything{});
  visit("land_speed_m_s", c.land_speed_m_s, "m/s", "speed of that descent", Range{0.05, 2.0});
  visit("land_height_m", c.land_height_m, "m",
        "map height at which a landing ends: the ground plus the legs", Anything{});
  describe(c.sensor, visit);
  visit("wind_x_m_s", c.wind_x_m_s, "m/s", "constant wind towards map x", AtRunTime{wind});
  visit("wind_y_m_s", c.wind_y_m_s, "m/s", "constant wind towards map y", AtRunTime{wind});
  visit("wind_z_m_s", c.wind_z_m_s, "m/s", "constant wind upwards", AtRunTime{wind});
  visit("gust_deviation_m_s", c.gust_deviation_m_s, "m/s",
        "standard deviation of the gusts on each axis; 0 for none", AtRunTime{Range{0.0, 10.0}});
  visit("gust_time_s", c.gust_time_s, "s", "correlation time of the gusts", Range{0.01, 100.0});
  visit("gust_seed", c.gust_seed, "", "seed of the gusts: the same seed gives the same gusts",
        Range{0.0, 2147483647.0});
}

/// @return invalid_parameter with every fault of the configuration, the vehicle's physics included
Status check(const Config& config);

}  // namespace goshawk::simulator
