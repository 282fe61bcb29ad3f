// Cost of one solve: the thesis' quadratic programme with fixed durations, and time and shape
// together, against the number of pieces. The label says how many iterations it took.
#include <benchmark/benchmark.h>

#include <cmath>

#include "../test/corridor_maker.hpp"
#include "goshawk/trajectory_optimizer/plan.hpp"
#include "goshawk/trajectory_optimizer/spline_solver.hpp"
#include "goshawk/trajectory_optimizer/trajectory_optimizer.hpp"

namespace goshawk::trajectory_optimizer {
namespace {

using test::at_rest;

Corridor corridor_of(int segments, double length_m) {
  Random random(5);
  test::CorridorKind kind;
  kind.segments = segments;
  kind.planes = 16;
  kind.least_length_m = 0.7 * length_m;
  kind.most_length_m = 1.3 * length_m;
  kind.most_turn_rad = 1.2;
  return test::random_corridor(random, kind);
}

// One quintic a segment, limits per axis, durations stretched until feasible; 16 planes.
void fixed_durations(benchmark::State& state) {
  const Corridor corridor = corridor_of(int(state.range(0)), 2.0);
  const FlatState start = at_rest(corridor.waypoints_map.front());
  const FlatState goal = at_rest(corridor.waypoints_map.back());
  const Limits limits{.norm = LimitNorm::per_axis};
  const Request request{corridor, start, goal, limits};
  Plan plan = thesis_plan(request);
  SplineSolver solver;
  SplineProblem problem;
  Units units;
  SplineSolver::Outcome outcome;
  do {
    for (double& duration : plan.durations_s) duration *= 1.1;
    make_problem(request, plan, false, 1.0, HUGE_VAL, problem, units);
    outcome = solver.solve(problem, {});
  } while (outcome.status != SplineSolver::Status::solved);
  for (auto _ : state) benchmark::DoNotOptimize(outcome = solver.solve(problem, {}));
  state.SetLabel(std::to_string(outcome.iterations) + " iterations");
}
BENCHMARK(fixed_durations)->Arg(3)->Arg(6)->Arg(12)->Arg(24)->Unit(benchmark::kMicrosecond);

// optimise() as it is called: checks, solve, certificate. The argument is the pieces, about.
void time_and_shape(benchmark::State& state) {
  const double duration_s = 0.4 * double(state.range(0));
  const int segments = std::max(1, int(duration_s / 1.5));
  const Corridor corridor = corridor_of(segments, 2.0 * duration_s / segments * 0.85);
  auto optimizer = TrajectoryOptimizer::create({}).value();
  const FlatState start = at_rest(corridor.waypoints_map.front());
  const FlatState goal = at_rest(corridor.waypoints_map.back());
  auto solution = optimizer.optimise(corridor, start, goal, {});
  for (auto _ : state) {
    benchmark::DoNotOptimize(solution = optimizer.optimise(corridor, start, goal, {}));
  }
  if (!solution) return state.SkipWithError(solution.error().message.c_str());
  state.counters["pieces"] = solution->pieces;
  state.counters["us_per_piece"] =
      benchmark::Counter(1e-6 * solution->pieces, benchmark::Counter::kIsIterationInvariantRate |
                                                      benchmark::Counter::kInvert);
  state.SetLabel(std::to_string(solution->iterations) + " iterations, " +
                 std::to_string(solution->solves) + " solves");
}
BENCHMARK(time_and_shape)
    ->Arg(10)
    ->Arg(15)
    ->Arg(20)
    ->Arg(30)
    ->Arg(60)
    ->Arg(120)
    ->Arg(200)
    ->Unit(benchmark::kMicrosecond);

}  // namespace
}  // namespace goshawk::trajectory_optimizer

BENCHMARK_MAIN();
