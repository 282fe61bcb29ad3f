#pragma once

#include <concepts>
#include <string>
#include <type_traits>

#include "goshawk/core/parameter.hpp"

namespace goshawk::stage {

/// What the component of a simulated plant needs beyond its vehicle.
struct PlantConfig {
  double start_x_m = 3.0;
  double start_y_m = 0.0;
  double start_z_m = 1.0;
  double start_yaw_rad = 0.0;
  double rate_hz = 250.0;
  std::string lock_step_nodes;
  double speed = 1.0;
};

template <typename Self, typename Visitor>
requires std::same_as<std::remove_const_t<Self>, PlantConfig>
void describe(Self& c, Visitor&& visit) {
  visit("start_x_m", c.start_x_m, "m", "map x of the point where the vehicle hovers at first",
        Anything{});
  visit("start_y_m", c.start_y_m, "m", "map y of that point", Anything{});
  visit("start_z_m", c.start_z_m, "m", "map z of that point", Anything{});
  visit("start_yaw_rad", c.start_yaw_rad, "rad", "heading at the start, from map x to y",
        Range{-3.1416, 3.1416});
  visit("rate_hz", c.rate_hz, "Hz", "how often odometry is published", Range{10.0, 1000.0});
  visit("lock_step_nodes", c.lock_step_nodes, "",
        "names with commas of the nodes that run in lock step with this plant, in the order of "
        "their turns; empty: real time",
        Anything{});
  visit("speed", c.speed, "",
        "in lock step: most simulated seconds per second of real time; 0: as fast as the nodes can",
        Range{0.0, 1000.0});
}

/// The whole configuration of a simulated plant: the component's part, then its vehicle's.
template <typename VehicleConfig>
struct SimulatedPlantConfig {
  PlantConfig plant;
  VehicleConfig vehicle;
};

template <typename VehicleConfig>
struct IsSimulatedPlantConfig : std::false_type {};
template <typename VehicleConfig>
struct IsSimulatedPlantConfig<SimulatedPlantConfig<VehicleConfig>> : std::true_type {};

template <typename Self, typename Visitor>
requires IsSimulatedPlantConfig<std::remove_const_t<Self>>::value void describe(Self& c,
                                                                                Visitor&& visit) {
  describe(c.plant, visit);
  describe(c.vehicle, visit);
}

}  // namespace goshawk::stage
