#include "goshawk/simulator/config.hpp"

namespace goshawk::simulator {

Status check(const Config& config) {
  ParameterFaults faults;
  describe(config, faults);
  if (const auto vehicle = config.vehicle.check(); !vehicle) faults.add(vehicle.error().message);
  return faults.status();
}

}  // namespace goshawk::simulator
