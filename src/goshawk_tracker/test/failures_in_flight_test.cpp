#include <gtest/gtest.h>

#include <cmath>

#include "closed_loop.hpp"
#include "trajectories.hpp"

namespace goshawk::tracker {
namespace {

// Ten metres along y, with 2 m/s in the middle.
Draft ten_metres() {
  auto committed = straight_line({0, 0, 1}, {0, 10, 1}, 9.375);
  committed.start_time_ns = kSecond;
  return committed;
}

// The vehicle's own landing is the simulator's matter.
simulator::Config anywhere() {
  simulator::Config config;
  config.landing = LandingRule::anywhere;
  return config;
}

// 4 x 14 x 3 m of 0.2 m around the line, with something whose top is at table_m and that lies from
// y = 8 m to y = 12 m; 0: an empty room.
std::shared_ptr<const VoxelGrid> room(double table_m) {
  auto grid = std::make_shared<VoxelGrid>();
  grid->geometry = {.origin_map = {-2.0, -2.0, 0.0}, .resolution_m = 0.2, .size = {20, 70, 15}};
  grid->grown = BitGrid(grid->geometry.size, true);
  for (int z = 0; 0.2 * z < table_m - 0.1; ++z) {
    for (int y = 50; y < 70; ++y) grid->grown.set_run(0, 20, y, z, true);
  }
  return grid;
}

struct Flight {
  explicit Flight(const Config& tracker = {}, const simulator::Config& vehicle = anywhere())
      : loop(tracker, vehicle) {
    EXPECT_TRUE(loop.vehicle.reset({0, 0, 1}, 0.0));
    loop.run_until(kSecond / 2);
    EXPECT_TRUE(loop.tracker.accept(ten_metres(), loop.vehicle.time_ns()));
    loop.run_until(kSecond + 4'687'000'000);
    EXPECT_NEAR(loop.vehicle.state().velocity_map.y(), 2.0, 0.02);
  }
  ClosedLoop loop;
};

TEST(FailuresInFlight, WithoutTheTrackerOrAFallbackStopTheVehicleBrakesStraightAhead) {
  simulator::Config vehicle = anywhere();
  vehicle.fallback_tolerance_m = 0.0;
  Flight flight({}, vehicle);
  auto& loop = flight.loop;
  const Vec3 lost_at = loop.vehicle.state().position_map;
  loop.connected = false;
  loop.run_until(loop.vehicle.time_ns() + 3 * kSecond, [&] {
    const Vec3 p = loop.vehicle.state().position_map - lost_at;
    EXPECT_LT(p.y(), 0.7);  // 0.1 s of the last command, then the braking
    EXPECT_LT(std::hypot(p.x(), p.z()), 0.08);
  });
  EXPECT_EQ(loop.vehicle.control(), simulator::Control::failsafe);
  EXPECT_LT(loop.vehicle.state().velocity_map.norm(), 0.01);
}

TEST(FailuresInFlight, ATrackerThatComesBackLateStopsOnThePathAndReportsIt) {
  Flight flight;
  auto& loop = flight.loop;
  loop.connected = false;
  loop.run_until(loop.vehicle.time_ns() + kSecond);
  loop.connected = true;
  loop.run_until(loop.vehicle.time_ns() + 5 * kSecond, [&] {
    EXPECT_LT(std::abs(loop.vehicle.state().position_map.x()), 0.05);
    EXPECT_LT(std::abs(loop.vehicle.state().position_map.z() - 1.0), 0.08);
  });
  const auto status = loop.tracker.status();
  EXPECT_EQ(status.mode, Mode::hold);
  EXPECT_EQ(status.fault.code, ErrorCode::tracking_lost);
  EXPECT_LT(status.error_m, 0.02);
  EXPECT_EQ(loop.vehicle.control(), simulator::Control::commanded);
}

TEST(FailuresInFlight, AGapInOdometryShorterThanItsTimeoutIsFlownThrough) {
  Flight flight;
  auto& loop = flight.loop;
  loop.connected = false;
  loop.run_until(loop.vehicle.time_ns() + 80'000'000);
  loop.connected = true;
  loop.run_until(12 * kSecond);
  EXPECT_EQ(loop.tracker.status().fault.code, ErrorCode::ok);
  EXPECT_LT((loop.vehicle.state().position_map - Vec3(0, 10, 1)).norm(), 0.01);
}

// Lost odometry: a code at once, though nothing comes in; the vehicle holds, and lands.
TEST(FailuresInFlight, WithoutOdometryTheTrackerSaysSoAndTheVehicleHoldsThenLands) {
  Flight flight;
  auto& loop = flight.loop;
  loop.connected = false;
  loop.run_until(loop.vehicle.time_ns() + 150'000'000);
  auto status = loop.tracker.status();
  EXPECT_EQ(status.fault.code, ErrorCode::tracking_lost);
  EXPECT_NE(status.fault.message.find("no valid odometry"), std::string::npos);
  EXPECT_EQ(status.lost_trajectory_id, 1U);
  EXPECT_EQ(status.mode, Mode::brake);
  loop.run_until(loop.vehicle.time_ns() + 5 * kSecond);
  const Vec3 held = loop.vehicle.state().position_map;
  EXPECT_EQ(loop.vehicle.control(), simulator::Control::failsafe);
  EXPECT_LT(loop.vehicle.state().velocity_map.norm(), 0.01);
  EXPECT_NEAR(held.z(), 1.0, 0.05);
  loop.run_until(loop.vehicle.time_ns() + 12 * kSecond);
  EXPECT_EQ(loop.vehicle.control(), simulator::Control::landing);
  const Vec3 landed = loop.vehicle.state().position_map;
  EXPECT_NEAR(landed.z(), 0.1, 0.02);
  EXPECT_LT((landed - held).head<2>().norm(), 0.02);
}

TEST(FailuresInFlight, OdometryThatIsNotANumberIsLostOdometry) {
  Flight flight;
  auto& loop = flight.loop;
  loop.link.spoil = [](RigidBodyState& state) { state.velocity_map.y() = std::nan(""); };
  loop.run_until(loop.vehicle.time_ns() + kSecond, [&] {
    EXPECT_TRUE(loop.vehicle.state().is_finite());
    EXPECT_LT(std::abs(loop.vehicle.state().position_map.x()), 0.02);
  });
  EXPECT_EQ(loop.last_error.code, ErrorCode::invalid_input);
  EXPECT_EQ(loop.tracker.status().fault.code, ErrorCode::tracking_lost);
  EXPECT_EQ(loop.vehicle.control(), simulator::Control::failsafe);
}

// The coordinates shift by a metre while the vehicle flies at 2 m/s: it stops within what braking
// takes, on the line it was on, and does not chase the shift.
TEST(FailuresInFlight, OdometryThatJumpsStopsTheVehicleWhereItIs) {
  Flight flight;
  auto& loop = flight.loop;
  const Vec3 here = loop.vehicle.state().position_map;
  loop.link.spoil = [](RigidBodyState& state) { state.position_map += Vec3(1, 0, 0.5); };
  loop.run_until(loop.vehicle.time_ns() + 4 * kSecond, [&] {
    const Vec3 p = loop.vehicle.state().position_map - here;
    EXPECT_LT(p.y(), 0.8);
    EXPECT_LT(std::hypot(p.x(), p.z()), 0.1);
  });
  const auto status = loop.tracker.status();
  EXPECT_EQ(status.fault.code, ErrorCode::tracking_lost);
  EXPECT_NE(status.fault.message.find("jumped"), std::string::npos);
  EXPECT_EQ(status.lost_trajectory_id, 1U);
  EXPECT_EQ(status.mode, Mode::hold);
  EXPECT_LT(loop.vehicle.state().velocity_map.norm(), 0.01);
}

// Gales that no allowance covers: the reference starts again from where the vehicle is, and ends at
// rest on the certified line. The navigator is told which trajectory is lost.
TEST(FailuresInFlight, AnErrorBeyondTheAllowanceIsReportedAndStopsFromWhereTheVehicleIs) {
  simulator::Config vehicle;
  vehicle.gust_deviation_m_s = 3.0;
  vehicle.gust_time_s = 0.7;
  int lost = 0;
  for (int seed = 1; seed <= 20; ++seed) {
    vehicle.gust_seed = seed;
    ClosedLoop loop(Config{}, vehicle);
    ASSERT_TRUE(loop.vehicle.reset({0, 0, 1}, 0.0));
    loop.run_until(kSecond - 20'000'000);
    ASSERT_TRUE(loop.tracker.accept(ten_metres(), loop.vehicle.time_ns()));
    double worst_m = 0.0;
    loop.run_until(12 * kSecond, [&] {
      const auto status = loop.tracker.status();
      if (status.mode == Mode::brake) {
        const Vec3 off = status.reference.position - Vec3(0, status.reference.position.y(), 1);
        EXPECT_LT(off.norm(), 0.08);
      }
      if (status.mode != Mode::hold) worst_m = std::max(worst_m, status.error_m);
    });
    const auto status = loop.tracker.status();
    if (status.lost_trajectory_id == 0) continue;
    ++lost;
    EXPECT_EQ(status.lost_trajectory_id, 1U);
    EXPECT_EQ(status.mode, Mode::hold);
    EXPECT_LT((status.reference.position - Vec3(0, status.reference.position.y(), 1)).norm(), 0.01);
    EXPECT_GT(worst_m, 0.05);
    EXPECT_LT(worst_m, 0.12);
  }
  EXPECT_GE(lost, 5);
}

// Lost setpoints: what is committed is flown, then held, then landed from; each with its code.
TEST(FailuresInFlight, WithoutTheNavigatorTheEndIsHeldThenLandedFrom) {
  Flight flight;
  auto& loop = flight.loop;
  loop.tracker.heard_navigator(loop.vehicle.time_ns());
  loop.run_until(loop.vehicle.time_ns() + 2'100'000'000);
  EXPECT_EQ(loop.tracker.status().mode, Mode::follow);
  EXPECT_EQ(loop.tracker.status().fault.code, ErrorCode::stage_silent);
  loop.run_until(12 * kSecond);
  EXPECT_EQ(loop.tracker.status().mode, Mode::hold);
  EXPECT_LT((loop.vehicle.state().position_map - Vec3(0, 10, 1)).norm(), 0.01);
  loop.tracker.set_map(room(0.0), loop.vehicle.time_ns());
  loop.run_until(22 * kSecond);
  EXPECT_EQ(loop.tracker.status().mode, Mode::land);
  EXPECT_NE(loop.tracker.status().fault.message.find("landing"), std::string::npos);
  // Back in the middle of the descent: it stops there, and takes a new trajectory.
  loop.tracker.heard_navigator(loop.vehicle.time_ns());
  loop.run_until(25 * kSecond);
  const Vec3 here = loop.vehicle.state().position_map;
  EXPECT_EQ(loop.tracker.status().mode, Mode::hold);
  EXPECT_EQ(loop.tracker.status().fault.code, ErrorCode::stage_silent);  // silent again
  EXPECT_GT(here.z(), 0.2);
  EXPECT_LT(here.z(), 0.9);
  loop.run_until(45 * kSecond);
  EXPECT_EQ(loop.tracker.status().mode, Mode::land);
  EXPECT_LT((loop.vehicle.state().position_map - Vec3(0, 10, 0.1)).norm(), 0.02);
}

TEST(FailuresInFlight, OverAnObstacleItHoldsAndSaysWhyUntilAMapShowsTheWayDownFree) {
  Flight flight;
  auto& loop = flight.loop;
  loop.tracker.heard_navigator(loop.vehicle.time_ns());
  const auto holds_because = [&](ErrorCode code, double height_m) {
    const auto status = loop.tracker.status();
    EXPECT_EQ(status.mode, Mode::hold);
    EXPECT_EQ(status.fault.code, code) << status.fault.message;
    EXPECT_NE(status.fault.message.find("instead of landing"), std::string::npos);
    EXPECT_LT((loop.vehicle.state().position_map - Vec3(0, 10, height_m)).norm(), 0.02);
  };
  loop.run_until(25 * kSecond);
  holds_because(ErrorCode::no_map, 1.0);
  loop.tracker.set_map(room(0.6), loop.vehicle.time_ns());
  loop.run_until(30 * kSecond);
  holds_because(ErrorCode::goal_occupied, 1.0);
  loop.tracker.set_map(room(0.0), loop.vehicle.time_ns());
  loop.run_until(32 * kSecond);
  EXPECT_EQ(loop.tracker.status().mode, Mode::land);
  // Someone pushes a table below it: it stops on its way down.
  loop.tracker.set_map(room(0.4), loop.vehicle.time_ns());
  const double height_m = loop.vehicle.state().position_map.z();
  EXPECT_LT(height_m, 0.95);
  EXPECT_GT(height_m, 0.6);
  loop.run_until(34 * kSecond);
  const double held_m = loop.vehicle.state().position_map.z();
  EXPECT_GT(held_m, height_m - 0.15);
  loop.run_until(50 * kSecond);
  holds_because(ErrorCode::goal_occupied, held_m);
  loop.tracker.heard_navigator(loop.vehicle.time_ns());
  EXPECT_EQ(loop.tracker.status().fault.code, ErrorCode::ok);
}

TEST(FailuresInFlight, TheRuleOfLandingIsAsConfigured) {
  for (const LandingRule rule : {LandingRule::anywhere, LandingRule::never}) {
    Config config;
    config.landing = rule;
    Flight flight(config);
    auto& loop = flight.loop;
    loop.tracker.heard_navigator(loop.vehicle.time_ns());
    loop.run_until(40 * kSecond);
    const auto status = loop.tracker.status();
    EXPECT_EQ(status.mode, rule == LandingRule::never ? Mode::hold : Mode::land);
    EXPECT_EQ(status.fault.code,
              rule == LandingRule::never ? ErrorCode::cancelled : ErrorCode::stage_silent);
    EXPECT_NEAR(loop.vehicle.state().position_map.z(), rule == LandingRule::never ? 1.0 : 0.1,
                0.02);
  }
}

TEST(FailuresInFlight, ATrackerThatNeverHeardANavigatorNeverLands) {
  Flight flight;
  auto& loop = flight.loop;
  loop.run_until(60 * kSecond);
  EXPECT_EQ(loop.tracker.status().mode, Mode::hold);
  EXPECT_LT((loop.vehicle.state().position_map - Vec3(0, 10, 1)).norm(), 0.01);
}

TEST(FailuresInFlight, AReplanInFlightIsFlownWithoutAStep) {
  Flight flight;
  auto& loop = flight.loop;
  const auto first = ten_metres();
  Draft second;
  second.id = 2;
  second.start_time_ns = kSecond + 5 * kSecond;
  second.trajectory.pieces = {
      BezierPiece::between(first.trajectory.sample(5.0), {.position = {2, 8, 1.5}}, 4.0)};
  certify_as_is(second);
  ASSERT_TRUE(loop.tracker.accept(second, loop.vehicle.time_ns()));
  loop.run_until(12 * kSecond);
  const auto status = loop.tracker.status();
  EXPECT_EQ(status.trajectory_id, 2U);
  EXPECT_LT(status.max_error_m, 0.06);
  EXPECT_LT((loop.vehicle.state().position_map - Vec3(2, 8, 1.5)).norm(), 0.01);
}

TEST(FailuresInFlight, BrakingOnDemandStaysOnThePath) {
  Flight flight;
  auto& loop = flight.loop;
  const double begin = loop.vehicle.state().position_map.y();
  loop.tracker.brake(loop.vehicle.time_ns());
  loop.run_until(loop.vehicle.time_ns() + 3 * kSecond,
                 [&] { EXPECT_LT(std::abs(loop.vehicle.state().position_map.x()), 0.02); });
  EXPECT_NEAR(loop.vehicle.state().position_map.y() - begin, 1.5, 0.05);  // 3/4 v^2 / a
  EXPECT_EQ(loop.tracker.status().mode, Mode::hold);
}

}  // namespace
}  // namespace goshawk::tracker
