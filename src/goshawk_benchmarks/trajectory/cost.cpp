#include <cmath>

#include "common/measure.hpp"
#include "goshawk/baselines/thesis_form.hpp"
#include "goshawk/core/random.hpp"
#include "goshawk/trajectory_optimizer/active_set_solver.hpp"
#include "goshawk/trajectory_optimizer/plan_problem.hpp"
#include "goshawk/trajectory_optimizer/spline_solver.hpp"
#include "goshawk/trajectory_optimizer/trajectory_optimizer.hpp"
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

// From rest to rest.
PlanRequest ask(const Corridor& corridor, LimitNorm norm) {
  return {.start = {.position = corridor.waypoints_map.front()},
          .goal = {.position = corridor.waypoints_map.back()},
          .limits = {.norm = norm}};
}

// Both solvers on one problem, in turns.
struct Comparison {
  SplineSolver::Outcome interior, active;
  int binding = 0;
  double interior_us = 0.0, active_us = 0.0;
};

Comparison compare_solvers(const SplineProblem& problem, const SplineSolver::Settings& settings,
                           int rounds) {
  Comparison c;
  SplineSolver interior;
  ActiveSetSolver active;
  const auto timing =
      compare("solvers",
              {{"interior", [&] { c.interior = interior.solve(problem, settings); }},
               {"active", [&] { c.active = active.solve(problem, settings); }}},
              rounds, Clock::processor);
  c.binding = active.binding();
  c.interior_us = timing[0].median_us();
  c.active_us = timing[1].median_us();
  return c;
}

// The thesis' quadratic programme, durations stretched until it is feasible.
SplineProblem fixed_problem(int segments) {
  const Corridor corridor = wandering_corridor(segments);
  const PlanRequest request = ask(corridor, LimitNorm::per_axis);
  Plan plan = baselines::thesis_plan(request, corridor);
  SplineSolver solver;
  SplineProblem problem;
  Units units;
  do {
    for (double& duration : plan.durations_s) duration *= 1.1;
    make_problem(request, corridor, plan, {.scale = false}, problem, units);
  } while (solver.solve(problem, {}).status != SplineSolver::Status::solved);
  return problem;
}

Json fixed_row(int segments, int rounds) {
  constexpr int kMostCompared = 100;  // longer ones the active set is not asked
  const SplineProblem problem = fixed_problem(segments);
  Json row = {{"problem", "fixed durations, one quintic a segment, 16 planes, per axis"},
              {"segments", segments},
              {"pieces", segments}};
  if (segments <= kMostCompared) {
    const Comparison c = compare_solvers(problem, {}, rounds);
    row.update({{"iterations", c.interior.iterations},
                {"time_us", c.interior_us},
                {"active_set_solved", c.active.status == SplineSolver::Status::solved},
                {"active_set_steps", c.active.iterations},
                {"binding", c.binding},
                {"active_set_us", c.active_us}});
  } else {
    SplineSolver solver;
    SplineSolver::Outcome outcome;
    const auto timing = compare("fixed", {{"fixed", [&] { outcome = solver.solve(problem, {}); }}},
                                rounds, Clock::processor);
    row.update({{"iterations", outcome.iterations}, {"time_us", timing[0].median_us()}});
  }
  const double us = row["time_us"];
  row["us_a_piece"] = us / segments;
  row["us_a_piece_and_iteration"] = us / segments / row["iterations"].get<int>();
  return row;
}

