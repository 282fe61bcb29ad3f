#pragma once

#include <string>

#include "goshawk/flight_report/flight.hpp"

namespace goshawk::flight_report {

/// Length, time and speeds of the plans, each until the next one took over: a vehicle that plans
/// anew in flight follows most of them for a moment only. Empty without trajectories.
std::string plan_summary(const Flight& flight);

}  // namespace goshawk::flight_report
