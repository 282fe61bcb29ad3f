#pragma once

#include <span>

#include "goshawk/trajectory_optimizer/plan.hpp"

namespace goshawk::trajectory_optimizer {

/// Moves the changes from polytope to polytope to save time, and cuts the flight into pieces again,
/// equally long within a polytope. It stays the same curve, which is the guess for the next solve.
///
/// The multipliers of the solve tell what a moment more in a polytope is worth, and the curve how
/// far its change can be moved: to where it enters the next polytope or leaves this one, and a
/// little beyond, for the next solve can bend it.
///
/// @param plan as solved
/// @param slopes of the duration's square by the logarithm of each piece's duration, over that
///   square: SplineSolver::time_slopes() over eta
/// @param beyond_m how far outside a polytope the curve may be where it is cut
/// @return to first order, by what part of its duration the flight gets shorter
double move_switches(const PlanRequest& request, const Corridor& corridor, const Config& config,
                     std::span<const double> slopes, double beyond_m, Plan& plan);

}  // namespace goshawk::trajectory_optimizer
