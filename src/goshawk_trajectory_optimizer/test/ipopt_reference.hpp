#pragma once

// The same convex problem for Ipopt, a general solver: dense, built from Bezier control points
// (goshawk_core) instead of the maps and cones of the solver under test.
#include <vector>

#include "goshawk/core/polytope.hpp"
#include "goshawk/trajectory_optimizer/spline_problem.hpp"

namespace goshawk::trajectory_optimizer::test {

struct ReferenceAnswer {
  bool solved = false;
  double objective = 0.0;
  double eta = 1.0;
  std::vector<Knot> knots;
};

/// @param polytopes in the problem's units, one for each piece. Ends at rest if it scales.
ReferenceAnswer solve_with_ipopt(const SplineProblem& problem,
                                 const std::vector<Polytope>& polytopes);

/// The least t for which every constraint holds when its bound is raised by t; above zero, no
/// trajectory exists. Never below -1.
double least_violation_with_ipopt(const SplineProblem& problem,
                                  const std::vector<Polytope>& polytopes);

}  // namespace goshawk::trajectory_optimizer::test
