#pragma once

#include <optional>

#include "goshawk/core/certified_trajectory.hpp"
#include "goshawk/trajectory_optimizer/task.hpp"

namespace goshawk::trajectory_optimizer {

/// A plan whose trajectory is certified for the request.
struct Flight {
  Plan plan;
  CertifiedTrajectory certified;
  double jerk_cost = 0.0;  // [m^2/s^5]
  double cost = 0.0;       // kTimeWeight * squared duration + mean squared jerk, in natural units
};

struct Judged {
  std::optional<Flight> flight;  // nothing: not certified
  bool outside = false;          // a control point leaves its polytope
};

/// Writes a plan down as a trajectory and certifies it for the task's request.
Judged judge(const Task& task, const Plan& plan);

}  // namespace goshawk::trajectory_optimizer
