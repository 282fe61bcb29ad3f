// First contacts of moving balls and moving boxes, against FCL at dense times.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <stdexcept>

#include "fcl_truth.hpp"
#include "goshawk/movers/mover.hpp"

namespace goshawk::movers {
namespace {

constexpr double kTolerance_m = 1e-3;

Mover random_mover(Random& random, int kind) {
  Mover mover{.half_m = Vec3::Constant(0.6) + random_vector(random, 0.5)};
  if (kind == 0) {
    WalkParameters p;
    for (int i = 0; i < 4; ++i) p.points_map.push_back(random_vector(random, 4.0));
    p.speed_m_s = random.uniform(0.5, 4.0);
    p.acceleration_m_s2 = random.chance(0.5) ? 0.0 : 2.0;
    mover.motion = Walk::create(p).value();
  } else if (kind == 1) {
    mover.motion = Turn{random_vector(random, 2.0), random_vector(random, 1.0).normalized(),
                        random_vector(random, 2.0), random.chance(0.5) ? 0.0 : 1.2, 3.0};
  } else {
    mover.motion = Trefoil{random_vector(random, 2.0), Vec3(3.0, 2.5, 3.5), 1.0, 1.5};
  }
  return mover;
}

MovingBall random_ball(Random& random) {
  const double from_s = random.uniform(-5.0, 5.0);
  return {random_vector(random, 3.0), random_vector(random, 3.0), from_s,
          from_s + random.uniform(0.0, 4.0), random.uniform(0.0, 0.8)};
}

/// The first of many moments at which FCL says that they are nearer than near_m.
double first_near_s(const MovingBall& ball, const Mover& mover, double near_m) {
  constexpr int kSteps = 1500;
  for (int i = 0; i <= kSteps; ++i) {
    const double part = double(i) / kSteps;
    const double t_s = ball.from_s + part * (ball.to_s - ball.from_s);
    const Vec3 center = ball.from_map + part * (ball.to_map - ball.from_map);
    const double radius = std::max(ball.radius_m, 1e-6);
    if (fcl_distance_m(mover.box_at(t_s), center, radius) <= near_m) return t_s;
  }
  return std::numeric_limits<double>::infinity();
}

TEST(FirstContact, IsNeverPassedOverAndNeverInvented) {
  Random random(7);
  int touched = 0;
  for (int i = 0; i < 300; ++i) {
    const Mover mover = random_mover(random, i % 3);
    const MovingBall ball = random_ball(random);
    const auto contact = first_contact(ball, mover, kTolerance_m);
    const double fcl_s = first_near_s(ball, mover, 0.0);
    // FCL errs by up to 1e-5 m.
    if (std::isfinite(fcl_s)) {
      ASSERT_TRUE(contact) << i;
      EXPECT_LE(contact->t_s, fcl_s + 1e-9) << i;
    }
    if (!contact) continue;
    ++touched;
    const double part =
        ball.to_s > ball.from_s ? (contact->t_s - ball.from_s) / (ball.to_s - ball.from_s) : 0.0;
    const Vec3 center = ball.from_map + part * (ball.to_map - ball.from_map);
    const double gap_m = mover.box_at(contact->t_s).distance_m(center) - ball.radius_m;
    EXPECT_LE(gap_m, kTolerance_m + 1e-9) << i;
    EXPECT_LT(mover.box_at(contact->t_s).distance_m(contact->place_map), 1e-9) << i;
    // Nothing was within half the tolerance before.
    EXPECT_GE(first_near_s(ball, mover, 0.5 * kTolerance_m - 2e-5), contact->t_s - 1e-9) << i;
  }
  EXPECT_GT(touched, 50);
  EXPECT_LT(touched, 290);
}

TEST(FirstContact, AThinFastBoxIsNotPassedOver) {
  WalkParameters p{.points_map = {Vec3(-50.0, 0.0, 0.0), Vec3(50.0, 0.0, 0.0)},
                   .pauses_s = {},
                   .speed_m_s = 50.0,
                   .turn_rate_rad_s = 0.0};
  const Mover plate{.half_m = Vec3(0.001, 0.5, 0.5), .motion = Walk::create(p).value()};
  const MovingBall ball{Vec3::Zero(), Vec3::Zero(), 0.0, 2.0, 0.1};
  const auto contact = first_contact(ball, plate, kTolerance_m);
  ASSERT_TRUE(contact);
  EXPECT_NEAR(contact->t_s, (50.0 - 0.101) / 50.0, kTolerance_m / 50.0 + 1e-9);
}

TEST(FirstContact, StillThingsThatDoNotTouchEndAtOnce) {
  const Mover still{.half_m = Vec3::Ones(), .motion = Still{}};
  const MovingBall ball{Vec3(3.0, 0.0, 0.0), Vec3(3.0, 0.0, 0.0), 0.0, 1e6, 0.5};
  EXPECT_FALSE(first_contact(ball, still, kTolerance_m));
}

TEST(FirstContact, AToleranceThatNoTimeResolvesEndsAsWell) {
  const Mover slides{.half_m = Vec3::Ones(), .motion = Slide{Vec3::Zero(), Vec3(3, 0, 0), 1.0}};
  const MovingBall ball{Vec3(4.1, 0, 0), Vec3(4.1, 0, 0), 0.0, 1e6, 0.1};
  EXPECT_TRUE(first_contact(ball, slides, 1e-15));
}

TEST(FirstContact, WhatCannotBeIsABug) {
  const Mover still{.motion = Still{}};
  EXPECT_THROW(first_contact({.from_s = 1.0, .to_s = 0.0}, still, 1e-3), std::invalid_argument);
  EXPECT_THROW(first_contact({.radius_m = std::nan("")}, still, 1e-3), std::invalid_argument);
  EXPECT_THROW(first_contact({}, still, 0.0), std::invalid_argument);
}

}  // namespace
}  // namespace goshawk::movers
