#pragma once

#include <limits>

#include "goshawk/trajectory_optimizer/plan.hpp"
#include "goshawk/trajectory_optimizer/spline_problem.hpp"

namespace goshawk::trajectory_optimizer {

/// The units of a SplineProblem: positions from `origin_map` in `length_m`, times in `time_s`,
/// chosen to make v_max and a mean piece 1.
struct Units {
  Vec3 origin_map = Vec3::Zero();
  double length_m = 1.0;
  double time_s = 1.0;
};

/// The reach that leaves no face out.
inline constexpr double kAllFaces = std::numeric_limits<double>::infinity();

struct ProblemSettings {
  /// Whether the time scale is an unknown; a moving end is then linearised at eta = 1.
  bool scale = false;
  double time_weight = 1.0;
  /// [m] Faces farther than this from a control point of the plan's guess are left out; the answer
  /// must then be checked against all of them.
  double reach_m = kAllFaces;
  /// How far the speed limit of the piece at a moving end is raised, relative: the linearised speed
  /// is above the true one by (eta - 1)^2 / 8, which would pin eta to 1 for a vehicle at its limit.
  double end_slack = 0.0;
};

/// @return false if a control point that the ends alone decide leaves its polytope
bool make_problem(const PlanRequest& request, const Corridor& corridor, const Plan& plan,
                  const ProblemSettings& settings, SplineProblem& problem, Units& units);

/// The knots of a solution in SI units, the ends exactly as asked, durations times kappa.
void take_solution(const PlanRequest& request, const std::vector<Knot>& knots, const Units& units,
                   double kappa, Plan& plan);

}  // namespace goshawk::trajectory_optimizer