// The soonest flight through a corridor, its pieces made longer by one factor: the nearer to the
// soonest, the more limits bind.
Json binding_row(double factor, LimitNorm norm, int rounds) {
  constexpr int kSegments = 6;
  const Corridor corridor = wandering_corridor(kSegments);
  const PlanRequest request = ask(corridor, norm);
  auto optimizer = TrajectoryOptimizer::create({}).value();
  const auto soonest = optimizer.optimise(request, corridor);
  if (!soonest) throw std::runtime_error(soonest.error().message);
  Plan plan;
  plan.knots.push_back(request.start);
  for (const BezierPiece& piece : soonest->trajectory().pieces) {
    plan.durations_s.push_back(factor * piece.duration_s);
    plan.polytopes.push_back(piece.polytope);
    FlatState end;
    end.position = piece.control_points.col(5);
    plan.knots.push_back(end);
  }
  plan.reference_s = plan.duration_s();
  SplineProblem problem;
  Units units;
  make_problem(request, corridor, plan, {.scale = false}, problem, units);
  const Comparison c = compare_solvers(problem, {.gap = 1e-7, .dual_feasibility = 1e-6}, rounds);
  return {{"limits", norm == LimitNorm::euclidean ? "Euclidean" : "per axis"},
          {"of_the_soonest", factor},
          {"pieces", problem.pieces()},
          {"interior_solved", c.interior.status == SplineSolver::Status::solved},
          {"active_set_solved", c.active.status == SplineSolver::Status::solved},
          {"binding", c.binding},
          {"active_set_steps", c.active.iterations},
          {"interior_us", c.interior_us},
          {"active_set_us", c.active_us}};
}

// optimise() whole: checks, passes, certificate.
Json scale_row(int segments, int rounds) {
  const Corridor corridor = wandering_corridor(segments);
  const PlanRequest request = ask(corridor, LimitNorm::euclidean);
  auto optimizer = TrajectoryOptimizer::create({}).value();
  auto solution = optimizer.optimise(request, corridor);
  if (!solution) throw std::runtime_error(solution.error().message);
  const auto timing =
      compare("scale", {{"scale", [&] { solution = optimizer.optimise(request, corridor); }}},
              rounds, Clock::processor);
  const auto pieces = solution->trajectory().pieces.size();
  return {{"problem", "time and shape, whole optimisation, Euclidean"},
          {"segments", segments},
          {"pieces", pieces},
          {"iterations", solution->iterations},
          {"time_us", timing[0].median_us()},
          {"us_a_piece", timing[0].median_us() / pieces},
          {"us_a_piece_and_iteration", timing[0].median_us() / pieces / solution->iterations}};
}

// Both solvers' times over the pieces, as rows of one plot.
void draw_solvers(Report& report, const Json& cost) {
  Json points = Json::array();
  for (const Json& row : cost) {
    if (!row.contains("active_set_us")) continue;
    points.push_back(
        {{"solver", "interior point"}, {"pieces", row["pieces"]}, {"us", row["time_us"]}});
    if (!row["active_set_solved"]) continue;
    points.push_back(
        {{"solver", "active set"}, {"pieces", row["pieces"]}, {"us", row["active_set_us"]}});
  }
  report.note("solvers", points);
  report.draw({.file = "solvers",
               .title = "Fixed durations, one quintic a segment",
               .x = "pieces",
               .y = "us",
               .x_label = "pieces",
               .y_label = "median time of the processor [us]",
               .series = "solver",
               .log_x = true,
               .log_y = true,
               .from = "solvers"});
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
  draw_solvers(report, rows);
  Json binding = Json::array();
  for (const LimitNorm norm : {LimitNorm::per_axis, LimitNorm::euclidean}) {
    for (const double factor : {1.001, 1.02, 1.05, 1.1, 1.2, 1.5, 2.0}) {
      binding.push_back(binding_row(factor, norm, rounds));
    }
  }
  report.note("binding", binding);
  Plot plot{.x = "pieces", .x_label = "pieces", .series = "problem", .log_x = true, .from = "cost"};
  const std::string label = "median time of the processor [us]";
  report.draw(plot.of("cost_a_piece", "Cost of a piece in an iteration", "us_a_piece_and_iteration",
                      label));
  plot.log_y = true;
  report.draw(plot.of("cost", "Cost of a solve", "time_us", label));
}

}  // namespace goshawk::bench
