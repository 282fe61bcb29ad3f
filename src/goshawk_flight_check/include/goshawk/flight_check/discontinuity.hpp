#pragma once

#include <optional>
#include <string>

#include "goshawk/flight_check/flight_check.hpp"

namespace goshawk::flight_check {

/// A sample of odometry as it comes from a vehicle.
struct LiveSample {
  Sample sample;
  double speed_m_s = 0.0;
};

/// [m] beyond what the speeds allow, that noise may move a position by from one sample to the next
inline constexpr double kNoise_m = 0.1;

/// Whether a vehicle can have flown from one sample to the next. A plant that was restarted, a
/// position that was reset, a clock that began anew and a gap in the odometry are events, and what
/// lies between the two samples is not a path that was flown.
/// @return a sentence that says what happened, or nothing if it can have been flown
std::optional<std::string> discontinuity(const LiveSample& from, const LiveSample& to);

}  // namespace goshawk::flight_check
