// The judge of trackers, judged by trackers whose worth is known.
#include "goshawk/obstacle_tracker_lab/score.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace goshawk::obstacle_tracker {
namespace {

std::vector<movers::Mover> walker() {
  movers::WalkParameters p{.points_map = {Vec3(0, 0, 1), Vec3(100, 0, 1)},
                           .pauses_s = {0.0, 1.0},
                           .speed_m_s = 1.0,
                           .repeat = movers::Repeat::once};
  return {{.id = 1, .half_m = Vec3(0.3, 0.3, 0.9), .motion = movers::Walk::create(p).value()}};
}

TrackedObstacle perfect(const movers::Mover& mover, double t_s, std::uint64_t id) {
  TrackedObstacle o;
  o.box.id = id;
  o.box.position_map = mover.at(t_s).position_map;
  o.box.velocity_map = mover.at(t_s).velocity_map;
  o.bound_m = 0.01;
  return o;
}

std::vector<Vec3> points_on(const movers::Mover& mover, double t_s) {
  return std::vector<Vec3>(10, mover.at(t_s).position_map + Vec3(0.3, 0, 0));
}

TEST(Score, APerfectTrackerIsPerfect) {
  const auto truth = walker();
  Score score(truth);
  for (double t = 0.1; t < 5.0; t += 0.1) {
    const std::vector told{perfect(truth[0], t, 5)};
    score.add(points_on(truth[0], t), told, t);
  }
  const Figures f = score.figures();
  EXPECT_EQ(f.recall, 1.0);
  EXPECT_EQ(f.precision, 1.0);
  EXPECT_EQ(f.switches, 0);
  EXPECT_LT(f.position_error_m, 1e-12);
  EXPECT_EQ(f.in_bound[0], 1.0);
  EXPECT_EQ(f.in_bound[3], 1.0);
  ASSERT_EQ(f.delays_s.size(), 1u);
  EXPECT_EQ(f.delays_s[0], 0.0);
}

TEST(Score, FaultsAreCounted) {
  const auto truth = walker();
  Score score(truth);
  for (int i = 1; i <= 40; ++i) {
    const double t = 0.1 * i;
    std::vector<TrackedObstacle> told;
    if (i > 10) told.push_back(perfect(truth[0], t, i > 30 ? 6 : 5));  // late, and a switch
    if (!told.empty()) told[0].box.position_map.y() += 0.5;            // beyond its bound
    if (i > 20) told.push_back(perfect(truth[0], t + 50.0, 9));        // a ghost
    score.add(points_on(truth[0], t), told, t);
  }
  const Figures f = score.figures();
  EXPECT_DOUBLE_EQ(f.recall, 30.0 / 40.0);
  EXPECT_DOUBLE_EQ(f.precision, 30.0 / 50.0);
  EXPECT_EQ(f.false_told, 20);
  EXPECT_EQ(f.switches, 1);
  EXPECT_NEAR(f.position_error_m, 0.5, 1e-9);
  EXPECT_EQ(f.in_bound[0], 0.0);
  ASSERT_EQ(f.delays_s.size(), 1u);
  EXPECT_NEAR(f.delays_s[0], 1.0, 1e-9);
}

TEST(Score, WhatCannotBeSeenNeedNotBeTold) {
  const auto truth = walker();
  Score score(truth);
  for (double t = 0.1; t < 2.0; t += 0.1) score.add({}, {}, t);
  EXPECT_TRUE(std::isnan(score.figures().recall));
}

}  // namespace
}  // namespace goshawk::obstacle_tracker
