#include "goshawk/league/live_case.hpp"

#include <gtest/gtest.h>

#include <set>

#include "goshawk/league/settings.hpp"

namespace goshawk::league {
namespace {

closed_loop::Setup racer_setup() {
  closed_loop::Setup setup;
  EXPECT_TRUE(apply_file(RACER, setup));
  return setup;
}

TEST(LiveCase, IsToldByItsNumberAlone) {
  const auto one = make_live_case(12, racer_setup()).value(),
             same = make_live_case(12, racer_setup()).value();
  EXPECT_EQ(one.kind, same.kind);
  EXPECT_EQ(one.scene.goal, same.scene.goal);
  ASSERT_EQ(one.scene.solids.size(), same.scene.solids.size());
  EXPECT_EQ(one.scene.solids.back().center_map, same.scene.solids.back().center_map);
  EXPECT_EQ(one.options.range_m, same.options.range_m);
}

TEST(LiveCase, NumbersDrawEveryKindOfWorldSensorAndPace) {
  std::set<std::string> kinds;
  std::set<double> ranges, noises, views, speeds;
  for (std::uint64_t number = 0; number < 40; ++number) {
    const auto live = make_live_case(number, racer_setup());
    if (!live) continue;
    kinds.insert(live->kind);
    ranges.insert(live->options.range_m);
    noises.insert(live->options.range_noise_m);
    views.insert(live->options.view_rad);
    speeds.insert(live->scene.limits.v_max_m_s);
  }
  EXPECT_EQ(kinds.size(), 3U);
  EXPECT_EQ(ranges.size(), 3U);
  EXPECT_EQ(noises.size(), 3U);
  EXPECT_EQ(views.size(), 2U);
  EXPECT_EQ(speeds.size(), 4U);
}

TEST(LiveCase, AGoalBehindAClosedWallCannotBeReached) {
  Scene scene = make_live_case(3, racer_setup()).value().scene;
  scene.solids.resize(5);  // the walls around and the ground
  EXPECT_TRUE(can_be_reached(scene).value());
  const double x = 0.5 * (scene.start.x() + scene.goal.x());
  scene.solids.push_back(
      {.is_box = true, .center_map = Vec3(x, 10.0, 2.0), .size_m = Vec3(0.3, 60.0, 9.0)});
  EXPECT_FALSE(can_be_reached(scene).value());
}

// goshawk_live_campaign flies as many as the time permits.
TEST(LiveCase, FlightsThroughWorldsThatNobodyKnowsTouchNothingAndArriveWhereASearchDoes) {
  int reachable = 0, arrived = 0;
  for (std::uint64_t number = 0; number < 4; ++number) {
    auto live = make_live_case(number, racer_setup());
    ASSERT_TRUE(live) << live.error().message;
    live->options.latency_s = 0.005;
    const auto outcome = fly(live->scene, live->options).value();
    EXPECT_FALSE(outcome.verdict.touched) << number << ": " << outcome.verdict.sentence;
    if (!can_be_reached(live->scene).value()) continue;
    ++reachable;
    arrived += int(outcome.arrived);
    EXPECT_TRUE(outcome.arrived) << number << ": " << outcome.reason;
  }
  EXPECT_GT(reachable, 0);
  EXPECT_EQ(arrived, reachable);
}

}  // namespace
}  // namespace goshawk::league
