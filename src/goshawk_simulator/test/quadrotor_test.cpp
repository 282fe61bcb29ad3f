#include "goshawk/simulator/quadrotor.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>

namespace goshawk::simulator {
namespace {

Quadrotor make(const Config& config = {}) {
  auto quadrotor = Quadrotor::create(config);
  EXPECT_TRUE(quadrotor);
  return std::move(quadrotor).value();
}

void advance(Quadrotor& quadrotor, double dt_s) {
  ASSERT_TRUE(quadrotor.advance(dt_s));
}

AttitudeSetpoint hover(const Quadrotor& quadrotor) {
  return {.thrust_n = quadrotor.config().vehicle.weight_n()};
}

double tilt_rad(const Quadrotor& quadrotor) {
  return std::acos(std::min(1.0, (quadrotor.state().q_map_base * Vec3::UnitZ()).z()));
}

// Flies at the given velocity by commands alone, long enough to have reached it.
void fly_at(Quadrotor& quadrotor, const Vec3& velocity) {
  for (int i = 0; i < 2000; ++i) {
    const auto& s = quadrotor.state();
    const Vec3 drag =
        Vec3(0.25, 0.25, 0.15).cwiseProduct(velocity) + 0.02 * velocity.norm() * velocity;
    const Vec3 force = quadrotor.config().vehicle.mass_kg *
                           (3.0 * (velocity - s.velocity_map) + Vec3(0, 0, kGravity_m_s2)) +
                       drag;
    AttitudeSetpoint command;
    command.thrust_n = force.norm();
    command.q_map_base = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), force);
    ASSERT_TRUE(quadrotor.command(command));
    advance(quadrotor, 0.004);
  }
  ASSERT_LT((quadrotor.state().velocity_map - velocity).norm(), 0.01);
}

TEST(Quadrotor, HoversFromTheStartWhereItWasReset) {
  auto quadrotor = make();
  ASSERT_TRUE(quadrotor.reset({3.0, 0.0, 1.0}, 0.7));
  EXPECT_NEAR(quadrotor.rotor_thrust_n().sum(), quadrotor.config().vehicle.weight_n(), 1e-12);
  advance(quadrotor, 5.0);
  EXPECT_LT((quadrotor.state().position_map - Vec3(3, 0, 1)).norm(), 1e-9);
  EXPECT_NEAR(yaw_of(quadrotor.state().q_map_base), 0.7, 1e-9);
  EXPECT_LT(quadrotor.acceleration_map().norm(), 1e-9);
  EXPECT_EQ(quadrotor.control(), Control::failsafe);
}

TEST(Quadrotor, TakesTheCommandedAttitudeAndThrust) {
  auto quadrotor = make();
  AttitudeSetpoint command{.thrust_n = 12.0};
  command.q_map_base =
      Eigen::AngleAxisd(0.5, Vec3::UnitY()) * Eigen::AngleAxisd(0.3, Vec3::UnitX());
  for (int i = 0; i < 250; ++i) {
    ASSERT_TRUE(quadrotor.command(command));
    advance(quadrotor, 0.004);
  }
  EXPECT_LT(quadrotor.state().q_map_base.angularDistance(command.q_map_base), 0.01);
  EXPECT_NEAR(quadrotor.rotor_thrust_n().sum(), 12.0, 0.01);
  EXPECT_EQ(quadrotor.control(), Control::commanded);
}

TEST(Quadrotor, AttitudeStepOfThirtyDegreesSettlesWithLittleOvershoot) {
  auto quadrotor = make();
  AttitudeSetpoint command = hover(quadrotor);
  const double angle = std::numbers::pi / 6.0;
  command.q_map_base = Eigen::AngleAxisd(angle, Vec3::UnitX());
  double peak = 0.0;
  for (int i = 0; i < 500; ++i) {
    ASSERT_TRUE(quadrotor.command(command));
    advance(quadrotor, 0.001);
    peak = std::max(peak, tilt_rad(quadrotor));
    if (i > 350) {
      EXPECT_NEAR(tilt_rad(quadrotor), angle, 0.05 * angle);
    }
  }
  EXPECT_LT(peak, 1.2 * angle);
}

TEST(Quadrotor, RecoversFromUpsideDown) {
  auto quadrotor = make();
  AttitudeSetpoint command = hover(quadrotor);
  command.q_map_base = Eigen::AngleAxisd(std::numbers::pi * 0.999, Vec3::UnitX());
  for (int i = 0; i < 300; ++i) {
    ASSERT_TRUE(quadrotor.command(command));
    advance(quadrotor, 0.004);
  }
  ASSERT_GT(tilt_rad(quadrotor), 2.8);
  for (int i = 0; i < 300; ++i) {
    ASSERT_TRUE(quadrotor.command(hover(quadrotor)));
    advance(quadrotor, 0.004);
  }
  EXPECT_LT(tilt_rad(quadrotor), 0.02);
}

