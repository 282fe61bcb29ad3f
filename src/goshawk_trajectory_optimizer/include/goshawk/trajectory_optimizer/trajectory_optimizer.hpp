#pragma once

#include <functional>
#include <memory>
#include <string_view>

#include "goshawk/core/certified_trajectory.hpp"
#include "goshawk/core/plan_request.hpp"
#include "goshawk/core/yaw_curve.hpp"
#include "goshawk/trajectory_optimizer/config.hpp"

namespace goshawk::trajectory_optimizer {

struct Solution {
  CertifiedTrajectory certified;  // for the request's ends and limits and the corridor's polytopes
  std::optional<YawCurve> yaw;    // nothing: the optimizer does not say (Config::yaw)
  double jerk_cost = 0.0;         // [m^2/s^5] integral of the squared jerk
  int iterations = 0;             // of the solvers, over all solves
  int solves = 0;

  const Trajectory& trajectory() const { return certified.trajectory(); }
};

struct Workspace;

/// Fits a piecewise quintic Bezier trajectory into a corridor. Keeps its working memory between
/// calls; no answer depends on an earlier one, and equal inputs give equal bits.
class TrajectoryOptimizer {
 public:
  /// @return invalid_parameter, naming each value out of range
  static Result<TrajectoryOptimizer> create(const Config& config);
  /// From the next request on by this config; if create() would refuse it, as before.
  Status reconfigure(const Config& config);
  TrajectoryOptimizer(TrajectoryOptimizer&&) noexcept;
  TrajectoryOptimizer& operator=(TrajectoryOptimizer&&) noexcept;
  ~TrajectoryOptimizer();

  /// @param request its start and goal are the corridor's first and last waypoint (within 1 um),
  ///   its goal's velocity and acceleration within the limits. A start above a limit is braked as
  ///   fast as a trajectory is found for, and the certificate says how far above it is and until
  ///   when (StartAllowance). Of the other members only duration, yaw and yaw rate are used
  /// @param corridor piece k of the answer stays in the polytope that it names
  /// @param out_of_time asked before each iteration; true ends the work. Empty: never
  /// @return invalid_input, invalid_limits, corridor_disjoint, start_infeasible (the start state
  ///   breaks a limit, or leaves the corridor whatever is done), trajectory_infeasible (also a
  ///   duration that is too short), deadline_exceeded or solver_failed
  Result<Solution> optimise(const PlanRequest& request, const Corridor& corridor,
                            const std::function<bool()>& out_of_time = {});

  /// Which method answers, for reports: "bezier-scale" or "bezier-fixed".
  std::string_view implementation() const;

 private:
  explicit TrajectoryOptimizer(const Config& config);

  Config config_;
  std::unique_ptr<Workspace> workspace_;
};

}  // namespace goshawk::trajectory_optimizer
