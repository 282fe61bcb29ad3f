#pragma once

#include <functional>
#include <optional>

#include "goshawk/core/trajectory.hpp"

namespace goshawk::tracker {

/// How the vehicle comes to rest from where it is.
struct StopLimits {
  double gentle_m_s2 = 2.0;   // deceleration that is tried first, > 0
  double hardest_m_s2 = 5.0;  // and the hardest, >= gentle_m_s2
};

/// The path that the vehicle was on: it is known to be free, so a stop that ends on it is tried
/// before one that leaves it.
struct LeftPath {
  const Trajectory* trajectory = nullptr;
  double from_s = 0.0;  // the part of it where the vehicle can be
  double to_s = 0.0;
};

/// Where a curve enters space that is not known to be free: [s] after its start; nothing: nowhere.
using FirstContact = std::function<std::optional<double>(const BezierPiece&)>;

struct Stop {
  BezierPiece curve;
  std::optional<double> enters_s;  // as FirstContact; nothing: it is free
};

/// One quintic from the vehicle's state to rest. Of growing decelerations, and for each of a stop
/// that returns to the path and of one straight ahead, the first that is free; else the one that
/// stays free for the longest time, of equal ones the hardest, back to the path if that is near.
/// @param vehicle position, velocity and acceleration now (jerk is not used), all finite; what of
///        the acceleration makes it faster is left out
/// @param path nothing: straight ahead
Stop plan_stop(const FlatState& vehicle, const std::optional<LeftPath>& path,
               const StopLimits& limits, const FirstContact& first_contact);

}  // namespace goshawk::tracker
