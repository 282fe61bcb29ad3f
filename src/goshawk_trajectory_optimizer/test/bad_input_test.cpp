// Whatever comes in, a code and a sentence go out, or a certified trajectory.
#include <gtest/gtest.h>

#include <limits>

#include "corridor_maker.hpp"
#include "goshawk/trajectory_optimizer/trajectory_optimizer.hpp"

namespace goshawk::trajectory_optimizer {
namespace {

using test::at_rest;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

Result<Solution> optimise(const Corridor& corridor, const Limits& limits = {}) {
  auto optimizer = TrajectoryOptimizer::create({}).value();
  const auto end = [](const std::vector<Vec3>& waypoints, bool first) {
    if (waypoints.empty()) return at_rest(Vec3::Zero());
    return at_rest(first ? waypoints.front() : waypoints.back());
  };
  return optimizer.optimise(
      test::ask(end(corridor.waypoints_map, true), end(corridor.waypoints_map, false), limits),
      corridor);
}

Corridor two_boxes(double gap) {
  Corridor corridor;
  corridor.waypoints_map = {Vec3(0, 0, 0), Vec3(2, 0, 0), Vec3(4, 0, 0)};
  corridor.polytopes = {Polytope::box(Vec3(-1, -1, -1), Vec3(2, 1, 1)),
                        Polytope::box(Vec3(2 + gap, -1, -1), Vec3(5, 1, 1))};
  test::fill_overlaps(corridor);
  return corridor;
}

void expect_code(const Result<Solution>& result, ErrorCode code) {
  ASSERT_FALSE(result);
  EXPECT_EQ(result.code(), code) << result.error().message;
  EXPECT_GT(result.error().message.size(), 20u);
}

TEST(BadInput, EmptyOrInconsistentCorridors) {
  expect_code(optimise({}), ErrorCode::invalid_input);
  auto corridor = two_boxes(-0.5);
  corridor.overlaps.clear();
  expect_code(optimise(corridor), ErrorCode::invalid_input);
  corridor = two_boxes(-0.5);
  corridor.polytopes[1] = {};
  expect_code(optimise(corridor), ErrorCode::invalid_input);
}

TEST(BadInput, PolytopesThatOnlyTouchOrAreApart) {
  expect_code(optimise(two_boxes(0.0)), ErrorCode::corridor_disjoint);
  auto apart = two_boxes(0.5);
  EXPECT_FALSE(optimise(apart));
  auto lie = two_boxes(0.0);
  lie.overlaps[0] = {Vec3(2, 0, 0), 0.5};
  expect_code(optimise(lie), ErrorCode::corridor_disjoint);
}

TEST(BadInput, FlatAndEmptyPolytopes) {
  Corridor corridor;
  corridor.waypoints_map = {Vec3(0, 0, 0), Vec3(1, 0, 0)};
  corridor.polytopes = {Polytope::box(Vec3(-1, 0, -1), Vec3(2, 0, 1))};
  expect_code(optimise(corridor), ErrorCode::invalid_input);
  corridor.polytopes = {Polytope::box(Vec3(2, 2, 2), Vec3(1, 1, 1))};
  expect_code(optimise(corridor), ErrorCode::invalid_input);
}

TEST(BadInput, NumbersThatAreNotFiniteOrHuge) {
  for (const double bad : {kNaN, kInfinity, -kInfinity}) {
    auto corridor = two_boxes(-0.5);
    corridor.polytopes[0].half_spaces[0].offset_m = bad;
    expect_code(optimise(corridor), ErrorCode::invalid_input);
    corridor = two_boxes(-0.5);
    corridor.polytopes[1].half_spaces[0].normal.x() = bad;
    expect_code(optimise(corridor), ErrorCode::invalid_input);
    corridor = two_boxes(-0.5);
    corridor.waypoints_map[1].x() = bad;
    expect_code(optimise(corridor), ErrorCode::invalid_input);
    corridor = two_boxes(-0.5);
    corridor.overlaps[0].center_map.x() = bad;
    expect_code(optimise(corridor), ErrorCode::invalid_input);
  }
  Corridor far;
  far.waypoints_map = {Vec3(1e12, 0, 0), Vec3(1e12 + 1, 0, 0)};
  far.polytopes = {Polytope::box(Vec3(1e12 - 1, -1, -1), Vec3(1e12 + 2, 1, 1))};
  expect_code(optimise(far), ErrorCode::invalid_input);
}

TEST(BadInput, Limits) {
  const auto corridor = test::straight_corridor(2.0);
  for (const double bad : {0.0, -1.0, kNaN, kInfinity, 1e-300, 1e300}) {
    expect_code(optimise(corridor, {.v_max_m_s = bad}), ErrorCode::invalid_limits);
    expect_code(optimise(corridor, {.a_max_m_s2 = bad}), ErrorCode::invalid_limits);
  }
}

TEST(BadInput, EndsThatAreNotTheCorridors) {
  auto optimizer = TrajectoryOptimizer::create({}).value();
  const auto corridor = test::straight_corridor(2.0);
  const auto start = at_rest(corridor.waypoints_map.front());
  const auto goal = at_rest(corridor.waypoints_map.back());
  expect_code(optimizer.optimise(test::ask(at_rest(Vec3(0.1, 0, 0)), goal), corridor),
              ErrorCode::start_infeasible);
  expect_code(optimizer.optimise(test::ask(start, at_rest(Vec3(9, 0, 0))), corridor),
              ErrorCode::invalid_input);
  auto broken = start;
  broken.velocity.x() = kNaN;
  expect_code(optimizer.optimise(test::ask(broken, goal), corridor), ErrorCode::invalid_input);
}

TEST(BadInput, Config) {
  const auto refused = [](Config config) {
    const auto result = TrajectoryOptimizer::create(config);
    return !result && result.code() == ErrorCode::invalid_parameter;
  };
  EXPECT_TRUE(refused({.method = Method(7)}));
  EXPECT_TRUE(refused({.piece_duration_s = kNaN}));
  EXPECT_TRUE(refused({.min_pieces = 0}));
  EXPECT_TRUE(refused({.refinement_passes = -1}));
  EXPECT_TRUE(refused({.extra_time = -0.1}));
  EXPECT_TRUE(refused({.max_iterations = 0}));
  EXPECT_FALSE(refused({}));
}

// Unusual, but with an answer.

TEST(UnusualInput, UnboundedPolytopesAreFlownThrough) {
  Corridor corridor;
  corridor.waypoints_map = {Vec3(0, 0, 0), Vec3(4, 0, 0)};
  Polytope half_space;
  half_space.add(Vec3::UnitZ(), 0.5);
  corridor.polytopes = {half_space};
  const auto solution = optimise(corridor);
  ASSERT_TRUE(solution) << solution.error().message;
}

TEST(UnusualInput, ThousandsOfFaces) {
  Random random(4);
  test::CorridorKind kind;
  kind.segments = 2;
  kind.planes = 3000;
  kind.least_clearance_m = 0.5;
  const auto solution = optimise(test::random_corridor(random, kind));
  ASSERT_TRUE(solution) << solution.error().message;
}

TEST(UnusualInput, FarFromTheOriginAndOnAFace) {
  Corridor corridor;
  const Vec3 origin(2e5, -3e5, 100.0);
  corridor.waypoints_map = {origin, origin + Vec3(3, 0, 0), origin + Vec3(3, 3, 0)};
  corridor.polytopes = {Polytope::box(origin, origin + Vec3(4, 1, 1)),
                        Polytope::box(origin + Vec3(2, 0, 0), origin + Vec3(3, 3, 1))};
  test::fill_overlaps(corridor);
  const auto solution = optimise(corridor);
  ASSERT_TRUE(solution) << solution.error().message;
}

// Bounded work and memory: longer pieces, not more of them.
TEST(UnusualInput, FlightsOfDaysAndYears) {
  for (const double v : {2.0, 1e-3}) {
    const auto solution = optimise(test::straight_corridor(5e5), {.v_max_m_s = v, .a_max_m_s2 = v});
    if (!solution) {
      EXPECT_GT(solution.error().message.size(), 20u);
      continue;
    }
    EXPECT_LT(int(solution->trajectory().pieces.size()), 3000);
  }
}

TEST(UnusualInput, SlowAndFastVehicles) {
  for (const double v : {0.01, 0.1, 30.0, 1000.0}) {
    for (const double a : {0.01, 1.0, 100.0, 5000.0}) {
      const auto solution = optimise(two_boxes(-0.5), {.v_max_m_s = v, .a_max_m_s2 = a});
      ASSERT_TRUE(solution) << v << " " << a << " " << solution.error().message;
    }
  }
}

}  // namespace
}  // namespace goshawk::trajectory_optimizer
