#pragma once

#include "common/report.hpp"
#include "planners.hpp"

namespace goshawk::bench {

/// The thesis' world, 6 x 8 x 4 m with (3, 0, 1) to (3, 8, 2), or a forest of 30 x 30 x 5 m, grown
/// by 0.2 m; 2 m/s and 2 m/s^2, Euclidean.
Task box_task(double density, int seed);
Task forest_task(double density, int seed);

/// Every planner over worlds of every density: the rows, and the thesis' Table 3 beside ours.
void measure_flights(Report& report);

/// How the time of a solve grows with segments (fixed durations) and pieces (time and shape).
void measure_cost(Report& report);

/// One flight at density 0.4 over time, with its limits.
void record_curve(Report& report);

}  // namespace goshawk::bench
