#include <gtest/gtest.h>

#include <algorithm>
#include <memory>

#include "both.hpp"
#include "goshawk/core/random.hpp"

namespace goshawk::px4_stand_in {
namespace {

constexpr double kLag_m = 0.1;  // of the vehicle behind its setpoint
constexpr double kBrakeOfBridge_m = 0.1;

px4::Config config_of(px4::ModeKind mode) {
  px4::Config config;
  config.takeoff = px4::Takeoff::automatic;
  config.mode = mode;
  if (mode == px4::ModeKind::external) config.margin_m = 1.4;
  return config;
}

/// In the air, on the tracker's reference, at a random moment.
std::unique_ptr<Both> flying(px4::ModeKind mode, Random& random) {
  auto both = std::make_unique<Both>(config_of(mode), Config{});
  EXPECT_TRUE(both->run_until([&] { return both->bridge().ready(); }, 60.0));
  both->run(1.0);
  both->tracker_runs = true;
  both->run(4.0 + random.uniform(0.0, 8.0));
  EXPECT_EQ(both->bridge().phase(), px4::Phase::flying);
  return both;
}

/// [m] across the ground: the farthest that the vehicle gets from a place; its largest speed there.
struct Worst {
  double distance_m = 0.0;
  double speed_m_s = 0.0;
  void look(Both& both, const Vec3& place) {
    const RigidBodyState& truth = both.autopilot().truth();
    distance_m = std::max(distance_m, (truth.position_map - place).head<2>().norm());
    speed_m_s = std::max(speed_m_s, truth.velocity_map.head<2>().norm());
  }
};

TEST(Silence, AKilledBridgeEndsInHoldWithinTheMargin) {
  Random random(11);
  for (int i = 0; i < 12; ++i) {
    const auto both = flying(px4::ModeKind::offboard, random);
    const FlatState last = both->reference();
    both->bridge_runs = false;
    Worst worst;
    both->run(12.0, [&] { worst.look(*both, last.position); });
    const double most_m =
        px4::flies_on_m(config_of(px4::ModeKind::offboard), last.velocity.norm()) + kLag_m;
    EXPECT_LT(worst.distance_m, most_m) << "at " << last.velocity.norm() << " m/s";
    EXPECT_LT(worst.distance_m, config_of(px4::ModeKind::offboard).margin_m);
    EXPECT_EQ(both->autopilot().nav_state(), px4::nav_state::kHold);
    EXPECT_LT(both->autopilot().truth().velocity_map.norm(), 0.02);
  }
}

TEST(Silence, AKilledBridgeOfAModeOfItsOwnEndsInLandWithinTheMargin) {
  Random random(12);
  const px4::Config config = config_of(px4::ModeKind::external);
  for (int i = 0; i < 12; ++i) {
    const auto both = flying(px4::ModeKind::external, random);
    const FlatState last = both->reference();
    both->bridge_runs = false;
    Worst worst;
    both->run(20.0, [&] { worst.look(*both, last.position); });
    EXPECT_LT(worst.distance_m, px4::flies_on_m(config, last.velocity.norm()) + kLag_m);
    EXPECT_LT(worst.distance_m, config.margin_m);
    EXPECT_TRUE(both->autopilot().landed());
    EXPECT_LT(both->autopilot().touched_m_s(), 1.0);
    EXPECT_FALSE(both->autopilot().armed());
  }
}

TEST(Silence, AKilledTrackerEndsAtRestOnItsOwnStop) {
  Random random(13);
  for (int i = 0; i < 12; ++i) {
    const auto both = flying(px4::ModeKind::offboard, random);
    const FlatState last = both->reference();
    both->tracker_runs = false;
    Worst worst;
    both->run(5.0, [&] { worst.look(*both, last.position); });
    const double v = last.velocity.norm() + 0.05;
    EXPECT_LT(worst.distance_m, 0.25 * v + v * v / (2.0 * 2.0) + kLag_m);
    EXPECT_EQ(both->autopilot().nav_state(), px4::nav_state::kOffboard);
    EXPECT_LT(both->autopilot().truth().velocity_map.norm(), 0.03);
    EXPECT_TRUE(both->told_of("the tracker fell silent"));
    both->run(8.0);  // nobody comes back
    EXPECT_EQ(both->autopilot().nav_state(), px4::nav_state::kHold);
  }
}

TEST(Silence, AStalledBridgeNeverMakesTheVehicleFastNorFar) {
  Random random(14);
  for (const double stall_s : {0.1, 0.25, 0.5, 1.0, 3.0}) {
    for (int i = 0; i < 4; ++i) {
      const auto both = flying(px4::ModeKind::offboard, random);
      const FlatState last = both->reference();
      both->bridge_runs = false;
      Worst worst;
      const auto look = [&] { worst.look(*both, last.position); };
      both->run(stall_s, look);
      both->tracker_runs = false;  // it waits until it knows where the vehicle is
      both->bridge_runs = true;
      both->run(6.0, look);
      const double most_m =
          px4::flies_on_m(config_of(px4::ModeKind::offboard), last.velocity.norm()) + kLag_m +
          kBrakeOfBridge_m;
      EXPECT_LT(worst.distance_m, most_m) << stall_s;
      EXPECT_LT(worst.speed_m_s, 1.3 * both->speed_m_s) << stall_s;
      EXPECT_LT(both->autopilot().truth().velocity_map.norm(), 0.05) << stall_s;
    }
  }
}

TEST(Silence, ARestartedBridgeHoldsOncePx4ReturnsToItsMode) {
  Random random(15);
  const auto both = flying(px4::ModeKind::offboard, random);
  both->tracker_runs = false;
  both->bridge_runs = false;
  both->run(2.0);
  EXPECT_EQ(both->autopilot().nav_state(), px4::nav_state::kHold);
  const Vec3 place = both->autopilot().truth().position_map;
  both->restart_bridge();
  both->bridge_runs = true;
  both->run(10.0);
  EXPECT_EQ(both->autopilot().nav_state(), px4::nav_state::kOffboard);
  EXPECT_EQ(both->bridge().phase(), px4::Phase::flying);
  EXPECT_LT((both->autopilot().truth().position_map - place).norm(), 0.1);
}

// The margin of a flight that would need 1.2 m is refused before anything is sent.
TEST(Silence, AMarginThatDoesNotCoverItIsRefused) {
  px4::Config config = config_of(px4::ModeKind::offboard);
  config.offboard_loss_s = 1.0;
  config.v_max_m_s = 1.0;
  EXPECT_EQ(px4::check(config).code(), ErrorCode::invalid_parameter);
}

}  // namespace
}  // namespace goshawk::px4_stand_in