TEST(Quadrotor, WithoutCommandsItBrakesFromTwoMetresASecondWithinHalfAMetre) {
  auto quadrotor = make();
  fly_at(quadrotor, {2.0, 0, 0});
  const Vec3 last_command = quadrotor.state().position_map;
  while (quadrotor.control() == Control::commanded) advance(quadrotor, 0.001);
  EXPECT_NEAR(double(quadrotor.time_ns()) * 1e-9, 7.996 + 0.1 + 0.001, 1e-9);
  const Vec3 onset = quadrotor.state().position_map;
  double farthest = 0.0, farthest_of_all = 0.0, lowest = 0.0, steepest = 0.0;
  for (int i = 0; i < 5000; ++i) {
    advance(quadrotor, 0.001);
    const Vec3 p = quadrotor.state().position_map;
    farthest = std::max(farthest, (p - onset).head<2>().norm());
    farthest_of_all = std::max(farthest_of_all, (p - last_command).head<2>().norm());
    lowest = std::min(lowest, p.z() - onset.z());
    steepest = std::max(steepest, tilt_rad(quadrotor));
  }
  RecordProperty("braking_distance_m", std::to_string(farthest));
  RecordProperty("distance_since_last_command_m", std::to_string(farthest_of_all));
  EXPECT_LT(farthest, 0.5);
  EXPECT_LT(farthest_of_all, 0.7);
  EXPECT_GT(lowest, -0.05);
  EXPECT_LT(steepest, 1.25);
  EXPECT_LT(quadrotor.state().velocity_map.norm(), 0.01);
  EXPECT_EQ(quadrotor.control(), Control::failsafe);

  ASSERT_TRUE(quadrotor.command(hover(quadrotor)));
  EXPECT_EQ(quadrotor.control(), Control::commanded);
}

TEST(Quadrotor, BrakesInHalfAMetreWhereverItWasHeaded) {
  for (const Vec3& direction : {Vec3(-1, 0, 0), Vec3(0, 1, 0), Vec3(1, 1, 0), Vec3(0, 0, 1),
                                Vec3(0, 0, -1), Vec3(1, -1, 1), Vec3(-1, 0, -1)}) {
    auto quadrotor = make();
    fly_at(quadrotor, 2.0 * direction.normalized());
    while (quadrotor.control() == Control::commanded) advance(quadrotor, 0.001);
    const Vec3 onset = quadrotor.state().position_map;
    double farthest = 0.0;
    for (int i = 0; i < 3000; ++i) {
      advance(quadrotor, 0.001);
      farthest = std::max(farthest, (quadrotor.state().position_map - onset).norm());
    }
    EXPECT_LT(farthest, 0.5) << to_text(direction);
    EXPECT_LT(quadrotor.state().velocity_map.norm(), 0.02) << to_text(direction);
  }
}

TEST(Quadrotor, BadCommandsAreRefusedAndTheTimeoutRunsOn) {
  auto quadrotor = make();
  const double nan = std::nan("");
  std::vector<AttitudeSetpoint> bad(7, hover(quadrotor));
  bad[0].thrust_n = nan;
  bad[1].thrust_n = -0.1;
  bad[2].thrust_n = std::numeric_limits<double>::infinity();
  bad[3].q_map_base.coeffs().setZero();
  bad[4].q_map_base.x() = nan;
  bad[5].angular_velocity_base.y() = nan;
  bad[6].angular_velocity_base.z() = 1e300;
  for (const auto& command : bad) {
    EXPECT_EQ(quadrotor.command(command).code(), ErrorCode::invalid_input);
  }
  ASSERT_TRUE(quadrotor.command(hover(quadrotor)));
  for (int i = 0; i < 40; ++i) {
    EXPECT_EQ(quadrotor.control(), i * 4 <= 100 ? Control::commanded : Control::failsafe) << i;
    EXPECT_FALSE(quadrotor.command(bad[std::size_t(i) % bad.size()]));
    advance(quadrotor, 0.004);
  }
  EXPECT_LT(quadrotor.state().velocity_map.norm(), 1e-6);
}

