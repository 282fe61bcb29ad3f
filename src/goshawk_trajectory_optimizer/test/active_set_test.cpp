#include "goshawk/trajectory_optimizer/active_set_solver.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "goshawk/trajectory_optimizer/trajectory_optimizer.hpp"
#include "random_instance.hpp"

namespace goshawk::trajectory_optimizer {
namespace {

using test::difference;
using test::random_instance;
using Status = ActiveSetSolver::Status;

// Two pieces from rest to rest along x, from (0, 0, 0) to (2, 0, 0), with wide limits: without a
// face the knot between them is (1, 0, 0).
SplineProblem two_pieces() {
  SplineProblem problem;
  problem.scale = false;
  problem.durations = {1.0, 1.0};
  problem.v_max = {100.0, 100.0};
  problem.a_max = {100.0, 100.0};
  problem.knots.assign(3, Knot::Zero());
  problem.knots[2].col(0) = Vec3(2, 0, 0);
  return problem;
}

// A face for the position of the knot in the middle.
void add_face(SplineProblem& problem, const Vec3& normal, double offset) {
  problem.faces.push_back({normal, offset});
  const int end = int(problem.faces.size());
  if (problem.face_points.empty()) {
    problem.face_points.push_back({1, Vec3(1, 0, 0), 0, end});
  }
  problem.face_points[0].end = end;
}

// The largest amount by which control points leave their faces and their limits.
double violation(const SplineProblem& problem, const std::vector<Knot>& knots) {
  double worst = 0.0;
  for (const FacePoint& point : problem.face_points) {
    const Vec3 y = knots[std::size_t(point.knot)] * point.map;
    for (int i = point.begin; i < point.end; ++i) {
      const HalfSpace& face = problem.faces[std::size_t(i)];
      worst = std::max(worst, face.normal.dot(y) - face.offset_m);
    }
  }
  for (std::size_t k = 0; k < problem.durations.size(); ++k) {
    for (int j = 0; j < 5 && problem.norm == LimitNorm::euclidean; ++j) {
      const double T = problem.durations[k];
      const Vec3 v = velocity_point(j, T)(knots[k], knots[k + 1]);
      worst = std::max(worst, v.norm() - problem.v_max[k]);
      if (j == 4) continue;
      const Vec3 a = acceleration_point(j, T)(knots[k], knots[k + 1]);
      worst = std::max(worst, a.norm() - problem.a_max[k]);
    }
  }
  return worst;
}

// Small ones, and longer ones; moving ends, limits of each kind, durations too short among them.
TEST(ActiveSetSolver, DecidesAsTheInteriorPointDoes) {
  Random random(11);
  SplineSolver interior;
  ActiveSetSolver solver;
  int solved = 0, infeasible = 0, left_open = 0;
  for (int n = 0; n < 2500; ++n) {
    SCOPED_TRACE(n);
    auto instance = random_instance(random, false, random.uniform(0.8, 2.5));
    if (!instance.inside) continue;
    if (random.chance(0.2)) {
      instance.problem.j_max.assign(instance.problem.durations.size(), random.uniform(2.0, 40.0));
    }
    const auto outcome = solver.solve(instance.problem, {.gap = 1e-9});
    if (!ActiveSetSolver::decided(outcome)) {
      ++left_open;
      continue;
    }
    const auto truth = interior.solve(instance.problem, {.gap = 1e-10});
    ASSERT_EQ(outcome.status, truth.status);
    ++(outcome.status == Status::solved ? solved : infeasible);
    if (outcome.status != Status::solved) continue;
    EXPECT_NEAR(outcome.objective, truth.objective, 1e-7 * (1e-3 + truth.objective));
    EXPECT_LT(violation(instance.problem, solver.knots()), 1e-8);
    EXPECT_LE(outcome.primal_residual, 1e-9);
  }
  EXPECT_GE(solved, 1500);
  EXPECT_GE(infeasible, 200);
  EXPECT_LE(left_open, 100);
}

TEST(ActiveSetSolver, WithoutABindingConstraintTheFirstPointIsTheAnswer) {
  ActiveSetSolver solver;
  SplineProblem problem = two_pieces();
  add_face(problem, Vec3(0, 0, 1), 0.5);
  const auto outcome = solver.solve(problem, {});
  EXPECT_EQ(outcome.status, Status::solved);
  EXPECT_EQ(outcome.iterations, 0);
  EXPECT_EQ(solver.binding(), 0);
  EXPECT_LT((solver.knots()[1].col(0) - Vec3(1, 0, 0)).norm(), 1e-12);
  // 720 L^2 / T^5, halved: the least integral of the squared jerk from rest to rest.
  EXPECT_NEAR(outcome.objective, 0.5 * 720.0 * 4.0 / 32.0, 1e-9);
}

TEST(ActiveSetSolver, OneFaceBindsExactly) {
  ActiveSetSolver solver;
  SplineProblem problem = two_pieces();
  add_face(problem, Vec3(0, 0, -1), -0.5);
  const auto outcome = solver.solve(problem, {});
  EXPECT_EQ(outcome.status, Status::solved);
  EXPECT_EQ(outcome.iterations, 1);
  EXPECT_EQ(solver.binding(), 1);
  EXPECT_NEAR(solver.knots()[1](2, 0), 0.5, 1e-12);
}

// The same faces again, thousands of them, change nothing: not the answer, and hardly the work.
TEST(ActiveSetSolver, ThousandsOfCopiesOfFacesChangeNothing) {
  Random random(12);
  ActiveSetSolver solver;
  int compared = 0;
  for (int n = 0; n < 30; ++n) {
    const auto instance = random_instance(random, false, 2.0);
    if (!instance.inside) continue;
    const auto once = solver.solve(instance.problem, {});
    if (once.status != Status::solved) continue;
    const auto knots = solver.knots();
    SplineProblem many = instance.problem;
    many.faces.clear();
    for (FacePoint& point : many.face_points) {
      const int begin = int(many.faces.size());
      for (int copy = 0; copy < 50; ++copy) {
        for (int i = point.begin; i < point.end; ++i) {
          HalfSpace face = instance.problem.faces[std::size_t(i)];
          if (copy % 3 == 1) face.offset_m += 1e-3 * copy;  // behind, parallel
          many.faces.push_back(face);
        }
      }
      point.begin = begin;
      point.end = int(many.faces.size());
    }
    ++compared;
    const auto outcome = solver.solve(many, {});
    EXPECT_EQ(outcome.status, Status::solved);
    EXPECT_NEAR(outcome.objective, once.objective, 1e-9 * (1.0 + once.objective));
    EXPECT_LT(difference(knots, solver.knots()), 1e-6);
  }
  EXPECT_GE(compared, 20);
}

// No interior: what an interior-point method cannot do.
TEST(ActiveSetSolver, AFlatPolytopeHasAnAnswer) {
  ActiveSetSolver solver;
  SplineProblem problem = two_pieces();
  add_face(problem, Vec3(0, 0, 1), 0.25);
  add_face(problem, Vec3(0, 0, -1), -0.25);
  const auto outcome = solver.solve(problem, {});
  EXPECT_EQ(outcome.status, Status::solved);
  EXPECT_NEAR(solver.knots()[1](2, 0), 0.25, 1e-9);
}

TEST(ActiveSetSolver, ProvesThatFacesExcludeEachOther) {
  ActiveSetSolver solver;
  for (const double apart : {1.0, 1e-3, 1e-6}) {
    SCOPED_TRACE(apart);
    SplineProblem problem = two_pieces();
    add_face(problem, Vec3(0, 0, 1), -0.5 * apart);
    add_face(problem, Vec3(0, 0, -1), -0.5 * apart);
    EXPECT_EQ(solver.solve(problem, {}).status, Status::infeasible);
  }
  // Three in a plane that surround nothing.
  SplineProblem problem = two_pieces();
  for (const double angle : {0.1, 2.2, 4.3}) {
    add_face(problem, Vec3(std::cos(angle), std::sin(angle), 0.0), -0.01);
  }
  EXPECT_EQ(solver.solve(problem, {}).status, Status::infeasible);
}

TEST(ActiveSetSolver, ProvesThatTooShortDurationsAreInfeasible) {
  Random random(7);
  ActiveSetSolver solver;
  int proved = 0;
  for (int n = 0; n < 100; ++n) {
    const auto instance = random_instance(random, false, 0.3);
    const auto outcome = solver.solve(instance.problem, {});
    EXPECT_NE(outcome.status, Status::solved);
    if (outcome.status == Status::infeasible) ++proved;
  }
  EXPECT_GE(proved, 90);
}

// Near the soonest flight nearly every Euclidean limit binds: that is the interior point's work.
TEST(ActiveSetSolver, GivesUpSoonWhereManyBallsBind) {
  Random random(16);
  test::CorridorKind kind;
  kind.segments = 6;
  const Corridor corridor = test::random_corridor(random, kind);
  const FlatState start = test::at_rest(corridor.waypoints_map.front());
  const auto soonest =
      TrajectoryOptimizer::create({}).value().optimise(test::ask(corridor), corridor);
  ASSERT_TRUE(soonest);
  Plan plan;
  plan.knots.push_back(start);
  for (const BezierPiece& piece : soonest->trajectory().pieces) {
    plan.durations_s.push_back(1.001 * piece.duration_s);
    plan.polytopes.push_back(piece.polytope);
    plan.knots.push_back(start);
    plan.knots.back().position = piece.control_points.col(5);
  }
  plan.reference_s = plan.duration_s();
  SplineProblem problem;
  Units units;
  ASSERT_TRUE(make_problem(test::ask(corridor), corridor, plan, {.scale = false}, problem, units));
  ActiveSetSolver solver;
  const auto outcome = solver.solve(problem, {.gap = 1e-7});
  EXPECT_EQ(outcome.status, Status::iteration_limit);
  EXPECT_FALSE(ActiveSetSolver::decided(outcome));
  EXPECT_LE(outcome.iterations, 30 + 8 * problem.pieces());
  SplineSolver interior;
  EXPECT_EQ(interior.solve(problem, {.gap = 1e-7}).status, Status::solved);
}

TEST(ActiveSetSolver, AnswersRepeatBitForBitWhateverWentBefore) {
  Random random(13);
  ActiveSetSolver used, fresh;
  for (int n = 0; n < 50; ++n) {
    SCOPED_TRACE(n);
    const auto other = random_instance(random, false, 1.5);
    const auto instance = random_instance(random, false, 1.5);
    used.solve(other.problem, {});
    const auto a = used.solve(instance.problem, {});
    fresh = ActiveSetSolver();
    const auto b = fresh.solve(instance.problem, {});
    EXPECT_EQ(a.status, b.status);
    EXPECT_EQ(a.iterations, b.iterations);
    EXPECT_EQ(a.objective, b.objective);
    EXPECT_EQ(a.gap, b.gap);
    if (a.status != Status::solved) continue;
    for (std::size_t k = 0; k < used.knots().size(); ++k) {
      EXPECT_EQ(used.knots()[k], fresh.knots()[k]);
    }
  }
}

TEST(ActiveSetSolver, OnePieceIsOnlyChecked) {
  ActiveSetSolver solver;
  SplineProblem problem = two_pieces();
  problem.durations = {2.0};
  problem.v_max = {100.0};
  problem.a_max = {100.0};
  problem.knots.erase(problem.knots.begin() + 1);
  EXPECT_EQ(solver.solve(problem, {}).status, Status::solved);
  problem.v_max = {1.0};  // 15/8 of the mean speed of 1 at the middle, more in the hull
  EXPECT_EQ(solver.solve(problem, {}).status, Status::infeasible);
}

TEST(ActiveSetSolver, WhatIsNotFiniteIsNotSolved) {
  ActiveSetSolver solver;
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {kNan, double(INFINITY), -double(INFINITY)}) {
    SplineProblem problem = two_pieces();
    add_face(problem, Vec3(0, 0, 1), bad);
    EXPECT_EQ(solver.solve(problem, {}).status, Status::numerical_trouble);
    problem = two_pieces();
    add_face(problem, Vec3(bad, 0, 1), 1.0);
    EXPECT_EQ(solver.solve(problem, {}).status, Status::numerical_trouble);
    problem = two_pieces();
    problem.knots[2](0, 0) = bad;
    EXPECT_EQ(solver.solve(problem, {}).status, Status::numerical_trouble);
  }
  for (const double duration : {0.0, -1.0, 1e-300, 1e300, kNan, double(INFINITY)}) {
    SplineProblem problem = two_pieces();
    problem.durations[1] = duration;
    EXPECT_NE(solver.solve(problem, {}).status, Status::solved) << duration;
  }
}

TEST(ActiveSetSolver, StopsWhenToldTo) {
  ActiveSetSolver solver;
  SplineProblem problem = two_pieces();
  add_face(problem, Vec3(0, 0, -1), -0.5);
  const std::function<bool()> now = [] { return true; };
  EXPECT_EQ(solver.solve(problem, {.stop = &now}).status, Status::stopped);
}

TEST(ActiveSetSolver, SuitsFixedDurationsOfFewPieces) {
  SplineProblem problem = two_pieces();
  EXPECT_TRUE(ActiveSetSolver::suits(problem));
  problem.scale = true;
  EXPECT_FALSE(ActiveSetSolver::suits(problem));
  problem.scale = false;
  problem.durations.assign(101, 1.0);
  EXPECT_FALSE(ActiveSetSolver::suits(problem));
}

}  // namespace
}  // namespace goshawk::trajectory_optimizer
