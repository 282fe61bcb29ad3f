#include <gmock/gmock.h>

#include <cmath>

#include "goshawk/core/random.hpp"
#include "goshawk/guard/curve.hpp"

namespace goshawk::guard {
namespace {

Trajectory winding(Random& random, int pieces = 6) {
  Trajectory trajectory;
  FlatState state;
  for (int k = 0; k < pieces; ++k) {
    const FlatState next{.position = Vec3(k + 1.0, random.uniform(-1, 1), random.uniform(0, 2)),
                         .velocity = Vec3(random.uniform(0.5, 1.5), random.uniform(-1, 1), 0)};
    trajectory.pieces.push_back(BezierPiece::between(state, next, random.uniform(0.5, 1.5)));
    state = next;
  }
  return trajectory;
}

double distance_to(const std::vector<Vec3>& polyline, const Vec3& p) {
  double least = HUGE_VAL;
  for (std::size_t i = 0; i + 1 < polyline.size(); ++i) {
    for (int j = 0; j <= 500; ++j) {
      const Vec3 q = polyline[i] + j / 500.0 * (polyline[i + 1] - polyline[i]);
      least = std::min(least, (p - q).norm());
    }
  }
  return least;
}

double farthest_from(const std::vector<Vec3>& polyline, const Trajectory& trajectory) {
  double most = 0.0;
  for (int i = 0; i <= 500; ++i) {
    const Vec3 p = trajectory.sample(trajectory.duration_s() * i / 500).position;
    most = std::max(most, distance_to(polyline, p));
  }
  return most;
}

TEST(Outline, OfACurveIsNoFurtherFromItThanItSays) {
  Random random(1);
  for (int round = 0; round < 5; ++round) {
    const Trajectory trajectory = winding(random);
    const Outline found = outline(trajectory, 0.0);
    const double farthest_m = farthest_from(found.points_map, trajectory);
    EXPECT_LE(farthest_m, found.deviation_m + 1e-3);
    EXPECT_LT(found.deviation_m, 0.2);
  }
}

TEST(Outline, BeginsWhereItIsAskedTo) {
  Random random(2);
  const Trajectory trajectory = winding(random);
  const Outline found = outline(trajectory, 1.3);
  EXPECT_LT((found.points_map.front() - trajectory.sample(1.3).position).norm(), 1e-9);
}

TEST(Simplified, LeavesNothingOutThatIsFurtherThanAllowed) {
  Random random(3);
  for (const double within_m : {0.01, 0.1, 0.5}) {
    const auto all = outline(winding(random, 20), 0.0).points_map;
    const Outline fewer = simplified(all, within_m);
    EXPECT_LE(fewer.deviation_m, within_m);
    EXPECT_LT(fewer.points_map.size(), all.size());
    EXPECT_EQ(fewer.points_map.front(), all.front());
    EXPECT_EQ(fewer.points_map.back(), all.back());
    for (const Vec3& p : all) {
      EXPECT_LE(distance_to(fewer.points_map, p), fewer.deviation_m + 5e-3);
    }
  }
}

TEST(Simplified, HasNoNeighboursThatAreTheSame) {
  const std::vector<Vec3> points{{0, 0, 0}, {0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 1, 0}};
  const Outline fewer = simplified(points, 0.01);
  ASSERT_EQ(fewer.points_map.size(), 3u);
  EXPECT_EQ(fewer.points_map[1], Vec3(1, 0, 0));
}

TEST(Deviation, IsABoundOfHowFarTheCurveIs) {
  Random random(4);
  for (int round = 0; round < 5; ++round) {
    const Trajectory trajectory = winding(random);
    std::vector<Vec3> polyline{Vec3::Zero()};
    for (int i = 1; i < 7; ++i) polyline.emplace_back(i, random.uniform(-1, 1), 1.0);
    const double bound_m = deviation_from(trajectory, polyline);
    const double farthest_m = farthest_from(polyline, trajectory);
    EXPECT_GE(bound_m, farthest_m - 1e-3);
    EXPECT_LE(bound_m, farthest_m + 0.4);
  }
}

TEST(Remainder, IsTheSameCurveFromThenOn) {
  Random random(5);
  const Trajectory trajectory = winding(random);
  for (const double from_s : {0.0, 0.4, 1.7, trajectory.duration_s() - 1e-3}) {
    const Trajectory left = remainder(trajectory, from_s);
    EXPECT_NEAR(left.duration_s(), trajectory.duration_s() - from_s, 1e-9);
    for (int i = 0; i <= 20; ++i) {
      const double t = left.duration_s() * i / 20;
      EXPECT_LT(largest_difference(left.sample(t), trajectory.sample(from_s + t)), 1e-6);
    }
  }
}

TEST(WaypointCheck, NamesWhatIsWrong) {
  const auto code = [](std::vector<Vec3> points) {
    return check(Waypoints{std::move(points)}).code();
  };
  EXPECT_EQ(code({{0, 0, 0}, {1, 0, 0}}), ErrorCode::ok);
  EXPECT_EQ(code({}), ErrorCode::invalid_input);
  EXPECT_EQ(code({{0, 0, 0}}), ErrorCode::invalid_input);
  EXPECT_EQ(code({{0, 0, 0}, {0, 0, 0}}), ErrorCode::invalid_input);
  EXPECT_EQ(code({{0, 0, 0}, {NAN, 0, 0}}), ErrorCode::invalid_input);
  EXPECT_EQ(code({{0, 0, 0}, {1e7, 0, 0}}), ErrorCode::invalid_input);
  EXPECT_EQ(code(std::vector<Vec3>(30'000, Vec3::Zero())), ErrorCode::invalid_input);
}

}  // namespace
}  // namespace goshawk::guard
