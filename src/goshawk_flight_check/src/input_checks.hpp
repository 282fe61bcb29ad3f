#pragma once

#include <span>

#include "goshawk/flight_check/flight_check.hpp"

namespace goshawk::flight_check {

/// @return invalid_input as FlightCheck::judge()
Status check_track(std::span<const Sample> track);

/// @return invalid_parameter for a tolerance outside of 1e-5 to 1 m
Status check_options(const Options& options);

}  // namespace goshawk::flight_check
