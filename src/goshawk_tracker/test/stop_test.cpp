#include "goshawk/tracker/stop.hpp"

#include <gtest/gtest.h>

#include "trajectories.hpp"

namespace goshawk::tracker {
namespace {

const StopLimits kLimits{.gentle_m_s2 = 2.0, .hardest_m_s2 = 5.0};
using Contact = std::optional<double>;
const FirstContact kFreeEverywhere = [](const BezierPiece&) { return Contact(); };
const FirstContact kFreeNowhere = [](const BezierPiece&) { return Contact(0.0); };

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
    for (const FirstContact& contact : {kFreeEverywhere, kFreeNowhere}) {
      const auto stop = plan_stop(flight.vehicle, flight.path(), kLimits, contact).curve;
      const auto begin = stop.sample(0.0), end = stop.sample(stop.duration_s);
      EXPECT_LT((begin.position - flight.vehicle.position).norm(), 1e-9);
      EXPECT_LT((begin.velocity - flight.vehicle.velocity).norm(), 1e-9);
      EXPECT_LT(
          (begin.acceleration - flight.vehicle.acceleration).cross(flight.vehicle.velocity).norm(),
          1e-9);
      EXPECT_LT(end.velocity.norm() + end.acceleration.norm(), 1e-9);
      const auto peaks = Trajectory{{stop}}.peaks();
      EXPECT_LE(peaks.speed_m_s, 1.05 * std::max(0.6, flight.vehicle.velocity.norm()));
      EXPECT_LE(stop.duration_s, contact(stop) ? 1.0 : 1.6);
    }
  }
}

TEST(Stop, ReturnsToThePathThatIsNear) {
  for (std::uint64_t seed = 1; seed <= 50; ++seed) {
    Flight flight(seed);
    flight.vehicle.position += flight.aside(0.1);
    for (const FirstContact& contact : {kFreeEverywhere, kFreeNowhere}) {
      const auto stop = plan_stop(flight.vehicle, flight.path(), kLimits, contact).curve;
      EXPECT_LT(flight.to_path(stop.control_points.col(5)), 0.01);
    }
  }
}

TEST(Stop, FarFromThePathItStopsStraightAhead) {
  Flight flight(3);
  const Vec3 away = Vec3(0, 0, 3);
  flight.vehicle.position += away;
  flight.vehicle.acceleration.setZero();
  const auto stop = plan_stop(flight.vehicle, flight.path(), kLimits, kFreeEverywhere).curve;
  const Vec3 moved = stop.control_points.col(5) - flight.vehicle.position;
  EXPECT_LT(moved.cross(flight.vehicle.velocity).norm(), 1e-9);
  EXPECT_GT(moved.dot(flight.vehicle.velocity), 0.0);
}

// A wall ahead at different distances: as gentle as it may be, and never through the wall.
TEST(Stop, BrakesHarderWhenSomethingIsAhead) {
  const FlatState vehicle{.velocity = {2, 0, 0}};
  double last_s = 0.0;
  for (const double wall_m : {0.65, 0.9, 1.2, 2.0}) {
    const FirstContact wall = [&](const BezierPiece& piece) {
      for (int i = 0; i <= 100; ++i) {
        const double t = piece.duration_s * i / 100;
        if (piece.sample(t).position.x() > wall_m) return Contact(t);
      }
      return Contact();
    };
    const Stop planned = plan_stop(vehicle, {}, kLimits, wall);
    const BezierPiece& stop = planned.curve;
    EXPECT_FALSE(planned.enters_s) << wall_m;
    EXPECT_FALSE(wall(stop)) << wall_m;
    EXPECT_GE(stop.duration_s, last_s);
    last_s = stop.duration_s;
  }
  EXPECT_NEAR(last_s, 1.5, 1e-9);  // 3/2 v / a of the gentle one
}

// A path that stands still for weeks is not walked along for weeks.
TEST(Stop, BesideAPathThatHardlyMovesItIsFoundAtOnce) {
  const Trajectory path{{BezierPiece::between({}, {.position = {1e-3, 0, 0}}, 1e7)}};
  const FlatState vehicle{.velocity = {1, 0, 0}};
  const Stop stop = plan_stop(vehicle, LeftPath{&path, 0.0, 1.0}, kLimits, kFreeEverywhere);
  EXPECT_TRUE(stop.curve.control_points.allFinite());
}

// A wall that is too near for any stop: the one that meets it last, and it says when.
TEST(Stop, WhereNoneIsFreeTheOneThatStaysFreeForLongestIsTaken) {
  const FlatState vehicle{.velocity = {2, 0, 0}};
  const FirstContact by_duration = [](const BezierPiece& piece) {
    return Contact(2.0 - piece.duration_s);  // the hardest stop meets it last
  };
  const Stop hardest = plan_stop(vehicle, {}, kLimits, by_duration);
  EXPECT_NEAR(hardest.curve.duration_s, 0.6, 1e-9);
  EXPECT_NEAR(hardest.enters_s.value(), 1.4, 1e-9);
  const FirstContact gentle_is_late = [](const BezierPiece& piece) {
    return Contact(piece.duration_s);
  };
  EXPECT_NEAR(plan_stop(vehicle, {}, kLimits, gentle_is_late).curve.duration_s, 1.5, 1e-9);
}

}  // namespace
}  // namespace goshawk::tracker
