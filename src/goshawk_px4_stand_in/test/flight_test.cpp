#include <gtest/gtest.h>

#include <algorithm>

#include "both.hpp"

namespace goshawk::px4_stand_in {
namespace {

using px4::ModeKind;
using px4::Release;

constexpr double kError_m = 0.12;  // of the vehicle against its reference, at 0.45 m/s

px4::Config bridge_config() {
  px4::Config config;
  config.takeoff = px4::Takeoff::automatic;
  return config;
}

px4::Config external_config() {
  px4::Config config = bridge_config();
  config.mode = ModeKind::external;
  config.margin_m = 1.4;
  return config;
}

void take_off(Both& both) {
  ASSERT_TRUE(both.run_until([&] { return both.bridge().ready(); }, 60.0));
  both.run(2.0);
}

/// Flies the tracker's reference. @return [m] the largest error once it has settled
double fly(Both& both, double seconds) {
  both.tracker_runs = true;
  both.run(1.0);
  double largest = 0.0;
  both.run(seconds, [&] {
    const Vec3 off = both.autopilot().truth().position_map - both.reference().position;
    largest = std::max(largest, off.norm());
  });
  return largest;
}

TEST(Px4Flight, TakesOffInOffboardAndKeepsToTheReference) {
  Both both(bridge_config(), Config{});
  take_off(both);
  EXPECT_EQ(both.autopilot().nav_state(), px4::nav_state::kOffboard);
  EXPECT_NEAR(both.autopilot().truth().position_map.z(), 1.1, 0.1);
  EXPECT_LT(fly(both, 20.0), kError_m);
  EXPECT_EQ(both.bridge().phase(), px4::Phase::flying);
}

// PX4's own Takeoff, as a mode of another program cannot leave the ground.
TEST(Px4Flight, TakesOffWithItsOwnModeAndKeepsToTheReference) {
  Both both(external_config(), Config{});
  take_off(both);
  EXPECT_EQ(both.autopilot().nav_state(), px4::nav_state::kExternal1);
  EXPECT_LT(fly(both, 20.0), kError_m);
}

TEST(Px4Flight, EveryReleaseFliesInBothModes) {
  for (const Release release : {Release::v1_15, Release::v1_16, Release::v1_17, Release::v1_18}) {
    for (px4::Config bridge : {bridge_config(), external_config()}) {
      Config autopilot;
      bridge.release = autopilot.release = release;
      Both both(bridge, autopilot);
      take_off(both);
      EXPECT_LT(fly(both, 3.0), kError_m) << to_word(release) << " " << to_word(bridge.mode);
    }
  }
}

TEST(Px4Flight, AnotherReleaseIsNotFlown) {
  Config autopilot;
  autopilot.release = Release::v1_18;
  Both both(bridge_config(), autopilot);
  both.run(30.0);
  EXPECT_FALSE(both.autopilot().armed());
  EXPECT_TRUE(both.told_of("set px4_release to 1.18"));
}

TEST(Px4Flight, WherePx4sOriginLiesDoesNotMatter) {
  px4::Config bridge = bridge_config();
  Config autopilot;
  bridge.origin_x_m = autopilot.origin_x_m = 12.0;
  bridge.origin_y_m = autopilot.origin_y_m = -7.0;
  bridge.origin_z_m = autopilot.origin_z_m = 0.4;
  bridge.origin_yaw_rad = autopilot.origin_yaw_rad = 2.1;
  autopilot.start_yaw_rad = -1.0;
  Both both(bridge, autopilot);
  take_off(both);
  EXPECT_LT(fly(both, 5.0), kError_m);
  ASSERT_TRUE(both.given());
  EXPECT_LT((both.given()->state.position_map - both.autopilot().truth().position_map).norm(),
            0.02);
}

// What is planned stays where the world is.
TEST(Px4Flight, AResetInFlightMovesNothingInTheWorld) {
  Both both(bridge_config(), Config{});
  take_off(both);
  const double before = fly(both, 5.0);
  for (const double heading : {0.1, -0.15}) {
    both.autopilot().reset_estimate({0.15, -0.1, 0.08}, heading);
    EXPECT_LT(fly(both, 5.0), before + 0.05) << heading;
  }
  EXPECT_EQ(both.bridge().phase(), px4::Phase::flying);
  EXPECT_GE(both.bridge().resets(), 2u);
}

TEST(Px4Flight, AResetOfFiveMetresEndsInPx4sHold) {
  Both both(bridge_config(), Config{});
  take_off(both);
  fly(both, 3.0);
  const Vec3 place = both.autopilot().truth().position_map;
  both.autopilot().reset_estimate({5.0, 0.0, 0.0}, 0.0);
  both.run(10.0);
  EXPECT_EQ(both.autopilot().nav_state(), px4::nav_state::kHold);
  EXPECT_LT(both.autopilot().truth().velocity_map.norm(), 0.05);
  EXPECT_LT((both.autopilot().truth().position_map - place).norm(), bridge_config().margin_m);
  EXPECT_TRUE(both.told_of("PX4's own Hold"));
}

TEST(Px4Flight, ThePilotsSticksWinAtOnce) {
  Config autopilot;
  Both both(bridge_config(), autopilot);
  take_off(both);
  fly(both, 2.0);
  autopilot.sticks = Sticks::moved;
  both.autopilot().reconfigure(autopilot);
  both.run(3.0);
  EXPECT_EQ(both.autopilot().nav_state(), px4::nav_state::kPosition);
  EXPECT_EQ(both.bridge().in_charge(), px4::InCharge::pilot);
  const Vec3 place = both.autopilot().truth().position_map;
  both.run(5.0);
  EXPECT_EQ(both.autopilot().nav_state(), px4::nav_state::kPosition);
  EXPECT_LT((both.autopilot().truth().position_map - place).norm(), 0.05);
}

TEST(Px4Flight, AnUncertainPositionIsNotGivenToTheStages) {
  Config autopilot;
  Both both(bridge_config(), autopilot);
  take_off(both);
  fly(both, 1.0);
  autopilot.position_deviation_m = 0.4;
  both.autopilot().reconfigure(autopilot);
  both.run(1.0);
  EXPECT_FALSE(both.given());
  EXPECT_TRUE(both.told_of("max_position_deviation_m"));
}

TEST(Px4Flight, ATrackerThatRestsOnTheGroundIsLandedAndDisarmed) {
  px4::Config bridge = bridge_config();
  bridge.land_height_m = 2.0;  // so that any rest means landing
  Both both(bridge, Config{});
  take_off(both);
  fly(both, 1.0);
  both.tracker_runs = false;
  ASSERT_TRUE(both.run_until([&] { return !both.autopilot().armed(); }, 60.0));
  EXPECT_TRUE(both.autopilot().landed());
  EXPECT_LT(both.autopilot().touched_m_s(), 1.0);
  EXPECT_TRUE(both.told_of("landed and disarmed"));
  both.run(30.0);
  EXPECT_FALSE(both.autopilot().armed()) << "it does not start again";
}

}  // namespace
}  // namespace goshawk::px4_stand_in
