#include "goshawk/trajectory_optimizer/spline_solver.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "goshawk/trajectory_optimizer/active_set_solver.hpp"
#include "ipopt_reference.hpp"
#include "random_instance.hpp"

namespace goshawk::trajectory_optimizer {
namespace {

using test::at_rest;
using test::difference;
using test::Instance;
using test::random_instance;

// Every instance is decided, and as Ipopt decides; so are most by the active set.
TEST(SplineSolver, FixedDurationsGiveIpoptsObjectiveAndSolution) {
  Random random(5);
  SplineSolver solver;
  ActiveSetSolver active_set;
  int compared = 0, infeasible = 0, by_active_set = 0;
  for (int n = 0; n < 800; ++n) {
    SCOPED_TRACE(n);
    const auto instance = random_instance(random, false, random.uniform(1.0, 3.0));
    if (!instance.inside) continue;
    // Flat optima: the solution is as near as the square root of the gap.
    const auto outcome = solver.solve(instance.problem, {.gap = 1e-10});
    const auto other = active_set.solve(instance.problem, {.gap = 1e-10});
    const bool decided = ActiveSetSolver::decided(other);
    if (decided) ++by_active_set;
    EXPECT_TRUE(!decided || other.status == outcome.status);
    const auto polytopes = instance.polytopes_in_units();
    if (outcome.status == SplineSolver::Status::infeasible) {
      ++infeasible;
      const bool confirmed = test::least_violation_with_ipopt(instance.problem, polytopes) > 0.0 ||
                             !test::solve_with_ipopt(instance.problem, polytopes).solved;
      EXPECT_TRUE(confirmed);
      continue;
    }
    ASSERT_EQ(outcome.status, SplineSolver::Status::solved)
        << outcome.iterations << " iterations, gap " << outcome.gap << " of " << outcome.objective;
    const auto truth = test::solve_with_ipopt(instance.problem, polytopes);
    ASSERT_TRUE(truth.solved);
    ++compared;
    EXPECT_NEAR(outcome.objective, truth.objective, 1e-6 * (1.0 + std::abs(truth.objective)));
    EXPECT_LT(difference(solver.knots(), truth.knots), 1e-3);
    EXPECT_LE(outcome.primal_residual, 1e-9);
    EXPECT_LE(outcome.gap, 1e-10 * outcome.objective + 1e-12);
    if (!decided) continue;
    EXPECT_NEAR(other.objective, truth.objective, 1e-6 * (1.0 + std::abs(truth.objective)));
    EXPECT_LT(difference(active_set.knots(), truth.knots), 1e-3);
    EXPECT_LE(other.primal_residual, 1e-9);
    EXPECT_LE(other.dual_residual, 1e-7);
    EXPECT_LE(other.gap, 1e-10 * other.objective + 1e-12);
  }
  EXPECT_GE(compared, 700);
  EXPECT_GE(infeasible, 10);
  EXPECT_GE(by_active_set, 750);
}

TEST(SplineSolver, TimeAndShapeTogetherGiveIpoptsObjectiveAndTimeScale) {
  Random random(6);
  SplineSolver solver;
  for (int n = 0; n < 250; ++n) {
    SCOPED_TRACE(n);
    const auto instance = random_instance(random, true, 1.0);
    const auto outcome = solver.solve(instance.problem, {});
    ASSERT_EQ(outcome.status, SplineSolver::Status::solved);
    const auto truth = test::solve_with_ipopt(instance.problem, instance.polytopes_in_units());
    ASSERT_TRUE(truth.solved);
    EXPECT_NEAR(outcome.objective, truth.objective, 1e-6 * (1.0 + std::abs(truth.objective)));
    EXPECT_NEAR(outcome.eta, truth.eta, 1e-4 * truth.eta);
  }
}

// No answer is left open: what is not solved is proved infeasible, even in the tightest cases.
TEST(SplineSolver, DecidesThousandsOfInstances) {
  SplineSolver solver;
  for (const std::uint64_t seed : {1, 2, 3}) {
    Random random(seed);
    for (int n = 0; n < 3000; ++n) {
      const bool scale = n % 2 == 0;
      const auto instance = random_instance(random, scale, scale ? 1.0 : random.uniform(0.5, 3.0));
      if (!instance.inside) continue;
      const auto outcome = solver.solve(instance.problem, {.gap = 1e-10});
      const bool decided = outcome.status == SplineSolver::Status::solved ||
                           (!scale && outcome.status == SplineSolver::Status::infeasible);
      ASSERT_TRUE(decided) << "seed " << seed << ", instance " << n << ": " << outcome.iterations
                           << " iterations, gap " << outcome.gap << " of " << outcome.objective;
    }
  }
}

// Central differences of the Lagrangian, in every unknown: the Karush-Kuhn-Tucker conditions, and
// the gradients of cost and constraints with them.
TEST(SplineSolver, TheLagrangianIsFlatAtASolution) {
  Random random(8);
  SplineSolver solver;
  for (int n = 0; n < 40; ++n) {
    SCOPED_TRACE(n);
    const bool scale = n % 2 == 0;
    const auto instance = random_instance(random, scale, scale ? 1.0 : 2.5);
    const auto outcome = solver.solve(instance.problem, {.gap = 1e-9});
    if (outcome.status != SplineSolver::Status::solved) continue;
    const std::vector<Knot> solution = solver.knots();
    const double at_solution = solver.lagrangian(solution, outcome.eta);
    EXPECT_NEAR(at_solution, outcome.objective, 1e-6 * (1.0 + outcome.objective));
    constexpr double h = 1e-4;
    const auto slope = [&](const std::vector<Knot>& ahead, const std::vector<Knot>& behind,
                           double d_eta) {
      const double up = solver.lagrangian(ahead, outcome.eta + d_eta);
      return (up - solver.lagrangian(behind, outcome.eta - d_eta)) / (2.0 * h);
    };
    double largest = scale ? std::abs(slope(solution, solution, h)) : 0.0;
    double far = 0.0;
    for (std::size_t k = 1; k + 1 < solution.size(); ++k) {
      for (int i = 0; i < 9; ++i) {
        auto ahead = solution, behind = solution;
        ahead[k](i) += h;
        behind[k](i) -= h;
        largest = std::max(largest, std::abs(slope(ahead, behind, 0.0)));
        // It is convex: nowhere lower than here.
        far = std::max(far, at_solution - solver.lagrangian(ahead, outcome.eta));
      }
    }
    EXPECT_LT(largest, 1e-4 * (1.0 + outcome.objective));
    EXPECT_LT(far, 1e-7 * (1.0 + outcome.objective));
  }
}

// The envelope theorem against a solve with a little more and a little less time for one piece.
TEST(SplineSolver, TimeSlopesAreThoseOfTheLeastCost) {
  Random random(12);
  SplineSolver solver;
  constexpr SplineSolver::Settings kFine{.gap = 1e-11, .dual_feasibility = 1e-8};
  constexpr double h = 1e-4;
  int compared = 0;
  for (int n = 0; n < 60; ++n) {
    SCOPED_TRACE(n);
    auto instance = random_instance(random, true, 1.0);
    if (n % 3 == 0) instance.problem.j_max.assign(instance.problem.durations.size(), 20.0);
    const auto least_cost = [&](std::size_t piece, double factor) {
      SplineProblem problem = instance.problem;
      const double before = problem.durations[piece];
      problem.durations[piece] *= factor;
      for (FacePoint& point : problem.face_points) {
        const bool first = point.knot == int(piece) && point.map[1] > 0.0;
        const bool second = point.knot == int(piece) + 1 && point.map[1] < 0.0;
        if (!first && !second) continue;
        point.map[1] *= problem.durations[piece] / before;
        point.map[2] *= std::pow(problem.durations[piece] / before, 2);
      }
      return solver.solve(problem, kFine);
    };
    const auto outcome = solver.solve(instance.problem, kFine);
    if (outcome.status != SplineSolver::Status::solved) continue;
    std::vector<double> slopes;
    solver.time_slopes(slopes);
    for (std::size_t piece = 0; piece < slopes.size(); ++piece) {
      const auto ahead = least_cost(piece, std::exp(h));
      const auto behind = least_cost(piece, std::exp(-h));
      if (ahead.status != outcome.status || behind.status != outcome.status) continue;
      ++compared;
      EXPECT_NEAR(slopes[piece], (ahead.objective - behind.objective) / (2.0 * h),
                  1e-3 * (1.0 + outcome.objective));
    }
  }
  EXPECT_GE(compared, 100);
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
    i.plan = cut_trapezoid(i.request(), i.corridor, {});
    ASSERT_TRUE(make_problem(i.request(), i.corridor, i.plan, {.scale = true, .time_weight = 100.0},
                             i.problem, i.units));
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
