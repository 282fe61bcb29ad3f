#include "goshawk/baselines/baseline_optimizer.hpp"

#include <gtest/gtest.h>

#include <map>

#include "corridor_maker.hpp"
#include "goshawk/baselines/polynomial_baselines.hpp"

namespace goshawk::baselines {
namespace {

namespace test = trajectory_optimizer::test;
using test::at_rest;
using trajectory_optimizer::Solution;

Result<Solution> fly(const Config& config, const Corridor& corridor, const Limits& limits = {}) {
  return BaselineOptimizer::create(config).value().optimise(test::ask(corridor, limits), corridor);
}

void expect_within(const Trajectory& trajectory, const Limits& limits) {
  const double dt = trajectory.duration_s() / 500;
  for (int i = 0; i <= 500; ++i) {
    const FlatState state = trajectory.sample(i * dt);
    EXPECT_LE(limits.speed_usage(state.velocity), 1.0 + 1e-6);
    EXPECT_LE(limits.acceleration_usage(state.acceleration), 1.0 + 1e-6);
  }
}

TEST(BaselineOptimizer, FliesAStraightCorridorByEveryMethod) {
  for (const Method method : {Method::thesis, Method::minimum_snap, Method::minimum_jerk}) {
    SCOPED_TRACE(to_word(method));
    const auto solution = fly({method}, test::straight_corridor(3.0));
    // One quintic cannot keep the limits with the durations from rest to rest.
    if (method == Method::thesis) {
      EXPECT_EQ(solution.code(), ErrorCode::trajectory_infeasible);
      continue;
    }
    ASSERT_TRUE(solution) << solution.error().message;
    expect_within(solution->trajectory(), {});
  }
}

TEST(BaselineOptimizer, ThesisFormIsCertifiedOrSaysThatItIsInfeasible) {
  Random random(22);
  const Limits per_axis{.norm = LimitNorm::per_axis};
  int solved = 0;
  int refused = 0;
  for (int i = 0; i < 200; ++i) {
    SCOPED_TRACE(i);
    test::CorridorKind kind;
    kind.segments = 1 + random.below(6);
    const auto corridor = test::random_corridor(random, kind);
    for (const Limits& limits : {per_axis, Limits{}}) {
      const auto solution = fly({}, corridor, limits);
      if (!solution) {
        EXPECT_EQ(solution.code(), ErrorCode::trajectory_infeasible) << solution.error().message;
        ++refused;
        continue;
      }
      ++solved;
      EXPECT_EQ(solution->trajectory().pieces.size(), corridor.polytopes.size());
      expect_within(solution->trajectory(), limits);
    }
  }
  EXPECT_GT(refused, 0);
  EXPECT_GT(solved, 0);
}

TEST(BaselineOptimizer, PolynomialsAreCertifiedOrRefused) {
  Random random(23);
  std::map<std::pair<Method, ErrorCode>, int> codes;
  for (int i = 0; i < 100; ++i) {
    SCOPED_TRACE(i);
    const auto corridor = test::random_corridor(random, {});
    for (const Method method : {Method::minimum_snap, Method::minimum_jerk}) {
      const auto solution = fly({method}, corridor);
      ++codes[{method, solution.code()}];
      if (!solution) continue;
      expect_within(solution->trajectory(), {});
    }
  }
  // Minimum snap does not know the corridor and mostly leaves it; more waypoints bring it back.
  EXPECT_GT((codes[{Method::minimum_snap, ErrorCode::not_certified}]), 50);
  EXPECT_GT((codes[{Method::minimum_jerk, ErrorCode::ok}]), 90);
}

TEST(BaselineOptimizer, RefusesWhatItDoesNotKnow) {
  EXPECT_EQ(BaselineOptimizer::create({Method(7)}).code(), ErrorCode::invalid_parameter);
  const auto corridor = test::straight_corridor(3.0);
  PlanRequest request = test::ask(corridor);
  request.duration_s = 9.0;
  EXPECT_EQ(BaselineOptimizer::create({}).value().optimise(request, corridor).code(),
            ErrorCode::invalid_input);
  EXPECT_EQ(fly({}, test::straight_corridor(3.0), {.v_max_m_s = -1.0}).code(),
            ErrorCode::invalid_limits);
}

TEST(BaselineOptimizer, AnswersByItsNewConfig) {
  auto optimizer = BaselineOptimizer::create({}).value();
  EXPECT_EQ(optimizer.implementation(), "bezier-thesis");
  EXPECT_TRUE(optimizer.reconfigure({Method::minimum_jerk}));
  EXPECT_EQ(optimizer.implementation(), "polynomial-minimum-jerk");
  EXPECT_FALSE(optimizer.reconfigure({Method(7)}));
  EXPECT_EQ(optimizer.implementation(), "polynomial-minimum-jerk");
}

TEST(RecheckedPolynomial, PlansUntilItIsFreeOrGivesUp) {
  const std::vector<Vec3> corner{Vec3(0, 0, 0), Vec3(3, 0, 0), Vec3(3, 3, 0)};
  const auto plan = [&](const std::function<bool(const BezierPiece&)>& is_free) {
    return rechecked_polynomial(corner, at_rest(corner.front()), at_rest(corner.back()), {},
                                is_free);
  };
  const auto first = plan([](const BezierPiece&) { return true; });
  ASSERT_TRUE(first);
  EXPECT_EQ(first->plans, 1);
  // Kept within 0.2 m of its segment, it takes more plans; within nothing, there is none.
  const auto near = plan([&](const BezierPiece& piece) {
    const Vec3 p = piece.control_points.col(5);
    return std::abs(piece.polytope == 0 ? p.y() : p.x() - 3.0) < 0.2;
  });
  ASSERT_TRUE(near);
  EXPECT_GT(near->plans, 1);
  EXPECT_EQ(plan([](const BezierPiece&) { return false; }).code(),
            ErrorCode::trajectory_infeasible);
}

}  // namespace
}  // namespace goshawk::baselines
