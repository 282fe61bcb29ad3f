#pragma once

#include "flight.hpp"
#include "goshawk/core/result.hpp"
#include "goshawk/trajectory_optimizer/task.hpp"

// How a task is answered. Each strategy returns a certified flight; task.effort records the solves.
namespace goshawk::trajectory_optimizer {

/// By the configured method, without regard to the vehicle or a given arrival.
std::optional<Flight> fastest(const Task& task);

/// As soon as the limits allow: durations and shape together (method scale).
std::optional<Flight> soonest(const Task& task);
/// The same with the pieces of a plan as they are cut.
std::optional<Flight> soonest_with_cut(const Task& task, Plan plan);

/// Least jerk with the durations of a trapezoid over the path, stretched until there is a
/// solution (method fixed). From rest to rest there is one in the end; a moving start may have
/// none.
std::optional<Flight> fixed_durations(const Task& task);

/// Least jerk with the durations of a plan, longer and longer until a flight is certified.
std::optional<Flight> stretched(const Task& task, const Plan& plan);

/// The flight itself if it keeps the vehicle's thrust and tilt, else a slower one that does.
/// @return trajectory_infeasible, deadline_exceeded
Result<Flight> within_vehicle(const Task& task, Flight flight);

/// The smoothest flight of this duration.
/// @param duration_s no shorter than the soonest flight
/// @return trajectory_infeasible (too soon, or nothing found from or to a moving end),
///   deadline_exceeded
Result<Flight> arrive_after(const Task& task, double duration_s, Flight soonest);

/// Why the last solve brought no flight, with a code.
Error no_flight(const Task& task);

}  // namespace goshawk::trajectory_optimizer
