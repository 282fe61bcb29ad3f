#include "goshawk/tracker/reference.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "trajectories.hpp"

namespace goshawk::tracker {
namespace {

std::int64_t nanoseconds(double s) {
  return std::llround(s * 1e9);
}

Reference make(std::int64_t start_ns) {
  Random random(3);
  auto committed = random_trajectory(random, {0, 0, 1}, 4, 2.0, 2.0);
  committed.start_time_ns = start_ns;
  return Reference::follow(committed.shared(), committed.start_time_ns);
}

double distance_to_path(const Trajectory& trajectory, const Vec3& p) {
  double least = 1e9;
  const double T = trajectory.duration_s();
  for (int i = 0; i <= 4000; ++i) {
    least = std::min(least, (trajectory.sample(T * i / 4000.0).position - p).norm());
  }
  return least;
}

TEST(Reference, AHeldPointIsAtRestForEver) {
  auto reference = Reference::hold({1, 2, 3});
  reference.brake(5, 2.0);
  EXPECT_TRUE(reference.at_rest(6));
  EXPECT_TRUE(reference.at_rest(0));
  EXPECT_EQ(reference.at(nanoseconds(1e6)).position, Vec3(1, 2, 3));
  EXPECT_EQ(reference.at(nanoseconds(1e6)).velocity, Vec3::Zero());
}

TEST(Reference, FollowsTheTrajectoryFromItsStartTimeAndRestsAtItsEnd) {
  const std::int64_t start = nanoseconds(1000.0);
  const auto reference = make(start);
  const auto& trajectory = reference.committed().flown();
  const double T = reference.duration_s();
  EXPECT_LT((reference.at(start + nanoseconds(1.0)).jerk - trajectory.sample(1.0).jerk).norm(),
            1e-6);
  EXPECT_FALSE(reference.at_rest(start + nanoseconds(T - 0.01)));
  EXPECT_TRUE(reference.at_rest(start + nanoseconds(T + 0.01)));
  const auto after = reference.at(start + nanoseconds(T + 10.0));
  EXPECT_LT((after.position - trajectory.sample(T).position).norm(), 1e-12);
  EXPECT_EQ(after.acceleration, Vec3::Zero());
}

TEST(Reference, BrakingStaysOnThePathAndComesToRest) {
  for (const double begin : {0.05, 1.0, 3.0, 5.5}) {
    auto reference = make(0);
    const double speed = reference.at(nanoseconds(begin)).velocity.norm();
    reference.brake(nanoseconds(begin), 2.0);
    reference.brake(nanoseconds(begin + 0.1), 2.0);  // again: nothing new
    ASSERT_FALSE(reference.follows());
    for (double t = begin; t < begin + 3.0; t += 0.05) {
      const auto s = reference.at(nanoseconds(t));
      EXPECT_LT(distance_to_path(reference.committed().flown(), s.position), 2e-3);
      EXPECT_LE(s.acceleration.norm(), 2.0 + 2.5);
    }
    const double T = std::max(0.5, speed / 2.0);
    EXPECT_TRUE(reference.at_rest(nanoseconds(begin + T) + 1));
    EXPECT_FALSE(reference.at_rest(nanoseconds(begin + T - 0.01)));
    EXPECT_EQ(reference.at(nanoseconds(begin + T) + 1).velocity, Vec3::Zero());
  }
}

// Velocity, acceleration and jerk against central differences, braking or not.
TEST(Reference, DerivativesAreThoseOfThePosition) {
  for (const bool braking : {false, true}) {
    auto reference = make(0);
    if (braking) reference.brake(nanoseconds(2.0), 1.0);
    const double h = 1e-4;
    for (double t = 2.05; t < 2.6; t += 0.05) {
      const auto at = [&](double s) { return reference.at(nanoseconds(s)); };
      const auto slope = [&](const Vec3& a, const Vec3& b) { return Vec3((b - a) / (2.0 * h)); };
      const auto s = at(t);
      EXPECT_LT((slope(at(t - h).position, at(t + h).position) - s.velocity).norm(), 1e-5);
      EXPECT_LT((slope(at(t - h).velocity, at(t + h).velocity) - s.acceleration).norm(), 1e-5);
      EXPECT_LT((slope(at(t - h).acceleration, at(t + h).acceleration) - s.jerk).norm(), 1e-3);
    }
  }
}

TEST(Reference, BeforeItsStartItComesInWithTheStartsVelocity) {
  auto committed = straight_line({0, 0, 0}, {4, 0, 0}, 4.0);
  committed.trajectory.pieces[0] =
      BezierPiece::between({.velocity = {1, 0, 0}}, {.position = {4, 0, 0}}, 4.0);
  certify_as_is(committed);
  const auto reference = Reference::follow(committed.shared(), committed.start_time_ns);
  EXPECT_LT((reference.at(-nanoseconds(0.01)).position - Vec3(-0.01, 0, 0)).norm(), 1e-9);
}

}  // namespace
}  // namespace goshawk::tracker
