#pragma once

#include <functional>
#include <memory>
#include <string_view>

#include "goshawk/core/certificate.hpp"
#include "goshawk/core/polytope.hpp"
#include "goshawk/core/result.hpp"
#include "goshawk/core/trajectory.hpp"
#include "goshawk/trajectory_optimizer/config.hpp"

namespace goshawk::trajectory_optimizer {

/// A trajectory that holds its certificate.
struct Solution {
  Trajectory trajectory;
  Certificate certificate;  // of the trajectory against the limits and polytopes asked for
  int iterations = 0;       // of the interior-point method, over all solves
  int solves = 0;
  int pieces = 0;
  double jerk_cost = 0.0;  // [m^2/s^5] integral of the squared jerk
};

struct Workspace;

/// What a flight may ask beyond its ends and limits.
struct Query {
  double duration_s = 0.0;  // [s] arrive after exactly this; 0: as fast as the limits allow
  /// Asked before each iteration; true ends the work with deadline_exceeded. Empty: never.
  std::function<bool()> out_of_time = {};
};

/// Fits a piecewise quintic Bezier trajectory into a corridor. Keeps its working memory between
/// calls; no answer depends on an earlier one, and equal inputs give equal bits.
class TrajectoryOptimizer {
 public:
  /// @return invalid_parameter, naming each value out of range
  static Result<TrajectoryOptimizer> create(const Config& config);
  /// From the next request on by this config; or, where create() would refuse it, as before.
  Status reconfigure(const Config& config);
  TrajectoryOptimizer(TrajectoryOptimizer&&) noexcept;
  TrajectoryOptimizer& operator=(TrajectoryOptimizer&&) noexcept;
  ~TrajectoryOptimizer();

  /// @param corridor frame `map`; piece k of the answer stays in the polytope that it names
  /// @param start, goal positions are the corridor's first and last waypoint (within 1 um);
  ///   velocities and accelerations within the limits; jerk is not used. A start above a limit is
  ///   braked as fast as a trajectory is found for, and the certificate says how far above it is
  ///   and until when (StartAllowance)
  /// @return a certified solution; else invalid_input, invalid_limits, corridor_disjoint,
  ///   start_infeasible (the start state breaks a limit, or leaves the corridor whatever is
  ///   done), trajectory_infeasible (also a duration that is too short), deadline_exceeded or
  ///   solver_failed
  Result<Solution> optimise(const Corridor& corridor, const FlatState& start, const FlatState& goal,
                            const Limits& limits, const Query& query = {});

  /// Which method answers, for reports: "bezier-scale" or "bezier-fixed".
  std::string_view implementation() const;

 private:
  explicit TrajectoryOptimizer(const Config& config);

  Config config_;
  std::unique_ptr<Workspace> workspace_;
};

}  // namespace goshawk::trajectory_optimizer
