// Motions: velocities are the derivatives of places, and never above the stated bounds.
#include "goshawk/movers/motion.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <numbers>

#include "fcl_truth.hpp"

namespace goshawk::movers {
namespace {

using testing::HasSubstr;

constexpr double kStep_s = 1e-5;

Vec3 turned(const Quaternion& from, const Quaternion& to) {
  const Eigen::AngleAxisd turn(Eigen::Quaterniond(to * from.conjugate()));
  return turn.angle() * turn.axis();
}

/// At almost all times the velocities are what differences of places say; at all times the bounds
/// hold between any two moments.
template <typename AnyMotion>
void expect_consistent(const AnyMotion& motion, double from_s, double to_s) {
  int wrong = 0;
  constexpr int kTimes = 4000;
  for (int i = 0; i < kTimes; ++i) {
    const double t_s = from_s + (to_s - from_s) * i / kTimes;
    const BoxState a = motion.at(t_s), b = motion.at(t_s + kStep_s),
                   middle = motion.at(t_s + kStep_s / 2);
    const Vec3 velocity = (b.position_map - a.position_map) / kStep_s;
    const Vec3 turn = turned(a.q_map_box, b.q_map_box) / kStep_s;
    EXPECT_LE(velocity.norm(), motion.top_speed_m_s() + 1e-5);
    EXPECT_LE(turn.norm(), motion.top_turn_rad_s() + 1e-5);
    EXPECT_NEAR(a.q_map_box.norm(), 1.0, 1e-12);
    const bool same = (velocity - middle.velocity_map).norm() < 1e-4 &&
                      (turn - middle.angular_velocity_map).norm() < 1e-4;
    wrong += same ? 0 : 1;
  }
  // A walk that changes speed at once does so at its points alone.
  EXPECT_LE(wrong, 4);
}

WalkParameters corner() {
  return {.points_map = {Vec3(0, 0, 1), Vec3(4, 0, 1), Vec3(4, 3, 1)},
          .pauses_s = {0.0, 1.0, 0.5},
          .speed_m_s = 2.0};
}

TEST(Motion, VelocitiesAreDerivativesAndBoundsHold) {
  for (const Repeat repeat : {Repeat::loop, Repeat::back_and_forth, Repeat::once}) {
    for (const double acceleration : {0.0, 1.5}) {
      WalkParameters p = corner();
      p.repeat = repeat;
      p.acceleration_m_s2 = acceleration;
      expect_consistent(Walk::create(p).value(), -20.0, 40.0);
    }
  }
  expect_consistent(Turn{Vec3(1, 2, 3), Vec3(1, 1, 0).normalized(), Vec3(0, 0, -2), 0.7, 2.0}, -5.0,
                    5.0);
  expect_consistent(Turn{.arm_map = Vec3(2, 0, 0), .rate_rad_s = -1.5}, -5.0, 5.0);
  expect_consistent(Slide{Vec3(1, 0, 0), Vec3(0, 2, 1), 3.0}, -5.0, 5.0);
  expect_consistent(Trefoil{Vec3(1, 2, 3), Vec3(2, 3, 4), 1.0, 4.6}, -30.0, 30.0);
  expect_consistent(
      Track::create(
          {{0.0, Vec3(0, 0, 0), 3.0}, {1.0, Vec3(1, 0, 0), -3.0}, {3.0, Vec3(0, 0, 0), 3.0}}, true)
          .value(),
      -5.0, 9.0);
}

TEST(Walk, GoesToItsPointsWaitsAndTurns) {
  const Walk walk = Walk::create(corner()).value();
  EXPECT_TRUE(walk.at(0.0).position_map.isApprox(Vec3(0, 0, 1)));
  const double turned_s = std::numbers::pi / 3.0;  // half a turn at 3 rad/s: it came from behind
  EXPECT_TRUE(walk.at(turned_s + 1.0).position_map.isApprox(Vec3(2, 0, 1)));
  EXPECT_TRUE(walk.at(turned_s + 1.0).velocity_map.isApprox(Vec3(2, 0, 0)));
  // It stands at the second point for its pause.
  EXPECT_TRUE(walk.at(turned_s + 2.9).position_map.isApprox(Vec3(4, 0, 1)));
  EXPECT_EQ(walk.at(turned_s + 2.9).velocity_map.norm(), 0.0);
  EXPECT_TRUE(walk.at(walk.period_s() + 0.5).position_map.isApprox(walk.at(0.5).position_map));
}

TEST(Walk, OnceStandsAtBothEnds) {
  WalkParameters p = corner();
  p.repeat = Repeat::once;
  const Walk walk = Walk::create(p).value();
  EXPECT_TRUE(walk.at(-1.0).position_map.isApprox(Vec3(0, 0, 1)));
  EXPECT_TRUE(walk.at(1e3).position_map.isApprox(Vec3(4, 3, 1)));
  EXPECT_EQ(walk.at(1e3).velocity_map.norm(), 0.0);
}

TEST(Walk, BadParametersAreNamed) {
  const auto said = [](WalkParameters p) { return Walk::create(p).error().message; };
  WalkParameters p = corner();
  p.points_map.resize(1);
  EXPECT_THAT(said(p), HasSubstr("fewer than two points"));
  p = corner(), p.points_map[1] = p.points_map[0];
  EXPECT_THAT(said(p), HasSubstr("point 2 is the same"));
  p = corner(), p.points_map[1] = p.points_map[0] + Vec3(1e-200, 0, 0);
  EXPECT_THAT(said(p), HasSubstr("point 2 is the same"));
  p = corner(), p.points_map[1].x() = std::nan("");
  EXPECT_THAT(said(p), HasSubstr("1e6 m"));
  p = corner(), p.pauses_s.pop_back();
  EXPECT_THAT(said(p), HasSubstr("2 pauses, but 3 points"));
  p = corner(), p.speed_m_s = 0.0;
  EXPECT_THAT(said(p), HasSubstr("speed"));
  p = corner(), p.turn_rate_rad_s = 1e-9;
  EXPECT_THAT(said(p), HasSubstr("turn_rate"));
}

TEST(Track, JumpsAndTimesThatDoNotRiseAreRefused) {
  const auto said = [](std::vector<Place> places, bool repeats) {
    return Track::create(std::move(places), repeats).error().message;
  };
  EXPECT_THAT(said({{0.0, Vec3::Zero(), 0.0}}, false), HasSubstr("two places"));
  EXPECT_THAT(said({{0.0, Vec3::Zero(), 0.0}, {0.0, Vec3::Zero(), 0.0}}, false),
              HasSubstr("time of place 2"));
  EXPECT_THAT(said({{0.0, Vec3::Zero(), 0.0}, {0.1, Vec3(50, 0, 0), 0.0}}, false),
              HasSubstr("jumps to place 2"));
  EXPECT_THAT(said({{0.0, Vec3::Zero(), 0.0}, {std::nan(""), Vec3::Zero(), 0.0}}, false),
              HasSubstr("not finite"));
  EXPECT_THAT(said({{0.0, Vec3::Zero(), 0.0}, {1.0, Vec3(1, 0, 0), 0.0}}, true),
              HasSubstr("must end at the place"));
}

TEST(Trefoil, HasTheLengthsThatAreKnown) {
  for (const auto& [scale, length] : {std::pair{2.0, 15.9}, {3.0, 23.8}, {4.0, 31.7}}) {
    EXPECT_NEAR((Trefoil{.scale_m = Vec3::Constant(scale)}.length_m()), length, 0.06);
  }
}

}  // namespace
}  // namespace goshawk::movers
