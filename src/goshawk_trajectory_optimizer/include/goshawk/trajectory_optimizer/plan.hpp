#pragma once

#include <vector>

#include "goshawk/core/plan_request.hpp"
#include "goshawk/core/polytope.hpp"
#include "goshawk/core/trajectory.hpp"
#include "goshawk/trajectory_optimizer/config.hpp"

namespace goshawk::trajectory_optimizer {

/// From rest to rest: a longer duration of the same shape is always feasible.
bool from_rest_to_rest(const PlanRequest& request);

/// Pieces with durations and a guess of the knots between them: what a solve begins with.
struct Plan {
  std::vector<double> durations_s;  // m
  std::vector<int> polytopes;       // m: the polytope that each piece stays in
  std::vector<FlatState> knots;     // m + 1
  std::vector<double> a_factors;    // m, or none: of the acceleration limit, at most 1
  double at_moving_end = 1.0;       // the first piece there, in longest ones
  double reference_s = 0.0;         // [s] duration of the trapezoid, above zero
  double braking_s = 0.0;           // [s] how long a start above a limit may stay above it
  bool stays = false;               // no way to go: any duration will do

  double duration_s() const;
  BezierPiece piece(std::size_t k) const {
    return BezierPiece::between(knots[k], knots[k + 1], durations_s[k]);
  }
  /// Multiplies the durations, and leaves the knots as they are.
  void stretch(double factor) {
    for (double& duration : durations_s) duration *= factor;
  }
  double a_factor(std::size_t k) const { return a_factors.empty() ? 1.0 : a_factors[k]; }
};

/// How a moving start (or goal) is met. The hull of a piece holds what its end state alone decides,
/// so a vehicle that turns at its limits leaves room for a short piece only; and one that does not
/// fly along its path leaves the first polytope sooner or later than the trapezoid thinks.
struct Lead {
  double first_piece = 1.0;    // in longest pieces; each next one is at most twice as long
  double first_segment = 1.0;  // duration of the first segment in trapezoid durations
  double braking = 1.0;        // of the time that a start above a limit is allowed
};

/// Cuts the trapezoid over the corridor's waypoints into pieces of at most config.piece_duration_s.
/// @param lead plays no part from rest to rest
Plan cut_trapezoid(const PlanRequest& request, const Corridor& corridor, const Config& config,
                   const Lead& lead = {});

/// [m] how far an optimum may be expected to depart from the polyline
double corner_reach_m(const Plan& plan, const Limits& limits);

/// [m/s^3] the jerk that builds up a_max in the time of a full ramp of the trapezoid: the unit of
/// smoothness
double natural_jerk(const Plan& plan, const Limits& limits);

Trajectory make_trajectory(const Plan& plan);

}  // namespace goshawk::trajectory_optimizer
