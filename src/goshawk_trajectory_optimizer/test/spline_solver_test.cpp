#include "goshawk/trajectory_optimizer/spline_solver.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "corridor_maker.hpp"
#include "goshawk/trajectory_optimizer/plan.hpp"
#include "ipopt_reference.hpp"

namespace goshawk::trajectory_optimizer {
namespace {

using test::at_rest;

struct Instance {
  Corridor corridor;
  FlatState start, goal;
  Limits limits;
  Plan plan;
  SplineProblem problem;
  Units units;

  Request request() const { return {corridor, start, goal, limits}; }
  std::vector<Polytope> polytopes_in_units() const {
    std::vector<Polytope> all;
    for (const int k : plan.polytopes) {
      Polytope p = corridor.polytopes[std::size_t(k)];
      p.b = (p.b - p.A * units.origin_map) / units.length_m;
      all.push_back(p);
    }
    return all;
  }
};

Instance random_instance(Random& random, bool scale, double stretch) {
  Instance i;
  test::CorridorKind kind;
  kind.segments = 1 + random.below(2);
  kind.planes = 6 + random.below(5);
  kind.least_length_m = 0.3;
  kind.most_length_m = 1.5;
  i.corridor = test::random_corridor(random, kind);
  i.start = at_rest(i.corridor.waypoints_map.front());
  i.goal = at_rest(i.corridor.waypoints_map.back());
  i.limits = {.v_max_m_s = random.uniform(0.5, 4.0),
              .a_max_m_s2 = random.uniform(0.5, 4.0),
              .norm = random.chance(0.5) ? LimitNorm::euclidean : LimitNorm::per_axis};
  Config config;
  config.min_pieces = 2;
  config.piece_duration_s = random.uniform(2.0, 10.0);
  i.plan = cut_trapezoid(i.request(), config);
  for (double& duration : i.plan.durations_s) duration *= stretch * random.uniform(0.8, 1.25);
  make_problem(i.request(), i.plan, scale, std::pow(10.0, random.uniform(-2.0, 2.0)), HUGE_VAL,
               i.problem, i.units);
  return i;
}

double difference(const std::vector<Joint>& a, const std::vector<Joint>& b) {
  double largest = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    largest = std::max(largest, (a[k].col(0) - b[k].col(0)).cwiseAbs().maxCoeff());
  }
  return largest;
}

TEST(SplineSolver, FixedDurationsGiveIpoptsObjectiveAndSolution) {
  Random random(5);
  SplineSolver solver;
  int compared = 0;
  for (int n = 0; n < 160; ++n) {
    SCOPED_TRACE(n);
    const auto instance = random_instance(random, false, random.uniform(1.0, 3.0));
    // Flat optima: the solution is as near as the square root of the gap.
    const auto outcome = solver.solve(instance.problem, {.gap = 1e-10});
    const auto truth = test::solve_with_ipopt(instance.problem, instance.polytopes_in_units());
    if (outcome.status == SplineSolver::Status::infeasible) {
      EXPECT_FALSE(truth.solved);
      continue;
    }
    ASSERT_EQ(outcome.status, SplineSolver::Status::solved)
        << outcome.iterations << " iterations, gap " << outcome.gap << " of " << outcome.objective
        << ", residuals " << outcome.primal_residual << " " << outcome.dual_residual << ", Ipopt "
        << (truth.solved ? "solved" : "did not solve") << " it, " << truth.objective;
    if (!truth.solved) continue;
    ++compared;
    EXPECT_NEAR(outcome.objective, truth.objective, 1e-6 * (1.0 + std::abs(truth.objective)));
    EXPECT_LT(difference(solver.joints(), truth.joints), 1e-3);
    EXPECT_LE(outcome.primal_residual, 1e-9);
    EXPECT_LE(outcome.gap, 1e-10 * outcome.objective + 1e-12);
  }
  EXPECT_GE(compared, 100);
}

TEST(SplineSolver, TimeAndShapeTogetherGiveIpoptsObjectiveAndTimeScale) {
  Random random(6);
  SplineSolver solver;
  int compared = 0;
  for (int n = 0; n < 50; ++n) {
    SCOPED_TRACE(n);
    const auto instance = random_instance(random, true, 1.0);
    const auto outcome = solver.solve(instance.problem, {});
    ASSERT_EQ(outcome.status, SplineSolver::Status::solved);
    const auto truth = test::solve_with_ipopt(instance.problem, instance.polytopes_in_units());
    if (!truth.solved) continue;
    ++compared;
    EXPECT_NEAR(outcome.objective, truth.objective, 1e-6 * (1.0 + std::abs(truth.objective)));
    EXPECT_NEAR(outcome.eta, truth.eta, 1e-4 * truth.eta);
  }
  EXPECT_GE(compared, 40);
}

TEST(SplineSolver, ProvesThatTooShortDurationsAreInfeasible) {
  Random random(7);
  SplineSolver solver;
  for (int n = 0; n < 100; ++n) {
    SCOPED_TRACE(n);
    const auto instance = random_instance(random, false, 0.3);
    const auto outcome = solver.solve(instance.problem, {});
    EXPECT_EQ(outcome.status, SplineSolver::Status::infeasible);
    EXPECT_LT(outcome.iterations, 60);
  }
}

TEST(SplineSolver, IterationsDoNotGrowWithThePieces) {
  SplineSolver solver;
  for (const int segments : {3, 12, 50}) {
    Random random(9);
    Instance i;
    test::CorridorKind kind;
    kind.segments = segments;
    i.corridor = test::random_corridor(random, kind);
    i.start = at_rest(i.corridor.waypoints_map.front());
    i.goal = at_rest(i.corridor.waypoints_map.back());
    i.plan = cut_trapezoid(i.request(), {});
    ASSERT_TRUE(make_problem(i.request(), i.plan, true, 100.0, HUGE_VAL, i.problem, i.units));
    const auto outcome = solver.solve(i.problem, {});
    EXPECT_EQ(outcome.status, SplineSolver::Status::solved);
    EXPECT_LT(outcome.iterations, 40) << i.problem.pieces() << " pieces";
  }
}

TEST(SplineSolver, StopsAtTheIterationLimit) {
  Random random(10);
  SplineSolver solver;
  const auto instance = random_instance(random, true, 1.0);
  const auto outcome = solver.solve(instance.problem, {.max_iterations = 2});
  EXPECT_EQ(outcome.status, SplineSolver::Status::iteration_limit);
  EXPECT_EQ(outcome.iterations, 2);
}

}  // namespace
}  // namespace goshawk::trajectory_optimizer
