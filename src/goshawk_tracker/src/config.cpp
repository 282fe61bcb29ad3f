#include "goshawk/tracker/config.hpp"

#include <cstdio>

#include "goshawk/core/vehicle.hpp"

namespace goshawk::tracker {

Status check(const Config& config) {
  ParameterFaults faults;
  describe(config, faults);
  const double weight_n = config.mass_kg * kGravity_m_s2;
  char text[120];
  if (config.max_thrust_n <= weight_n) {
    std::snprintf(text, sizeof text, "max_thrust_n (%g) does not lift the weight of %g N",
                  config.max_thrust_n, weight_n);
    faults.add(text);
  }
  if (config.min_thrust_n >= weight_n) {
    std::snprintf(text, sizeof text, "min_thrust_n (%g) is not below the weight of %g N",
                  config.min_thrust_n, weight_n);
    faults.add(text);
  }
  if (config.stop_acceleration_m_s2 < config.brake_acceleration_m_s2) {
    std::snprintf(text, sizeof text,
                  "stop_acceleration_m_s2 (%g) is below brake_acceleration_m_s2 (%g)",
                  config.stop_acceleration_m_s2, config.brake_acceleration_m_s2);
    faults.add(text);
  }
  return faults.status();
}

}  // namespace goshawk::tracker
