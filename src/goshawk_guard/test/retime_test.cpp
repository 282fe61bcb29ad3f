#include "goshawk/guard/retime.hpp"

#include <gtest/gtest.h>

#include "goshawk/core/random.hpp"

namespace goshawk::guard {
namespace {

constexpr Limits kTight{.v_max_m_s = 1.0, .a_max_m_s2 = 2.0, .j_max_m_s3 = 10.0};

Trajectory dash(double duration_s) {
  return {{BezierPiece::between({}, {.position = {4, 0, 0}}, duration_s)}};
}

// What is flown, by samples: the hull must bound it.
double sampled_use(const Trajectory& trajectory, const Limits& limits) {
  double use = 0.0;
  for (int i = 0; i <= 2000; ++i) {
    const FlatState s = trajectory.sample(trajectory.duration_s() * i / 2000);
    use = std::max({use, limits.speed_usage(s.velocity),
                    std::sqrt(limits.acceleration_usage(s.acceleration)),
                    std::cbrt(s.jerk.norm() / limits.j_max_m_s3)});
  }
  return use;
}

TEST(Retime, RefinedIsTheSameCurveWithATighterBound) {
  const Trajectory whole = dash(9.0);
  const Trajectory parts = refined(whole, kTight);
  EXPECT_GT(parts.pieces.size(), 1u);
  EXPECT_NEAR(parts.duration_s(), 9.0, 1e-9);
  for (int i = 0; i <= 50; ++i) {
    const double t = 9.0 * i / 50;
    EXPECT_LT((whole.sample(t).position - parts.sample(t).position).norm(), 1e-9);
  }
  EXPECT_GT(slowness_of(whole, kTight), 1.5) << "five times the mean speed, by its hull";
  EXPECT_EQ(slowness_of(parts, kTight), 1.0);
}

TEST(Retime, WhatKeepsTheLimitsStaysInOnePiece) {
  EXPECT_EQ(refined(dash(60.0), kTight).pieces.size(), 1u);
}

TEST(Retime, SlowerByWhatIsNeededKeepsTheLimitsAndIsHardlySlowerThanThat) {
  for (const double duration_s : {0.1, 0.5, 2.0, 5.0}) {
    const Trajectory parts = refined(dash(duration_s), kTight);
    const double factor = slowness_of(parts, kTight);
    const Trajectory slow = slower(parts, factor);
    EXPECT_NEAR(slow.duration_s(), factor * duration_s, 1e-9);
    const double use = sampled_use(slow, kTight);
    EXPECT_LE(use, 1.0 + 1e-9);
    EXPECT_GT(use, 0.93);
    EXPECT_LT(
        (slow.sample(0.3 * slow.duration_s()).position - parts.sample(0.3 * duration_s).position)
            .norm(),
        1e-9);
  }
}

TEST(Retime, TheLeastUseIsOfTheCurveAndTheUseOfItsHull) {
  for (const double duration_s : {1.0, 4.0, 9.0}) {
    const Trajectory trajectory = dash(duration_s);
    const double least = least_use_of(trajectory.pieces[0], kTight);
    EXPECT_LE(least, sampled_use(trajectory, kTight) + 1e-9);
    EXPECT_GE(use_of(trajectory.pieces[0], kTight), sampled_use(trajectory, kTight) - 1e-9);
    EXPECT_GT(least, 0.9 * sampled_use(trajectory, kTight)) << "its middle is its fastest";
  }
}

TEST(Retime, BoxesHoldTheirPieces) {
  Random random(1);
  Trajectory trajectory;
  for (int k = 0; k < 5; ++k) {
    BezierPiece piece{.duration_s = 1.0};
    for (int i = 0; i < 6; ++i) {
      piece.control_points.col(i) = Vec3(random.uniform(-3, 3), random.uniform(-3, 3), 0.5);
    }
    trajectory.pieces.push_back(piece);
  }
  const auto boxes = boxes_around(trajectory);
  ASSERT_EQ(boxes.size(), 5u);
  for (int k = 0; k < 5; ++k) {
    const BezierPiece& piece = trajectory.pieces[std::size_t(k)];
    EXPECT_EQ(piece.polytope, k);
    double most = -1.0;
    for (int i = 0; i < 6; ++i) {
      most = std::max(most, boxes[std::size_t(k)].violation(piece.control_points.col(i)));
    }
    EXPECT_NEAR(most, -kBoxMargin_m, 1e-12);
  }
}

}  // namespace
}  // namespace goshawk::guard
