#pragma once

#include <functional>
#include <limits>
#include <vector>

#include "goshawk/core/polytope.hpp"
#include "goshawk/core/trajectory.hpp"
#include "goshawk/trajectory_optimizer/config.hpp"
#include "goshawk/trajectory_optimizer/spline_problem.hpp"

namespace goshawk::trajectory_optimizer {

/// What is asked: a view of the caller's data.
struct Request {
  const Corridor& corridor;
  const FlatState& start;
  const FlatState& goal;
  const Limits& limits;
  double duration_s = 0.0;                             // [s] when to arrive; 0: soon
  const std::function<bool()>* out_of_time = nullptr;  // null: never

  /// From rest to rest, where a longer duration of the same shape is always feasible.
  bool rests() const;
};

/// Pieces with durations and a guess of the knots between them: what a solve begins with.
struct Plan {
  std::vector<double> durations_s;  // m
  std::vector<int> polytopes;       // m: where each piece lives
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
  double a_factor(std::size_t piece) const { return a_factors.empty() ? 1.0 : a_factors[piece]; }
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
Plan cut_trapezoid(const Request& request, const Config& config, const Lead& lead = {});

/// The units of a SplineProblem: positions from `origin_map` in `length_m`, times in `time_s`,
/// so chosen that v_max and a mean piece are 1.
struct Units {
  Vec3 origin_map = Vec3::Zero();
  double length_m = 1.0;
  double time_s = 1.0;
};

/// [m] how far an optimum may be expected to depart from the polyline
double corner_reach_m(const Plan& plan, const Limits& limits);

/// [m/s^3] the jerk that builds up a_max in the time of a full ramp of the trapezoid: the yardstick
/// for smoothness.
double natural_jerk(const Plan& plan, const Limits& limits);

/// The reach that leaves no face out.
inline constexpr double kAllFaces = std::numeric_limits<double>::infinity();

/// @param scale whether the time scale is an unknown; a moving end is then linearised at eta = 1
/// @param reach_m faces farther than this from a control point of the plan's guess are left out;
/// the answer must then be checked against all of them
/// @param end_slack how far the speed limit of the piece at a moving end is raised, relative: the
///   linearised speed is above the true one by (eta - 1)^2 / 8, which would pin eta to 1 where the
///   vehicle flies at its limit
/// @return false where a control point that the ends alone decide leaves its polytope
bool make_problem(const Request& request, const Plan& plan, bool scale, double time_weight,
                  double reach_m, SplineProblem& problem, Units& units, double end_slack = 0.0);

/// The knots of a solution in SI units, the ends exactly as asked, durations times kappa.
void take_solution(const Request& request, const std::vector<Knot>& knots, const Units& units,
                   double kappa, Plan& plan);
Trajectory make_trajectory(const Plan& plan);

}  // namespace goshawk::trajectory_optimizer
