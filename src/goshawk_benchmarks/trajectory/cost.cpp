#include <cmath>

#include "common/measure.hpp"
#include "goshawk/core/random.hpp"
#include "goshawk/trajectory_optimizer/plan.hpp"
#include "goshawk/trajectory_optimizer/spline_solver.hpp"
#include "parts.hpp"

namespace goshawk::bench {
namespace {

using namespace goshawk::trajectory_optimizer;
using Json = nlohmann::ordered_json;

constexpr int kPlanes = 16;

Vec3 random_direction(Random& random) {
  for (;;) {
    const Vec3 v(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
    if (v.norm() > 0.1 && v.norm() < 1.0) return v.normalized();
  }
}

// A chain of segments of about 2 m that wanders, 16 planes around each.
Corridor wandering_corridor(int segments) {
  Random random(5);
  Corridor corridor;
  corridor.waypoints_map = {Vec3::Zero()};
  for (int k = 0; k < segments; ++k) {
    Vec3 step = random.uniform(1.4, 2.6) * random_direction(random);
    step.x() = std::abs(step.x());
    const Vec3 a = corridor.waypoints_map.back();
    const Vec3 b = a + step;
    const auto clearance = [&] { return random.uniform(0.1, 1.0); };
    Polytope polytope = Polytope::box(a.cwiseMin(b) - Vec3(clearance(), clearance(), clearance()),
                                      a.cwiseMax(b) + Vec3(clearance(), clearance(), clearance()));
    while (polytope.faces() < kPlanes) {
      const Vec3 n = random_direction(random);
      polytope.add(n, std::max(n.dot(a), n.dot(b)) + clearance());
    }
    corridor.polytopes.push_back(polytope);
    corridor.waypoints_map.push_back(b);
  }
  for (int k = 0; k + 1 < segments; ++k) {
    corridor.overlaps.push_back(
        chebyshev_ball(corridor.polytopes[std::size_t(k)], corridor.polytopes[std::size_t(k) + 1]));
  }
  return corridor;
}

// The thesis' quadratic programme, durations stretched until it is feasible.
Json fixed_row(int segments, int rounds) {
  const Corridor corridor = wandering_corridor(segments);
  FlatState start, goal;
  start.position = corridor.waypoints_map.front();
  goal.position = corridor.waypoints_map.back();
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
  const auto timing = compare("fixed", {{"fixed", [&] { outcome = solver.solve(problem, {}); }}},
                              rounds, Clock::processor);
  return {{"problem", "fixed durations, one quintic a segment, 16 planes, per axis"},
          {"segments", segments},
          {"pieces", segments},
          {"iterations", outcome.iterations},
          {"time_us", timing[0].median_us()},
          {"us_a_piece", timing[0].median_us() / segments},
          {"us_a_piece_and_iteration", timing[0].median_us() / segments / outcome.iterations}};
}

// optimise() whole: checks, passes, certificate.
Json scale_row(int segments, int rounds) {
  const Corridor corridor = wandering_corridor(segments);
  FlatState start, goal;
  start.position = corridor.waypoints_map.front();
  goal.position = corridor.waypoints_map.back();
  auto optimizer = TrajectoryOptimizer::create({}).value();
  auto solution = optimizer.optimise(corridor, start, goal, {});
  if (!solution) throw std::runtime_error(solution.error().message);
  const auto timing = compare(
      "scale", {{"scale", [&] { solution = optimizer.optimise(corridor, start, goal, {}); }}},
      rounds, Clock::processor);
  return {{"problem", "time and shape, whole optimisation, Euclidean"},
          {"segments", segments},
          {"pieces", solution->pieces},
          {"iterations", solution->iterations},
          {"time_us", timing[0].median_us()},
          {"us_a_piece", timing[0].median_us() / solution->pieces},
          {"us_a_piece_and_iteration",
           timing[0].median_us() / solution->pieces / solution->iterations}};
}

}  // namespace

void measure_cost(Report& report) {
  report.progress("cost of a solve");
  const int rounds = report.options().quick ? 20 : 200;
  Json rows = Json::array();
  for (const int segments : {3, 6, 12, 24, 50, 100, 200}) {
    rows.push_back(fixed_row(segments, rounds));
  }
  for (const int segments : {2, 4, 8, 16, 32, 64}) {
    rows.push_back(scale_row(segments, std::max(5, rounds / 4)));
  }
  report.note("cost", rows);
  Plot plot{.x = "pieces", .x_label = "pieces", .series = "problem", .log_x = true, .from = "cost"};
  const std::string label = "median time of the processor [us]";
  report.draw(plot.of("cost_a_piece", "Cost of a piece in an iteration", "us_a_piece_and_iteration",
                      label));
  plot.log_y = true;
  report.draw(plot.of("cost", "Cost of a solve", "time_us", label));
}

}  // namespace goshawk::bench
