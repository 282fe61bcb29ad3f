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
    EXPECT_LT((reference.at(nanoseconds(begin) + 1000).acceleration -
               reference.at(nanoseconds(begin) - 1000).acceleration)
                  .norm(),
              1e-3);
    const double T = std::max(0.5, 1.5 * speed / 2.0);
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

// What is in the way counts only as far as the reference gets, and when it gets there.
TEST(Reference, TellsWhenItMeetsAnObstacleBrakingOrNot) {
  VoxelGrid grid;
  grid.geometry = {
      .origin_map = Vec3::Constant(-20.0), .resolution_m = 0.1, .size = {400, 400, 400}};
  grid.grown = BitGrid(grid.geometry.size, true);
  const FreeSpace empty(std::make_shared<const VoxelGrid>(grid));
  for (const double begin : {0.5, 1.5, 3.0}) {
    for (const bool brakes : {false, true}) {
      auto reference = make(0);
      if (brakes) reference.brake(nanoseconds(begin), 1.0);
      for (const double ahead : {0.1, 0.4, 0.7, 30.0}) {
        const Vec3 place = reference.at(nanoseconds(begin + ahead)).position;
        const Index3 voxel = grid.geometry.index_of(place).value();
        auto map = std::make_shared<VoxelGrid>(grid);
        map->grown.set(voxel, true);
        const FreeSpace blocked(map);
        const auto found = reference.find_obstruction(blocked, nanoseconds(begin));
        ASSERT_TRUE(found);
        EXPECT_EQ(found->voxel, voxel);
        EXPECT_LE(found->time_s, ahead);
        const auto enters =
            reference.at(nanoseconds(begin + found->time_s)).position - grid.geometry.center(voxel);
        EXPECT_LT(enters.cwiseAbs().maxCoeff(), 0.05 + 0.03) << "at the voxel's face";
        EXPECT_FALSE(reference.find_obstruction(
            blocked, nanoseconds(begin), nanoseconds(begin + std::max(0.0, found->time_s - 0.01))));
      }
      EXPECT_FALSE(reference.find_obstruction(empty, nanoseconds(begin)));
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
