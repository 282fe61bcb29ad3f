#include "goshawk/core/brake.hpp"

#include <gtest/gtest.h>

namespace goshawk::stops {
namespace {

constexpr double kFast_m_s = 2.0;
const Vec3 kHome(0, 0, 1);

CommittedTrajectory committed(Trajectory trajectory, std::vector<Polytope> polytopes,
                              double a_max_m_s2 = 6.0) {
  const FlatState start = trajectory.sample(0.0);
  const FlatState end = trajectory.sample(trajectory.duration_s());
  const Limits limits{.v_max_m_s = 3.0 * kFast_m_s, .a_max_m_s2 = a_max_m_s2};
  auto certified = certify(std::move(trajectory), std::move(polytopes), limits, start, end).value();
  return CommittedTrajectory::make(
             {.id = 7, .nominal = std::move(certified), .start_time_ns = 0, .map_version = 3})
      .value();
}

/// Along x to (6, 0, 1), a bend, and along y to (6, 6, 1): two polytopes.
CommittedTrajectory bend() {
  const FlatState corner{.position = Vec3(5.5, 0.5, 1), .velocity = Vec3(0.5, 0.5, 0)};
  Trajectory trajectory{{BezierPiece::between({.position = kHome}, corner, 5.0),
                         BezierPiece::between(corner, {.position = Vec3(6, 6, 1)}, 5.0)}};
  trajectory.pieces[1].polytope = 1;
  return committed(std::move(trajectory), {Polytope::box(Vec3(-1, -1, 0), Vec3(7, 1, 2)),
                                           Polytope::box(Vec3(5, -1, 0), Vec3(7, 7, 2))});
}

double distance_to(const Trajectory& path, const Vec3& position) {
  double least = HUGE_VAL;
  for (int i = 0; i <= 20'000; ++i) {
    const double t = path.duration_s() * i / 20'000;
    least = std::min(least, (path.sample(t).position - position).norm());
  }
  return least;
}

TEST(Brake, ComesToRestOnThePathWithinPolytopesAndLimitsFromAnyMoment) {
  const CommittedTrajectory flown = bend();
  int found = 0;
  for (double from_s = 0.2; from_s < 8.0; from_s += 0.3) {
    SCOPED_TRACE(from_s);
    const auto way = brake_along(flown, from_s);
    if (!way) continue;
    ++found;
    const Trajectory& trajectory = way->trajectory();
    EXPECT_LT(largest_difference(trajectory.sample(0.0), flown.flown().sample(from_s)), 1e-9);
    EXPECT_TRUE(way->ends_at_rest());
    EXPECT_LT(trajectory.duration_s(), flown.flown().duration_s() - from_s)
        << "sooner than by itself";
    for (int i = 0; i <= 40; ++i) {
      const FlatState s = trajectory.sample(trajectory.duration_s() * i / 40);
      EXPECT_LT(distance_to(flown.flown(), s.position), 1e-3);
      EXPECT_LE(s.velocity.norm(), flown.nominal().limits().v_max_m_s + 1e-9);
      EXPECT_LE(s.acceleration.norm(), flown.nominal().limits().a_max_m_s2 + 1e-6);
    }
  }
  EXPECT_GE(found, 20);
}

TEST(Brake, KeepsOnlyThePolytopesThatItIsIn) {
  const auto early = brake_along(bend(), 0.5);
  ASSERT_TRUE(early) << early.error().message;
  EXPECT_EQ(early->polytopes().size(), 1u);
  const auto late = brake_along(bend(), 6.5);
  ASSERT_TRUE(late) << late.error().message;
  EXPECT_EQ(late->polytopes().size(), 1u);
  EXPECT_EQ(late->polytopes()[0], bend().nominal().polytopes()[1]);
}

TEST(Brake, AtTheEndThereIsNothingToBrake) {
  const auto way = brake_along(bend(), 9.9);
  ASSERT_FALSE(way);
  EXPECT_EQ(way.code(), ErrorCode::trajectory_infeasible);
}

TEST(Brake, TakesTheFirstWayThatIsFree) {
  std::vector<double> asked;
  const auto way = brake_along(bend(), 3.0, [&](const Trajectory& trajectory) {
    asked.push_back(trajectory.duration_s());
    return asked.size() == 3;
  });
  ASSERT_EQ(asked.size(), 3u);
  EXPECT_TRUE(way);
  EXPECT_TRUE(std::ranges::is_sorted(asked)) << "the hardest first";
  EXPECT_FALSE(brake_along(bend(), 3.0, [](const Trajectory&) { return false; }));
}

TEST(Brake, LeavesATrajectoryWithAStopPartAlongThatPart) {
  const FlatState start{.position = kHome};
  const FlatState end{.position = Vec3(6, 0, 1)};
  const Trajectory nominal{{BezierPiece::between(start, end, 8.0)}};
  const std::vector room{Polytope::box(Vec3(-1, -1, 0), Vec3(7, 1, 2))};
  const Limits limits{.v_max_m_s = 6.0, .a_max_m_s2 = 6.0};
  const FlatState left = nominal.sample(3.0);
  const FlatState rest{.position = left.position + Vec3(2.0, 0, 0)};
  const Trajectory stop{{BezierPiece::between(left, rest, 3.0)}};
  const auto flown = CommittedTrajectory::make(
                         {.id = 7,
                          .nominal = certify(nominal, room, limits, start, end).value(),
                          .stop = StopPart{3.0, certify(stop, room, limits, left, rest).value()}})
                         .value();
  const auto way = brake_along(flown, 3.2);
  ASSERT_TRUE(way) << way.error().message;
  EXPECT_LT(way->trajectory().sample(way->duration_s()).position.x(), rest.position.x());
}

}  // namespace
}  // namespace goshawk::stops