TEST(Quadrotor, TheHardestCommandsLeaveTheStateFinite) {
  Config config;
  config.gust_deviation_m_s = 5.0;
  auto quadrotor = make(config);
  Random random(3);
  for (int i = 0; i < 2000; ++i) {
    AttitudeSetpoint command{.thrust_n = random.uniform() < 0.1 ? 1e300 : random.uniform(0, 40)};
    command.q_map_base = Eigen::Quaterniond(random.uniform(-1, 1), random.uniform(-1, 1),
                                            random.uniform(-1, 1), random.uniform(-1, 1));
    command.q_map_base.normalize();
    command.angular_velocity_base =
        Vec3(random.uniform(-50, 50), random.uniform(-50, 50), random.uniform(-50, 50));
    ASSERT_TRUE(quadrotor.command(command));
    advance(quadrotor, 0.005);
    ASSERT_TRUE(quadrotor.state().is_finite());
  }
}

TEST(Quadrotor, PartsOfAStepAddUpInWholeNanoseconds) {
  auto quadrotor = make();
  for (int i = 0; i < 1000; ++i) advance(quadrotor, 0.0004);
  EXPECT_EQ(quadrotor.time_ns(), 400'000'000);
  for (int i = 0; i < 3; ++i) advance(quadrotor, 1.0 / 3.0);
  EXPECT_EQ(quadrotor.time_ns(), 1'399'000'000);  // 3 x 333333333 ns: one short of a step
  advance(quadrotor, 1e-9);
  EXPECT_EQ(quadrotor.time_ns(), 1'400'000'000);
}

TEST(Quadrotor, TimeThatIsNotATimeStepIsRefused) {
  auto quadrotor = make();
  for (const double dt : {-0.001, std::nan(""), 1e9, std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(quadrotor.advance(dt).code(), ErrorCode::invalid_input);
  }
  EXPECT_EQ(quadrotor.time_ns(), 0);
  EXPECT_EQ(quadrotor.reset({0, std::nan(""), 0}, 0).code(), ErrorCode::invalid_input);
  EXPECT_EQ(quadrotor.reset({0, 0, 0}, std::nan("")).code(), ErrorCode::invalid_input);
}

TEST(Quadrotor, TheSameCallsGiveTheSameBits) {
  Config config;
  config.wind_x_m_s = 2.0;
  config.gust_deviation_m_s = 1.0;
  auto a = make(config), b = make(config);
  for (int i = 0; i < 500; ++i) {
    AttitudeSetpoint command = hover(a);
    command.q_map_base = Eigen::AngleAxisd(0.1 * std::sin(0.05 * i), Vec3::UnitX());
    ASSERT_TRUE(a.command(command));
    ASSERT_TRUE(b.command(command));
    advance(a, 0.004);
    for (int k = 0; k < 4; ++k) advance(b, 0.001);  // the same time in other parts
    ASSERT_EQ(std::memcmp(a.state().position_map.data(), b.state().position_map.data(), 24), 0);
    ASSERT_EQ(a.state().q_map_base.coeffs(), b.state().q_map_base.coeffs());
  }
}

TEST(Quadrotor, HoldsItsPositionByItselfInAModerateWind) {
  Config config;
  config.wind_y_m_s = 3.0;
  auto quadrotor = make(config);
  advance(quadrotor, 10.0);
  EXPECT_LT(quadrotor.state().position_map.norm(), 0.01);
  EXPECT_LT(quadrotor.state().velocity_map.norm(), 1e-3);
}

// Commands stop in a wind that was flown in for a while: what the margin covers is not left.
TEST(Quadrotor, AFailsafeInWindIsNotBlownAway) {
  for (const double wind : {-3.0, 3.0}) {
    Config config;
    config.wind_y_m_s = wind;
    config.landing = LandingRule::never;
    auto quadrotor = make(config);
    advance(quadrotor, 10.0);
    const AttitudeSetpoint balance{.thrust_n = quadrotor.rotor_thrust_n().sum(),
                                   .q_map_base = quadrotor.state().q_map_base};
    const Vec3 place = quadrotor.state().position_map;
    ASSERT_TRUE(quadrotor.command(balance));
    for (int i = 0; i < 100; ++i) {
      advance(quadrotor, 0.1);
      EXPECT_LT((quadrotor.state().position_map - place).norm(), 0.02);
    }
    EXPECT_EQ(quadrotor.control(), Control::failsafe);
  }
}

TEST(Quadrotor, WithoutCommandsItHoldsThenLandsStraightDown) {
  Config config;
  config.failsafe_hold_s = 3.0;
  config.landing = LandingRule::anywhere;
  auto quadrotor = make(config);
  ASSERT_TRUE(quadrotor.reset({1, 2, 1.5}, 0.0));
  advance(quadrotor, 20.0);
  EXPECT_EQ(quadrotor.control(), Control::failsafe);  // nobody ever commanded: it only hovers
  EXPECT_NEAR(quadrotor.state().position_map.z(), 1.5, 1e-6);
  ASSERT_TRUE(quadrotor.command(hover(quadrotor)));
  advance(quadrotor, 3.0);
  EXPECT_EQ(quadrotor.control(), Control::failsafe);
  EXPECT_NEAR(quadrotor.state().position_map.z(), 1.5, 0.01);
  for (int i = 0; i < 100; ++i) {
    advance(quadrotor, 0.1);
    EXPECT_LT((quadrotor.state().position_map - Vec3(1, 2, 0)).head<2>().norm(), 0.01);
    EXPECT_GT(quadrotor.state().velocity_map.z(), -config.land_speed_m_s - 0.02);
  }
  EXPECT_EQ(quadrotor.control(), Control::landing);
  EXPECT_NEAR(quadrotor.state().position_map.z(), config.land_height_m, 0.01);
  ASSERT_TRUE(quadrotor.command(hover(quadrotor)));  // commands take it back
  EXPECT_EQ(quadrotor.control(), Control::commanded);
}

// 3 x 3 x 3 m of 0.1 m with something wide, whose top is at table_m; 0: an empty room.
std::shared_ptr<VoxelGrid> room(double table_m) {
  auto grid = std::make_shared<VoxelGrid>();
  grid->geometry = {.origin_map = Vec3::Zero(), .resolution_m = 0.1, .size = {30, 30, 30}};
  grid->grown = BitGrid(grid->geometry.size, true);
  for (int z = 0; 0.1 * z < table_m - 0.05; ++z) {
    for (int y = 0; y < 30; ++y) grid->grown.set_run(5, 20, y, z, true);
  }
  return grid;
}

TEST(Quadrotor, LandsOnlyWhereTheMapShowsTheWayDownFree) {
  Config config;
  config.failsafe_hold_s = 1.0;
  auto quadrotor = make(config);
  ASSERT_TRUE(quadrotor.reset({1.03, 2, 1.5}, 0.0));
  EXPECT_FALSE(quadrotor.needs_map());
  ASSERT_TRUE(quadrotor.command(hover(quadrotor)));
  advance(quadrotor, 0.2);
  EXPECT_TRUE(quadrotor.needs_map());
  const auto holds_because = [&](ErrorCode code, double height_m) {
    EXPECT_EQ(quadrotor.control(), Control::failsafe);
    EXPECT_EQ(quadrotor.not_landing().code, code) << quadrotor.not_landing().message;
    EXPECT_NEAR(quadrotor.state().position_map.z(), height_m, 0.05);
  };
  advance(quadrotor, 5.0);
  holds_because(ErrorCode::no_map, 1.5);
  quadrotor.set_map(room(0.7));
  EXPECT_FALSE(quadrotor.needs_map());
  advance(quadrotor, 5.0);
  holds_because(ErrorCode::goal_occupied, 1.5);

  quadrotor.set_map(room(0.0));
  advance(quadrotor, 2.0);
  EXPECT_EQ(quadrotor.control(), Control::landing);
  EXPECT_EQ(quadrotor.not_landing().code, ErrorCode::ok);
  const double height = quadrotor.state().position_map.z();
  EXPECT_LT(height, 1.3);
  quadrotor.set_map(room(0.4));  // someone pushes a table below it
  advance(quadrotor, 5.0);
  holds_because(ErrorCode::goal_occupied, height);

  quadrotor.set_map(room(0.0));
  advance(quadrotor, 10.0);
  EXPECT_NEAR(quadrotor.state().position_map.z(), config.land_height_m, 0.01);
  quadrotor.set_map(room(1.0));  // down is down
  EXPECT_EQ(quadrotor.control(), Control::landing);
}

TEST(Quadrotor, TheWindMayChangeInFlightAndNothingElse) {
  Config config;
  auto quadrotor = Quadrotor::create(config).value();
  config.wind_x_m_s = 3.0;
  ASSERT_TRUE(quadrotor.reconfigure(config));
  EXPECT_EQ(quadrotor.wind_map(), Vec3(3, 0, 0));
  Config other = config;
  other.vehicle.mass_kg = 1.1;
  EXPECT_EQ(quadrotor.reconfigure(other).code(), ErrorCode::invalid_parameter);
  other = config;
  other.wind_x_m_s = 31.0;
  EXPECT_EQ(quadrotor.reconfigure(other).code(), ErrorCode::invalid_parameter);
  EXPECT_EQ(quadrotor.wind_map(), Vec3(3, 0, 0));
}

}  // namespace
}  // namespace goshawk::simulator
