#include "goshawk/baselines/polynomial_spline.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "goshawk/core/random.hpp"

namespace goshawk::baselines {
namespace {

Vec3 random_point(Random& random) {
  return {random.uniform(-5.0, 5.0), random.uniform(-5.0, 5.0), random.uniform(-5.0, 5.0)};
}

struct Course {
  std::vector<Vec3> waypoints;
  std::vector<double> durations;
  FlatState start, goal;
};

Course random_course(Random& random) {
  Course course;
  const int segments = 1 + random.below(6);
  for (int k = 0; k <= segments; ++k) course.waypoints.push_back(random_point(random));
  for (int k = 0; k < segments; ++k) course.durations.push_back(random.uniform(0.5, 3.0));
  course.start.position = course.waypoints.front();
  course.goal.position = course.waypoints.back();
  course.start.velocity = 0.3 * random_point(random);
  course.goal.acceleration = 0.3 * random_point(random);
  return course;
}

PolynomialSpline spline_of(const Course& c, Smoothness smoothness) {
  return PolynomialSpline::through(c.waypoints, c.durations, c.start, c.goal, smoothness).value();
}

// Integral of the squared jerk (snap by differences of the jerk), by the midpoint rule.
double roughness(const PolynomialSpline& spline, Smoothness smoothness) {
  constexpr int kSteps = 2000;
  double total = 0.0;
  for (int k = 0; k < spline.segments(); ++k) {
    const double dt = spline.duration_s(k) / kSteps;
    for (int i = 0; i < kSteps; ++i) {
      const Vec3 before = spline.sample(k, i * dt).jerk;
      const Vec3 after = spline.sample(k, (i + 1) * dt).jerk;
      const Vec3 value = smoothness == Smoothness::jerk ? Vec3(0.5 * (before + after))
                                                        : Vec3((after - before) / dt);
      total += value.squaredNorm() * dt;
    }
  }
  return total;
}

class EverySmoothness : public testing::TestWithParam<Smoothness> {};
INSTANTIATE_TEST_SUITE_P(PolynomialSpline, EverySmoothness,
                         testing::Values(Smoothness::jerk, Smoothness::snap));

TEST_P(EverySmoothness, GoesThroughTheWaypointsWithoutAJump) {
  Random random(1);
  for (int i = 0; i < 100; ++i) {
    SCOPED_TRACE(i);
    const Course course = random_course(random);
    const auto spline = spline_of(course, GetParam());
    const auto expect_state = [](const FlatState& state, const FlatState& truth) {
      EXPECT_LT((state.position - truth.position).norm(), 1e-8);
      EXPECT_LT((state.velocity - truth.velocity).norm(), 1e-7);
      EXPECT_LT((state.acceleration - truth.acceleration).norm(), 1e-6);
    };
    const int last = spline.segments() - 1;
    expect_state(spline.sample(0, 0.0), course.start);
    expect_state(spline.sample(last, spline.duration_s(last)), course.goal);
    for (int k = 0; k < last; ++k) {
      const FlatState knot = spline.sample(k, spline.duration_s(k));
      EXPECT_LT((knot.position - course.waypoints[std::size_t(k) + 1]).norm(), 1e-8);
      expect_state(spline.sample(k + 1, 0.0), knot);
    }
  }
}

// Any other curve through the same waypoints is rougher, such as one that also meets a point beside
// the spline.
TEST_P(EverySmoothness, IsSmootherThanACurveThroughOnePointMore) {
  Random random(2);
  for (int i = 0; i < 20; ++i) {
    SCOPED_TRACE(i);
    Course course = random_course(random);
    const auto spline = spline_of(course, GetParam());
    Course detour = course;
    const double half_s = 0.5 * course.durations[0];
    const Vec3 aside = spline.sample(0, half_s).position + 0.05 * random_point(random);
    detour.waypoints.insert(detour.waypoints.begin() + 1, aside);
    detour.durations.insert(detour.durations.begin(), half_s);
    detour.durations[1] = half_s;
    EXPECT_LT(roughness(spline, GetParam()),
              roughness(spline_of(detour, GetParam()), GetParam()) * (1.0 + 1e-6));
  }
}

TEST_P(EverySmoothness, BezierPiecesStayWithItsCurve) {
  Random random(3);
  for (int i = 0; i < 20; ++i) {
    SCOPED_TRACE(i);
    const auto spline = spline_of(random_course(random), GetParam());
    const Trajectory trajectory = spline.to_trajectory(0.1);
    double begin_s = 0.0;
    for (int k = 0; k < spline.segments(); ++k) {
      for (int s = 0; s <= 20; ++s) {
        const double t = spline.duration_s(k) * s / 20;
        EXPECT_LT((trajectory.sample(begin_s + t).position - spline.sample(k, t).position).norm(),
                  1e-4);
      }
      begin_s += spline.duration_s(k);
    }
  }
}

TEST(PolynomialSpline, RefusesWhatItCannotSolve) {
  const FlatState rest;
  const std::vector<Vec3> two{Vec3::Zero(), Vec3(1, 0, 0)};
  const auto code = [&](std::vector<Vec3> waypoints, std::vector<double> durations) {
    return PolynomialSpline::through(waypoints, durations, rest, rest, Smoothness::jerk).code();
  };
  EXPECT_EQ(code(two, {1.0}), ErrorCode::ok);
  EXPECT_EQ(code(two, {}), ErrorCode::invalid_input);
  EXPECT_EQ(code({Vec3::Zero()}, {}), ErrorCode::invalid_input);
  for (const double bad : {0.0, -1.0, double(NAN), HUGE_VAL}) {
    EXPECT_EQ(code(two, {bad}), ErrorCode::invalid_input);
  }
  EXPECT_EQ(code(std::vector<Vec3>(201, Vec3::Zero()), std::vector<double>(200, 1.0)),
            ErrorCode::invalid_input);
}

}  // namespace
}  // namespace goshawk::baselines
