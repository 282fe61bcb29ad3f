#include <gtest/gtest.h>

#include <cmath>

#include "closed_loop.hpp"
#include "trajectories.hpp"

namespace goshawk::tracker {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;

// Ten metres along y, with 2 m/s in the middle.
CommittedTrajectory ten_metres() {
  auto committed = straight_line({0, 0, 1}, {0, 10, 1}, 9.375);
  committed.start_time_ns = kSecond;
  return committed;
}

struct Flight {
  Flight() : loop(Config{}, simulator::Config{}) {
    EXPECT_TRUE(loop.vehicle.reset({0, 0, 1}, 0.0));
    loop.run_until(kSecond / 2);
    EXPECT_TRUE(loop.tracker.accept(ten_metres(), loop.vehicle.time_ns()));
    loop.run_until(kSecond + 4'687'000'000);
    EXPECT_NEAR(loop.vehicle.state().velocity_map.y(), 2.0, 0.02);
  }
  ClosedLoop loop;
};

TEST(FailuresInFlight, WithoutTheTrackerTheVehicleBrakesOnItsOwnAndOnItsLine) {
  Flight flight;
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

TEST(FailuresInFlight, ATrackerThatComesBackAtOnceFliesOn) {
  Flight flight;
  auto& loop = flight.loop;
  loop.connected = false;
  loop.run_until(loop.vehicle.time_ns() + 200'000'000);
  loop.connected = true;
  loop.run_until(12 * kSecond);
  EXPECT_EQ(loop.tracker.status().fault.code, ErrorCode::ok);
  EXPECT_LT((loop.vehicle.state().position_map - Vec3(0, 10, 1)).norm(), 0.01);
}

TEST(FailuresInFlight, AReplanInFlightIsFlownWithoutAStep) {
  Flight flight;
  auto& loop = flight.loop;
  const auto first = ten_metres();
  CommittedTrajectory second;
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
  EXPECT_NEAR(loop.vehicle.state().position_map.y() - begin, 1.0, 0.05);  // v^2 / 2a
  EXPECT_EQ(loop.tracker.status().mode, Mode::hold);
}

}  // namespace
}  // namespace goshawk::tracker
