#include "goshawk/league/flight.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "goshawk/league/settings.hpp"

namespace goshawk::league {
namespace {

Options racer() {
  Options options;
  EXPECT_TRUE(apply_file(RACER, options.vehicle));
  options.latency_s = 0.002;
  return options;
}

TEST(LeagueFlight, ReachesAGoalThatItCannotSeeAtFirstAndTouchesNothing) {
  const auto scene = make_scene("standardized", 30).value();  // straight behind the last column
  for (const auto tracking : {closed_loop::Tracking::physical, closed_loop::Tracking::ideal}) {
    Options options = racer();
    options.tracking = tracking;
    const auto outcome = fly(scene, options).value();
    EXPECT_TRUE(outcome.arrived) << outcome.reason;
    EXPECT_FALSE(outcome.verdict.touched) << outcome.verdict.sentence;
    EXPECT_GT(outcome.length_m, (scene.goal - scene.start).norm() - 0.1);
    EXPECT_LE(outcome.top_speed_m_s, 1.05 * std::sqrt(3.0) * scene.limits.v_max_m_s);
    EXPECT_LT(outcome.max_error_m, 0.05);
    EXPECT_GT(outcome.plans, 5);
    EXPECT_NEAR(outcome.track.back().t_s, outcome.time_s, 0.01);
  }
}

TEST(LeagueFlight, RepeatsToTheBitIfLatencyIsGiven) {
  const auto scene = make_scene("standardized", 12).value();
  Options options = racer();
  options.range_noise_m = 0.01;
  options.seed = 7;
  const auto one = fly(scene, options).value();
  const auto other = fly(scene, options).value();
  EXPECT_EQ(one.time_s, other.time_s);
  EXPECT_EQ(one.length_m, other.length_m);
  EXPECT_EQ(one.commits, other.commits);
  ASSERT_EQ(one.track.size(), other.track.size());
  EXPECT_EQ(one.track.back().vehicle.position_map, other.track.back().vehicle.position_map);
}

TEST(LeagueFlight, OfAKnownWorldNeedsNoScan) {
  const auto scene = make_scene("standardized", 20).value();
  Options options = racer();
  options.known = true;
  const auto outcome = fly(scene, options).value();
  EXPECT_TRUE(outcome.arrived) << outcome.reason;
  EXPECT_TRUE(outcome.scan_s.empty());
  EXPECT_EQ(outcome.violations, 0) << outcome.worst_use;
  EXPECT_FALSE(outcome.verdict.touched);
}

TEST(LeagueFlight, AFlightThatIsNotOverInTimeHasFailedAndSaysSo) {
  auto scene = make_scene("standardized", 0).value();
  scene.longest_s = 1.0;
  const auto outcome = fly(scene, racer()).value();
  EXPECT_FALSE(outcome.arrived);
  EXPECT_EQ(outcome.reason, "not there after 1 s");
}

}  // namespace
}  // namespace goshawk::league
