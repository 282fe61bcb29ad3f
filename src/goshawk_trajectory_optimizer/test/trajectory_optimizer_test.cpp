#include "goshawk/trajectory_optimizer/trajectory_optimizer.hpp"

#include <gtest/gtest.h>

#include <cstring>

#include "corridor_maker.hpp"
#include "goshawk/trajectory_optimizer/time_profile.hpp"

namespace goshawk::trajectory_optimizer {
namespace {

using test::at_rest;
using test::CorridorKind;

TrajectoryOptimizer make(const Config& config = {}) {
  return TrajectoryOptimizer::create(config).value();
}

Result<Solution> from_rest(TrajectoryOptimizer& optimizer, const Corridor& corridor,
                           const Limits& limits = {}) {
  return optimizer.optimise(test::ask(corridor, limits), corridor);
}

double size(const Vec3& v, LimitNorm norm) {
  return norm == LimitNorm::euclidean ? v.norm() : v.cwiseAbs().maxCoeff();
}

// Shares nothing with the solver or the certificate: samples the curve as a polynomial.
void expect_flyable(const Solution& solution, const Corridor& corridor, const Limits& limits,
                    int samples = 20) {
  for (const auto& piece : solution.trajectory().pieces) {
    const auto& polytope = corridor.polytopes[std::size_t(piece.polytope)];
    for (int i = 0; i <= samples; ++i) {
      const double u = double(i) / samples;
      Vec3 p = Vec3::Zero(), v = Vec3::Zero(), a = Vec3::Zero();
      constexpr double kChoose5[] = {1, 5, 10, 10, 5, 1};
      for (int j = 0; j <= 5; ++j) {  // Bernstein polynomials and their derivatives, spelled out
        const double n = j, m = 5 - j;
        const auto power = [](double x, double e) { return e < 0 ? 0.0 : std::pow(x, e); };
        const double b = power(u, n) * power(1 - u, m);
        const double d =
            n * power(u, n - 1) * power(1 - u, m) - m * power(u, n) * power(1 - u, m - 1);
        const double dd = n * (n - 1) * power(u, n - 2) * power(1 - u, m) -
                          2 * n * m * power(u, n - 1) * power(1 - u, m - 1) +
                          m * (m - 1) * power(u, n) * power(1 - u, m - 2);
        const Vec3 c = kChoose5[j] * piece.control_points.col(j);
        p += b * c;
        v += d / piece.duration_s * c;
        a += dd / (piece.duration_s * piece.duration_s) * c;
      }
      for (int f = 0; f < polytope.faces(); ++f) {
        ASSERT_LE(polytope.half_spaces[std::size_t(f)].distance_m(p), 1e-6);
      }
      ASSERT_LE(size(v, limits.norm), limits.v_max_m_s + 1e-6);
      ASSERT_LE(size(a, limits.norm), limits.a_max_m_s2 + 1e-6);
    }
  }
}

void expect_joined(const Solution& solution, const FlatState& start, const FlatState& goal) {
  const auto& pieces = solution.trajectory().pieces;
  for (std::size_t k = 0; k + 1 < pieces.size(); ++k) {
    const auto end = pieces[k].sample(pieces[k].duration_s);
    const auto begin = pieces[k + 1].sample(0.0);
    ASSERT_EQ(end.position, begin.position);
    ASSERT_LT((end.velocity - begin.velocity).norm(), 1e-9);
    ASSERT_LT((end.acceleration - begin.acceleration).norm(), 1e-7);
  }
  const auto first = pieces.front().sample(0.0);
  ASSERT_EQ(first.position, start.position);
  ASSERT_LT((first.velocity - start.velocity).norm(), 1e-9);
  ASSERT_LT((first.acceleration - start.acceleration).norm(), 1e-7);
  const auto last = pieces.back().sample(pieces.back().duration_s);
  ASSERT_EQ(last.position, goal.position);
  ASSERT_LT((last.velocity - goal.velocity).norm(), 1e-9);
  ASSERT_LT((last.acceleration - goal.acceleration).norm(), 1e-7);
}

CorridorKind random_kind(Random& random) {
  CorridorKind kind;
  kind.segments = 1 + random.below(6);
  kind.least_length_m = random.chance(0.2) ? 0.02 : 0.5;
  kind.least_clearance_m = random.chance(0.2) ? 0.02 : 0.1;
  kind.most_clearance_m = random.uniform(0.2, 2.0);
  kind.planes = 6 + random.below(20);
  kind.most_turn_rad = random.chance(0.2) ? 3.1416 : 1.5;
  return kind;
}

Limits random_limits(Random& random, LimitNorm norm) {
  return {
      .v_max_m_s = random.uniform(0.3, 8.0), .a_max_m_s2 = random.uniform(0.3, 10.0), .norm = norm};
}

class EveryNorm : public testing::TestWithParam<LimitNorm> {};
INSTANTIATE_TEST_SUITE_P(Norms, EveryNorm,
                         testing::Values(LimitNorm::euclidean, LimitNorm::per_axis),
                         [](const auto& given) {
                           return given.param == LimitNorm::euclidean ? "Euclidean" : "PerAxis";
                         });

TEST_P(EveryNorm, EveryRandomCorridorGetsACertifiedFlyableTrajectory) {
  Random random(11);
  auto optimizer = make();
  for (int i = 0; i < 600; ++i) {
    SCOPED_TRACE(i);
    const auto corridor = test::random_corridor(random, random_kind(random));
    const Limits limits = random_limits(random, GetParam());
    const auto solution = from_rest(optimizer, corridor, limits);
    ASSERT_TRUE(solution) << solution.error().message;
    ASSERT_NO_FATAL_FAILURE(expect_flyable(*solution, corridor, limits));
    ASSERT_NO_FATAL_FAILURE(expect_joined(*solution, at_rest(corridor.waypoints_map.front()),
                                          at_rest(corridor.waypoints_map.back())));
    const double straight = (corridor.waypoints_map.back() - corridor.waypoints_map.front()).norm();
    const double fastest = limits.norm == LimitNorm::euclidean ? 1.0 : std::sqrt(3.0);
    EXPECT_GE(
        solution->trajectory().duration_s(),
        rest_to_rest_duration_s(straight, fastest * limits.v_max_m_s, fastest * limits.a_max_m_s2) *
            (1.0 - 1e-9));
  }
}

TEST(TrajectoryOptimizer, StraightFlightsComeCloseToTheTrapezoid) {
  auto optimizer = make();
  for (const double length : {0.001, 0.01, 0.3, 1.0, 3.0, 8.0, 20.0, 60.0}) {
    const auto solution = from_rest(optimizer, test::straight_corridor(length));
    ASSERT_TRUE(solution) << solution.error().message;
    const double optimum = rest_to_rest_duration_s(length, 2.0, 2.0);
    EXPECT_GE(solution->trajectory().duration_s(), optimum);
    EXPECT_LE(solution->trajectory().duration_s(), 1.12 * optimum) << length;
  }
}

TEST(TrajectoryOptimizer, StartThatIsTheGoalIsAnsweredAtRest) {
  auto optimizer = make();
  for (const double length : {0.0, 1e-12, 1e-9, 1e-7, 1e-5}) {
    const auto solution = from_rest(optimizer, test::straight_corridor(length));
    ASSERT_TRUE(solution) << length << solution.error().message;
    EXPECT_LT(solution->trajectory().length_m(), 1e-4);
    EXPECT_LT(solution->trajectory().duration_s(), 1.0);
  }
}

TEST(TrajectoryOptimizer, RepeatsBitForBitWhateverCameBefore) {
  Random random(3);
  const auto corridor = test::random_corridor(random, {});
  auto fresh = make();
  auto used = make();
  for (int i = 0; i < 5; ++i) {
    ASSERT_TRUE(from_rest(used, test::random_corridor(random, random_kind(random))));
  }
  const auto a = from_rest(fresh, corridor);
  const auto b = from_rest(used, corridor);
  ASSERT_TRUE(a && b);
  ASSERT_EQ(int(a->trajectory().pieces.size()), int(b->trajectory().pieces.size()));
  for (std::size_t k = 0; k < a->trajectory().pieces.size(); ++k) {
    const auto& p = a->trajectory().pieces[k];
    const auto& q = b->trajectory().pieces[k];
    EXPECT_EQ(std::memcmp(p.control_points.data(), q.control_points.data(), 18 * sizeof(double)),
              0);
    EXPECT_EQ(p.duration_s, q.duration_s);
  }
}

TEST(TrajectoryOptimizer, ExtraTimeIsSpentOnSmoothness) {
  Random random(8);
  const auto corridor = test::random_corridor(random, {});
  double jerk = HUGE_VAL;
  double soonest = 0.0;
  for (const double extra : {0.0, 0.05, 0.3, 2.0}) {
    Config config;
    config.extra_time = extra;
    auto optimizer = make(config);
    const auto solution = from_rest(optimizer, corridor);
    ASSERT_TRUE(solution) << solution.error().message;
    if (extra == 0.0) soonest = solution->trajectory().duration_s();
    EXPECT_NEAR(solution->trajectory().duration_s(), (1.0 + extra) * soonest, 1e-6);
    EXPECT_LT(solution->jerk_cost, jerk);
    ASSERT_NO_FATAL_FAILURE(expect_flyable(*solution, corridor, {}));
    jerk = solution->jerk_cost;
  }
}

TEST(TrajectoryOptimizer, FixedDurationsAreStretchedUntilFeasible) {
  Config config;
  config.method = Method::fixed;
  auto optimizer = make(config);
  Random random(21);
  for (int i = 0; i < 100; ++i) {
    SCOPED_TRACE(i);
    const auto corridor = test::random_corridor(random, random_kind(random));
    const auto solution = from_rest(optimizer, corridor);
    ASSERT_TRUE(solution) << solution.error().message;
    ASSERT_NO_FATAL_FAILURE(expect_flyable(*solution, corridor, {}));
  }
}

}  // namespace
}  // namespace goshawk::trajectory_optimizer
