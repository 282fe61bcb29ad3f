#include <gmock/gmock.h>

#include <cmath>

#include "goshawk/core/random.hpp"
#include "goshawk/guard/curve.hpp"

namespace goshawk::guard {
namespace {

using testing::HasSubstr;

double distance_to(const std::vector<Sample>& samples, const Vec3& p) {
  double least = HUGE_VAL;
  for (std::size_t i = 0; i + 1 < samples.size(); ++i) {
    for (int j = 0; j <= 200; ++j) {
      const double share = j / 200.0;
      const Vec3 q = (1 - share) * samples[i].position + share * samples[i + 1].position;
      least = std::min(least, (p - q).norm());
    }
  }
  return least;
}

/// Around a circle of a metre in 2 pi seconds, with or without what it does there.
Samples circle(int n, bool moves, bool accelerates = false) {
  Samples plan;
  for (int i = 0; i < n; ++i) {
    const double t = 2.0 * std::numbers::pi * i / (n - 1);
    Sample s{.t_s = t, .position = {std::cos(t), std::sin(t), 1.0}};
    if (moves) s.velocity = Vec3(-std::sin(t), std::cos(t), 0.0);
    if (accelerates) s.acceleration = Vec3(-std::cos(t), -std::sin(t), 0.0);
    plan.samples.push_back(s);
  }
  return plan;
}

void expect_smooth(const Trajectory& trajectory) {
  const auto& pieces = trajectory.pieces;
  for (std::size_t k = 0; k + 1 < pieces.size(); ++k) {
    EXPECT_LT(largest_difference(pieces[k].sample(pieces[k].duration_s), pieces[k + 1].sample(0)),
              1e-7);
  }
}

TEST(SampledCurve, PassesTheSamplesInTimeAndHasNoJumpInAcceleration) {
  Random random(1);
  for (int round = 0; round < 20; ++round) {
    Samples plan;
    double t = 0.0;
    for (int i = 0; i < 3 + round; ++i) {
      plan.samples.push_back({.t_s = t, .position = {random.uniform(-2, 2), 0.3 * i, 1.0}});
      t += random.uniform(0.06, 1.0);
    }
    const auto curve = curve_of(plan);
    ASSERT_TRUE(curve) << curve.error().message;
    for (const Sample& s : plan.samples) {
      EXPECT_LT((curve->trajectory.sample(s.t_s).position - s.position).norm(), 1e-9);
    }
    expect_smooth(curve->trajectory);
    const FlatState begin = curve->trajectory.sample(0.0);
    EXPECT_LT(begin.acceleration.norm(), 1e-7);
    const FlatState end = curve->trajectory.sample(curve->trajectory.duration_s());
    EXPECT_LT(end.velocity.norm(), 1e-9);
  }
}

TEST(SampledCurve, IsNoFurtherFromThePolylineThanItSays) {
  Random random(2);
  for (int round = 0; round < 10; ++round) {
    Samples plan;
    for (int i = 0; i < 8; ++i) {
      plan.samples.push_back(
          {.t_s = 0.5 * i, .position = {random.uniform(-2, 2), random.uniform(-2, 2), 1.0}});
    }
    const auto curve = curve_of(plan).value();
    double farthest_m = 0.0;
    for (int i = 0; i <= 400; ++i) {
      const double t = curve.trajectory.duration_s() * i / 400;
      const Vec3 p = curve.trajectory.sample(t).position;
      farthest_m = std::max(farthest_m, distance_to(plan.samples, p));
    }
    EXPECT_LE(farthest_m, curve.deviation_m + 1e-9);
    EXPECT_GT(farthest_m, 0.1 * curve.deviation_m) << "the bound is of use";
  }
}

TEST(SampledCurve, WithVelocitiesHasThemAtTheSamples) {
  for (const bool accelerates : {false, true}) {
    const auto plan = circle(41, true, accelerates);
    const auto curve = curve_of(plan).value();
    for (const Sample& s : plan.samples) {
      const FlatState state = curve.trajectory.sample(s.t_s);
      EXPECT_LT((state.velocity - *s.velocity).norm(), 1e-9);
      const Vec3 inwards(-std::cos(s.t_s), -std::sin(s.t_s), 0.0);
      const bool is_end = &s == &plan.samples.front() || &s == &plan.samples.back();
      EXPECT_LT((state.acceleration - inwards).norm(), accelerates ? 1e-9 : is_end ? 0.1 : 0.01);
    }
    expect_smooth(curve.trajectory);
    EXPECT_LT(curve.deviation_m, 0.01);
  }
}

TEST(SampledCurve, LeavesOutSamplesThatComeFasterThanTheVehicleTurns) {
  const auto curve = curve_of(circle(6284, true, true)).value();  // at 1 kHz
  EXPECT_LE(curve.trajectory.pieces.size(), 130u);
  EXPECT_GE(curve.trajectory.pieces.size(), 100u);
  EXPECT_LT(curve.deviation_m, 1e-3);
  EXPECT_NEAR(curve.trajectory.duration_s(), 2.0 * std::numbers::pi, 1e-9);
}

// As planners send them: steps cut to nanoseconds, and the end a rounding after the last step.
TEST(SampledCurve, KeepsSamplesAt20HzThoughTheirStampsAreCutToNanoseconds) {
  Samples plan;
  for (int i = 0; i <= 40; ++i) {
    plan.samples.push_back(
        {.t_s = std::floor(i * 0.05 * 1e9 - 0.5) * 1e-9, .position = {0.05 * i, 0, 1}});
  }
  plan.samples.front().t_s = 0.0;
  plan.samples.push_back({.t_s = 2.0 + 1e-9, .position = {2.0, 0, 1}});
  const auto curve = curve_of(plan).value();
  ASSERT_EQ(curve.trajectory.pieces.size(), 40u);
  for (const BezierPiece& piece : curve.trajectory.pieces)
    EXPECT_NEAR(piece.duration_s, 0.05, 1e-6);
  EXPECT_LT(curve.trajectory.peaks().speed_m_s, 1.5) << "no jump at the end";
}

TEST(SampledCurve, IsRefusedWithTheReasonIfItIsNone) {
  const auto refusal = [&](auto&& spoil) {
    Samples plan = circle(10, false);
    spoil(plan.samples);
    const auto curve = curve_of(plan);
    EXPECT_EQ(curve.code(), ErrorCode::invalid_input);
    return curve ? std::string() : curve.error().message;
  };
  using All = std::vector<Sample>;
  EXPECT_THAT(refusal([](All& s) { s.resize(1); }), HasSubstr("1 points"));
  EXPECT_THAT(refusal([](All& s) { s.resize(100'000); }), HasSubstr("100000 points"));
  EXPECT_THAT(refusal([](All& s) { s[4].position.x() = NAN; }), HasSubstr("point 4"));
  EXPECT_THAT(refusal([](All& s) { s[4].position.x() = 1e7; }), HasSubstr("point 4"));
  EXPECT_THAT(refusal([](All& s) { s[4].velocity = Vec3(NAN, 0, 0); }), HasSubstr("point 4"));
  EXPECT_THAT(refusal([](All& s) {
                for (Sample& sample : s) sample.velocity = Vec3(1e200, 0, 0);
              }),
              HasSubstr("the velocities lead beyond 1000 km"));
  EXPECT_THAT(refusal([](All& s) { std::swap(s[4].t_s, s[5].t_s); }), HasSubstr("at point 5"));
  EXPECT_THAT(refusal([](All& s) { s[5].t_s = s[4].t_s; }), HasSubstr("at point 5"));
  EXPECT_THAT(refusal([](All& s) {
                s.clear();
                for (int i = 0; i < 5000; ++i) s.push_back({.t_s = 1.0 * i});
              }),
              HasSubstr("4999 steps"));
}

}  // namespace
}  // namespace goshawk::guard
