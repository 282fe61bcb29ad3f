#include "closed_loop.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "goshawk/core/flatness.hpp"
#include "trajectories.hpp"

namespace goshawk::tracker {
namespace {

struct Worst {
  double rms_m = 0.0;
  double max_m = 0.0;
  double final_m = 0.0;
  int failsafe_ms = 0;
};

// Twenty random flights, and as many winds; the first two seconds are for the wind to be learnt.
Worst fly_many(
    const Config& config, const simulator::Config& vehicle,
    const std::function<Link(Random&)>& link = [](Random&) { return Link{}; }) {
  Worst worst;
  for (std::uint64_t seed = 1; seed <= 20; ++seed) {
    Random random(seed), link_random(1000 + seed);
    auto windy = vehicle;
    windy.gust_seed = windy.sensor.seed = int(seed);
    ClosedLoop loop(config, windy, link(link_random));
    EXPECT_TRUE(loop.vehicle.reset({3, 0, 1}, 0.0));
    loop.run_until(2 * kSecond);
    const int before = loop.failsafe_ms;
    auto committed = random_trajectory(random, {3, 0, 1}, 5, 2.0, 2.0);
    committed.start_time_ns = 2 * kSecond;
    const auto errors = loop.fly(committed);
    worst.rms_m = std::max(worst.rms_m, errors.rms_m);
    worst.max_m = std::max(worst.max_m, errors.max_m);
    worst.final_m = std::max(worst.final_m, errors.final_m);
    worst.failsafe_ms = std::max(worst.failsafe_ms, loop.failsafe_ms - before);
    EXPECT_EQ(loop.tracker.status().mode, Mode::hold);
    EXPECT_EQ(loop.tracker.status().fault.code, ErrorCode::ok);
  }
  testing::Test::RecordProperty("worst_rms_m", std::to_string(worst.rms_m));
  testing::Test::RecordProperty("worst_max_m", std::to_string(worst.max_m));
  return worst;
}

class ClosedLoopTest : public testing::TestWithParam<const char*> {
 protected:
  Config config_ = config_for(GetParam());
  simulator::Config vehicle_;
};

TEST_P(ClosedLoopTest, TracksWithinTwoCentimetresRmsAndSixAtMost) {
  const auto worst = fly_many(config_, vehicle_);
  EXPECT_LT(worst.rms_m, 0.02);
  EXPECT_LT(worst.max_m, 0.06);
  EXPECT_LT(worst.final_m, 0.01);
  EXPECT_EQ(worst.failsafe_ms, 0);
}

TEST_P(ClosedLoopTest, JitterDelaysAndDroppedCommandsCostLittle) {
  const auto worst = fly_many(config_, vehicle_, [](Random& random) {
    Link link;
    link.gap_ns = [&random] { return std::int64_t(random.below(31)) * 1'000'000; };  // 0 to 30 ms
    link.drop = [&random] { return random.chance(0.2); };
    link.odometry_delay_ns = 5'000'000;
    link.command_delay_ns = 15'000'000;
    return link;
  });
  EXPECT_LT(worst.rms_m, 0.02);
  EXPECT_LT(worst.max_m, 0.06);
}

TEST_P(ClosedLoopTest, InWindAndGustsTheErrorStaysBelowTenCentimetres) {
  vehicle_.wind_x_m_s = 3.0;
  vehicle_.gust_deviation_m_s = 1.0;
  const auto worst = fly_many(config_, vehicle_);
  EXPECT_LT(worst.rms_m, 0.05);
  EXPECT_LT(worst.max_m, 0.10);
}

TEST_P(ClosedLoopTest, InGustsOfThreeMetresASecondTheErrorStaysBelowTenCentimetres) {
  config_.error_allowance_m = 0.10;
  vehicle_.gust_deviation_m_s = 1.5;  // peaks of 3 m/s and more, from all sides
  const auto worst = fly_many(config_, vehicle_);
  EXPECT_LT(worst.rms_m, 0.05);
  EXPECT_LT(worst.max_m, 0.10);
}

TEST_P(ClosedLoopTest, TurnsAlongACurveOfYaw) {
  ClosedLoop loop(config_, vehicle_);
  ASSERT_TRUE(loop.vehicle.reset({3, 0, 1}, 0.0));
  loop.run_until(kSecond);
  auto committed = straight_line({3, 0, 1}, {3, 6, 2}, 6.0);
  committed.start_time_ns = loop.vehicle.time_ns();
  committed.yaw_curve = YawCurve{.step_s = 0.05, .points_rad = {}};
  for (int k = -1; k <= 120; ++k) {  // to and fro, at 0.8 rad/s at the most
    committed.yaw_curve->points_rad.push_back(0.8 * (1.0 - std::cos(0.05 * std::max(k, 0))));
  }
  ASSERT_TRUE(loop.tracker.accept(committed, loop.vehicle.time_ns()));
  double worst = 0.0;
  loop.run_until(committed.start_time_ns + 6 * kSecond, [&] {
    const double t = double(loop.vehicle.time_ns() - committed.start_time_ns) * 1e-9;
    worst = std::max(
        worst, std::abs(yaw_of(loop.vehicle.state().q_map_base) - committed.yaw_curve->yaw_rad(t)));
  });
  RecordProperty("worst_yaw_error_rad", std::to_string(worst));
  EXPECT_LT(worst, 0.05);
}

TEST_P(ClosedLoopTest, NoisyAndLateOdometryCostsLittle) {
  vehicle_.sensor = {.position_noise_m = 0.005,
                     .velocity_noise_m_s = 0.03,
                     .attitude_noise_rad = 0.005,
                     .body_rate_noise_rad_s = 0.02,
                     .delay_s = 0.02};
  const auto worst = fly_many(config_, vehicle_);
  EXPECT_LT(worst.rms_m, 0.03);
  EXPECT_LT(worst.max_m, 0.06);
}

double overshoot_m(const Config& config, const simulator::Config& vehicle, const Vec3& step) {
  ClosedLoop loop(config, vehicle);
  EXPECT_TRUE(loop.tracker.step(RigidBodyState{}, 0));
  EXPECT_TRUE(loop.vehicle.reset(step, 0.0));
  double overshoot = 0.0;
  loop.run_until(8 * kSecond, [&] {
    const Vec3 p = loop.vehicle.state().position_map;
    overshoot = std::max(overshoot, -p.dot(step.normalized()));
    if (loop.vehicle.time_ns() > 6 * kSecond) {
      EXPECT_LT(p.norm(), 0.03);
    }
  });
  return overshoot;
}

// Feedback, tilt and thrust are at their bounds for most of the way. A double integrator under
// bounded force overshoots by itself; what is learnt meanwhile must add nothing to that.
TEST_P(ClosedLoopTest, AStepOfFiveMetresSaturatesAndDoesNotWindUp) {
  config_.max_jump_m = config_.error_allowance_m = config_.max_position_error_m = 10.0;
  config_.max_tilt_rad = 0.4;
  config_.max_thrust_n = 13.0;
  auto plain = config_;
  plain.disturbance_bandwidth_rad_s = 0.0;
  for (const Vec3& step : {Vec3(5, 0, 0), Vec3(0, 0, -5), Vec3(3, -3, 3)}) {
    const double learning = overshoot_m(config_, vehicle_, step);
    EXPECT_LT(learning, overshoot_m(plain, vehicle_, step) + 0.1);
    EXPECT_LT(learning, 1.0);
    RecordProperty("overshoot_m", std::to_string(learning));
  }
}

// Whatever sent the vehicle that far off: it comes back, and no faster than its error is worth.
TEST_P(ClosedLoopTest, ALargeErrorIsCaughtUpWithSlowly) {
  config_.max_jump_m = config_.error_allowance_m = 10.0;
  ClosedLoop loop(config_, vehicle_);
  EXPECT_TRUE(loop.tracker.step(RigidBodyState{}, 0));
  EXPECT_TRUE(loop.vehicle.reset({4, 0, 0}, 0.0));
  double top_m_s = 0.0;
  loop.run_until(30 * kSecond,
                 [&] { top_m_s = std::max(top_m_s, loop.vehicle.state().velocity_map.norm()); });
  EXPECT_LT(top_m_s, 1.2 * config_.max_position_error_m * config_.position_xy_1_s2 /
                         config_.velocity_xy_1_s);
  EXPECT_LT(loop.vehicle.state().position_map.norm(), 0.01);
}

TEST_P(ClosedLoopTest, AVehicleHeavierThanConfiguredIsStillTracked) {
  vehicle_.vehicle.mass_kg = 1.1;
  const auto worst = fly_many(config_, vehicle_);
  EXPECT_LT(worst.rms_m, 0.03);
  EXPECT_LT(worst.final_m, 0.02);
}

TEST_P(ClosedLoopTest, AStepOfOneMetreSettlesWithoutMuchOvershoot) {
  config_.max_jump_m = config_.error_allowance_m = config_.max_position_error_m = 2.0;
  ClosedLoop loop(config_, vehicle_);
  RigidBodyState elsewhere;  // the tracker takes the origin as its place; the vehicle is 1 m away
  ASSERT_TRUE(loop.tracker.step(elsewhere, 0));
  ASSERT_TRUE(loop.vehicle.reset({1, 0, 0}, 0.0));
  double least = 1.0;
  loop.run_until(6 * kSecond, [&] {
    least = std::min(least, loop.vehicle.state().position_map.x());
    if (loop.vehicle.time_ns() > 4 * kSecond) {
      EXPECT_LT(loop.vehicle.state().position_map.norm(), 0.02);
    }
  });
  EXPECT_GT(least, -0.15);
  RecordProperty("overshoot_m", std::to_string(-least));
}

TEST_P(ClosedLoopTest, RecoversFromATiltOfThirtyDegrees) {
  ClosedLoop loop(config_, vehicle_);
  AttitudeSetpoint tilted{.thrust_n = vehicle_.vehicle.weight_n()};
  tilted.q_map_base = Eigen::AngleAxisd(0.5236, Vec3::UnitX());
  for (int i = 0; i < 300; ++i) {
    ASSERT_TRUE(loop.vehicle.command(tilted));
    ASSERT_TRUE(loop.vehicle.advance(0.001));
  }
  const double tilt =
      loop.vehicle.state().q_map_base.angularDistance(Eigen::Quaterniond::Identity());
  ASSERT_GT(tilt, 0.5);
  const Vec3 here = loop.vehicle.state().position_map;
  double farthest = 0.0;
  loop.run_until(5 * kSecond, [&] {
    farthest = std::max(farthest, (loop.vehicle.state().position_map - here).norm());
  });
  // It comes at 1.5 m/s, and the tracker has only just started: it holds where the stop ends, not
  // where the vehicle was.
  EXPECT_LT(farthest, 0.8);
  EXPECT_LT(loop.vehicle.state().velocity_map.norm(), 0.01);
  EXPECT_EQ(loop.tracker.status().mode, Mode::hold);
  EXPECT_LT(loop.tracker.status().error_m, 0.01);
}

TEST_P(ClosedLoopTest, TheSameFlightGivesTheSameBits) {
  vehicle_.gust_deviation_m_s = 0.5;
  std::vector<RigidBodyState> ends;
  for (int run = 0; run < 2; ++run) {
    Random random(4);
    ClosedLoop loop(config_, vehicle_);
    loop.run_until(kSecond);
    auto committed = random_trajectory(random, Vec3::Zero(), 4, 2.0, 2.0);
    committed.start_time_ns = kSecond;
    loop.fly(committed);
    ends.push_back(loop.vehicle.state());
  }
  EXPECT_EQ(ends[0].position_map, ends[1].position_map);
  EXPECT_EQ(ends[0].q_map_base.coeffs(), ends[1].q_map_base.coeffs());
}

INSTANTIATE_TEST_SUITE_P(Controllers, ClosedLoopTest, testing::Values("pd", "geometric"),
                         [](const auto& instance) { return std::string(instance.param); });

TEST(ClosedLoop, KnowingTheDragAndLearningTheWindBothPay) {
  Config config = config_for("pd");
  config.error_allowance_m = 1.0;  // without the observer it is not kept, and that is the point
  simulator::Config vehicle;
  vehicle.wind_x_m_s = 3.0;
  const auto with = fly_many(config, vehicle);
  config.disturbance_bandwidth_rad_s = 0.0;
  const auto without_observer = fly_many(config, vehicle);
  EXPECT_LT(with.rms_m, 0.3 * without_observer.rms_m);
  EXPECT_LT(without_observer.max_m, 0.3);  // bounded all the same

  vehicle.wind_x_m_s = 0.0;
  const auto with_drag = fly_many(config, vehicle);
  config.linear_drag_xy_kg_s = config.linear_drag_z_kg_s = 0.0;
  const auto without_drag = fly_many(config, vehicle);
  EXPECT_LT(with_drag.rms_m, 0.5 * without_drag.rms_m);
}

}  // namespace
}  // namespace goshawk::tracker
