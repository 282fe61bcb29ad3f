// Replanning in flight: the start has a velocity and an acceleration.
#include <gtest/gtest.h>

#include "corridor_maker.hpp"
#include "goshawk/trajectory_optimizer/trajectory_optimizer.hpp"

namespace goshawk::trajectory_optimizer {
namespace {

using test::at_rest;

TrajectoryOptimizer make_optimizer() {
  return TrajectoryOptimizer::create({}).value();
}

struct Replan {
  Corridor corridor;
  FlatState start;
  double left_s = 0.0;  // of the first plan
};

// A moment of a flight, and the corridor from there on.
Replan interrupt(Random& random, const Corridor& corridor, const Trajectory& trajectory) {
  double t = random.uniform(0.0, 0.95) * trajectory.duration_s();
  Replan replan;
  replan.start = trajectory.sample(t);
  replan.left_s = trajectory.duration_s() - t;
  std::size_t piece = 0;
  while (t > trajectory.pieces[piece].duration_s) t -= trajectory.pieces[piece++].duration_s;
  const auto first = std::size_t(trajectory.pieces[piece].polytope);
  replan.corridor.waypoints_map.push_back(replan.start.position);
  for (std::size_t k = first; k < corridor.polytopes.size(); ++k) {
    replan.corridor.polytopes.push_back(corridor.polytopes[k]);
    replan.corridor.waypoints_map.push_back(corridor.waypoints_map[k + 1]);
  }
  test::fill_overlaps(replan.corridor);
  return replan;
}

TEST(MovingStart, NearlyEveryInterruptedFlightIsReplannedAndCertified) {
  Random random(77);
  auto optimizer = make_optimizer();
  int replanned = 0;
  constexpr int kFlights = 150;
  for (int i = 0; i < kFlights; ++i) {
    SCOPED_TRACE(i);
    test::CorridorKind kind;
    kind.segments = 1 + random.below(5);
    const auto corridor = test::random_corridor(random, kind);
    const Limits limits{.norm = i % 2 == 0 ? LimitNorm::euclidean : LimitNorm::per_axis};
    const auto goal = at_rest(corridor.waypoints_map.back());
    const auto first = optimizer.optimise(
        test::ask(at_rest(corridor.waypoints_map.front()), goal, limits), corridor);
    ASSERT_TRUE(first) << first.error().message;
    const auto replan = interrupt(random, corridor, first->trajectory());
    const auto second = optimizer.optimise(test::ask(replan.start, goal, limits), replan.corridor);
    if (!second) {
      EXPECT_EQ(second.code(), ErrorCode::start_infeasible) << second.error().message;
      continue;
    }
    ++replanned;
    // The same path with a moving start: no stop in between.
    EXPECT_LT(second->trajectory().duration_s(), 1.3 * replan.left_s + 0.5);
    const auto begin = second->trajectory().sample(0.0);
    EXPECT_LT((begin.velocity - replan.start.velocity).norm(), 1e-9);
    EXPECT_LT((begin.acceleration - replan.start.acceleration).norm(), 1e-7);
  }
  EXPECT_GE(replanned, kFlights * 97 / 100);
}

TEST(MovingStart, HoldsTheTopSpeedItStartsWith) {
  auto optimizer = make_optimizer();
  auto start = at_rest(Vec3::Zero());
  start.velocity = Vec3(2.0, 0, 0);
  const auto solution =
      optimizer.optimise(test::ask(start, at_rest(Vec3(8, 0, 0))), test::straight_corridor(8.0));
  ASSERT_TRUE(solution) << solution.error().message;
  EXPECT_LT(solution->trajectory().duration_s(), 1.1 * (7.0 / 2.0 + 1.0));
}

TEST(MovingStart, TurnsAroundWhereThereIsRoom) {
  auto optimizer = make_optimizer();
  auto start = at_rest(Vec3::Zero());
  start.velocity = Vec3(-1.0, 0, 0);  // away from the goal; stops within 0.25 m of 1 m
  const auto solution =
      optimizer.optimise(test::ask(start, at_rest(Vec3(5, 0, 0))), test::straight_corridor(5.0));
  ASSERT_TRUE(solution) << solution.error().message;
}

TEST(MovingStart, TowardsAWallTooFastIsSaidToBeInfeasible) {
  auto optimizer = make_optimizer();
  auto start = at_rest(Vec3::Zero());
  start.velocity = Vec3(-1.9, 0, 0);  // needs 0.9 m to stop, has 0.3 m
  const auto solution = optimizer.optimise(test::ask(start, at_rest(Vec3(5, 0, 0))),
                                           test::straight_corridor(5.0, 0.3));
  ASSERT_FALSE(solution);
  EXPECT_EQ(solution.code(), ErrorCode::start_infeasible);
}

// Sampled, and held against what the certificate says.
void expect_braked(const Solution& solution, const FlatState& start, const Limits& limits) {
  const auto allowance = StartAllowance::of(start, limits);
  const double until_s = solution.certified.certificate().start_excess_s;
  const Trajectory& trajectory = solution.trajectory();
  for (int i = 0; i <= 2000; ++i) {
    const double t = trajectory.duration_s() * i / 2000;
    const FlatState s = trajectory.sample(t);
    const double v = limits.speed_usage(s.velocity);
    const double a = limits.acceleration_usage(s.acceleration);
    ASSERT_LE(v, t < until_s ? allowance.speed + 1e-6 : 1.0 + 1e-5) << t;
    ASSERT_LE(a, t < until_s ? allowance.acceleration + 1e-6 : 1.0 + 1e-5) << t;
  }
}

TEST(MovingStart, AboveALimitIsBrakedAndTheCertificateSaysSo) {
  auto optimizer = make_optimizer();
  auto start = at_rest(Vec3::Zero());
  for (const double v : {2.05, 2.5, 3.0, 4.0}) {
    for (const double a : {-2.0, 0.0, 1.5, 2.5}) {
      SCOPED_TRACE(std::to_string(v) + " " + std::to_string(a));
      start.velocity = Vec3(v, 0, 0);
      start.acceleration = Vec3(a, 0, 0);
      const auto solution = optimizer.optimise(test::ask(start, at_rest(Vec3(20, 0, 0))),
                                               test::straight_corridor(20.0));
      ASSERT_TRUE(solution) << solution.error().message;
      ASSERT_NO_FATAL_FAILURE(expect_braked(*solution, start, {}));
      EXPECT_GE(solution->certified.certificate().start_excess_m_s, v - 2.0 - 1e-9);
      EXPECT_GT(solution->certified.certificate().start_excess_s, (v - 2.0) / 2.0 * 0.99);
      EXPECT_LT(solution->certified.certificate().start_excess_s,
                StartAllowance::of(start, {}).until_s + 0.5);
      EXPECT_EQ(solution->trajectory().sample(0.0).position, start.position);
    }
  }
}

TEST(MovingStart, FarAboveALimitIsRefusedWithAReason) {
  auto optimizer = make_optimizer();
  auto start = at_rest(Vec3::Zero());
  start.velocity = Vec3(11.0, 0, 0);
  const auto fast =
      optimizer.optimise(test::ask(start, at_rest(Vec3(50, 0, 0))), test::straight_corridor(50.0));
  ASSERT_FALSE(fast);
  EXPECT_EQ(fast.code(), ErrorCode::start_infeasible);
  EXPECT_NE(fast.error().message.find("speed"), std::string::npos);
}

TEST(MovingGoal, IsReachedInMotion) {
  auto optimizer = make_optimizer();
  auto goal = at_rest(Vec3(6, 0, 0));
  goal.velocity = Vec3(1.5, 0, 0);
  const auto corridor = test::straight_corridor(6.0);
  const auto moving = optimizer.optimise(test::ask(at_rest(Vec3::Zero()), goal), corridor);
  const auto resting =
      optimizer.optimise(test::ask(at_rest(Vec3::Zero()), at_rest(goal.position)), corridor);
  ASSERT_TRUE(moving) << moving.error().message;
  ASSERT_TRUE(resting);
  EXPECT_LT(moving->trajectory().duration_s(), resting->trajectory().duration_s());
}

}  // namespace
}  // namespace goshawk::trajectory_optimizer
