#pragma once

#include <optional>

#include "goshawk/core/certificate.hpp"
#include "goshawk/trajectory_optimizer/plan.hpp"

namespace goshawk::trajectory_optimizer {

/// The squared duration beside the mean squared jerk, each in units of the trapezoid's: enough for
/// nearly the least time, not so much that the jerk is left to chance.
inline constexpr double kTimeWeight = 300.0;
inline constexpr double kCoarseTimeWeight = 100.0;  // of the solves before the last

/// A plan whose trajectory holds its certificate.
struct Flight {
  Plan plan;
  Trajectory trajectory;
  Certificate certificate;
  double jerk_cost = 0.0;  // [m^2/s^5]
  double cost = 0.0;       // kTimeWeight * squared duration + mean squared jerk, in natural units
};

struct Judged {
  std::optional<Flight> flight;  // nothing: not certified
  bool outside = false;          // a control point leaves its polytope
};

/// Writes a plan down as a trajectory and certifies it for the request.
Judged judge(const Request& request, const Plan& plan);

}  // namespace goshawk::trajectory_optimizer
