#include "goshawk/tracker/stop.hpp"

#include <gtest/gtest.h>

#include "trajectories.hpp"

namespace goshawk::tracker {
namespace {

const StopLimits kLimits{.gentle_m_s2 = 2.0, .hardest_m_s2 = 5.0};
const IsFree kEverywhere = [](const BezierPiece&) { return true; };
const IsFree kNowhere = [](const BezierPiece&) { return false; };

struct Flight {
  explicit Flight(std::uint64_t seed) : random(seed) {
    trajectory = random_trajectory(random, {0, 0, 1}, 4, 2.0, 2.0).trajectory;
    time_s = random.uniform(0.0, trajectory.duration_s());
    vehicle = trajectory.sample(time_s);
  }
  LeftPath path() const {
    return {&trajectory, std::max(0.0, time_s - 0.2),
            std::min(trajectory.duration_s(), time_s + 0.5)};
  }
  Vec3 aside(double distance_m) {
    return distance_m *
           Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)).normalized();
  }
  double to_path(const Vec3& p) const {
    double least = 1e9;
    for (int i = 0; i <= 2000; ++i) {
      const auto s = trajectory.sample(trajectory.duration_s() * i / 2000.0);
      least = std::min(least, (s.position - p).norm());
    }
    return least;
  }
  Random random;
  Trajectory trajectory;
  double time_s = 0.0;
  FlatState vehicle;
};

TEST(Stop, BeginsWhereTheVehicleIsEndsAtRestAndIsNeverFasterThanItWas) {
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Flight flight(seed);
    flight.vehicle.position += flight.aside(0.1);
    for (const IsFree& is_free : {kEverywhere, kNowhere}) {
      const auto stop = plan_stop(flight.vehicle, flight.path(), kLimits, is_free);
      const auto begin = stop.sample(0.0), end = stop.sample(stop.duration_s);
      EXPECT_LT((begin.position - flight.vehicle.position).norm(), 1e-9);
      EXPECT_LT((begin.velocity - flight.vehicle.velocity).norm(), 1e-9);
      EXPECT_LT(
          (begin.acceleration - flight.vehicle.acceleration).cross(flight.vehicle.velocity).norm(),
          1e-9);
      EXPECT_LT(end.velocity.norm() + end.acceleration.norm(), 1e-9);
      const auto peaks = Trajectory{{stop}}.peaks();
      EXPECT_LE(peaks.speed_m_s, 1.05 * std::max(0.6, flight.vehicle.velocity.norm()));
      EXPECT_LE(stop.duration_s, is_free(stop) ? 1.6 : 1.0);
    }
  }
}

TEST(Stop, ReturnsToThePathThatIsNear) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    Flight flight(seed);
    flight.vehicle.position += flight.aside(0.1);
    for (const IsFree& is_free : {kEverywhere, kNowhere}) {
      const auto stop = plan_stop(flight.vehicle, flight.path(), kLimits, is_free);
      EXPECT_LT(flight.to_path(stop.control_points.col(5)), 0.01);
    }
  }
}

TEST(Stop, FarFromThePathItStopsStraightAhead) {
  Flight flight(3);
  const Vec3 away = Vec3(0, 0, 3);
  flight.vehicle.position += away;
  flight.vehicle.acceleration.setZero();
  const auto stop = plan_stop(flight.vehicle, flight.path(), kLimits, kEverywhere);
  const Vec3 moved = stop.control_points.col(5) - flight.vehicle.position;
  EXPECT_LT(moved.cross(flight.vehicle.velocity).norm(), 1e-9);
  EXPECT_GT(moved.dot(flight.vehicle.velocity), 0.0);
}

// A wall ahead at different distances: as gentle as it may be, and never through the wall.
TEST(Stop, BrakesHarderWhenSomethingIsAhead) {
  const FlatState vehicle{.velocity = {2, 0, 0}};
  double last_s = 0.0;
  for (const double wall_m : {0.65, 0.9, 1.2, 2.0}) {
    const IsFree before_wall = [&](const BezierPiece& piece) {
      return piece.control_points.row(0).maxCoeff() <= wall_m;
    };
    const auto stop = plan_stop(vehicle, {}, kLimits, before_wall);
    EXPECT_TRUE(before_wall(stop)) << wall_m;
    EXPECT_GE(stop.duration_s, last_s);
    last_s = stop.duration_s;
  }
  EXPECT_NEAR(last_s, 1.5, 1e-9);  // 3/2 v / a of the gentle one
}

}  // namespace
}  // namespace goshawk::tracker
