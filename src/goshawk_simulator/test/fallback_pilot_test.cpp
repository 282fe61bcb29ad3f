#include "goshawk/simulator/fallback_pilot.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "goshawk/simulator/quadrotor.hpp"

namespace goshawk::simulator {
namespace {

constexpr double kSpeed_m_s = 2.0;
constexpr double kCurve_m = 1.6;  // radius

// From (0, 0, 2) along x: straight on, or on a circle to the left, and slower and slower to rest.
FallbackStop stop_along(bool turns, double duration_s) {
  FallbackStop stop{.step_s = 0.05, .states = {}};
  const int steps = int(std::lround(duration_s / stop.step_s));
  for (int i = 0; i <= steps; ++i) {
    const double x = double(i) / steps;
    const double way = kSpeed_m_s * duration_s * (x - x * x * x + x * x * x * x / 2.0);
    const double speed = kSpeed_m_s * (1.0 - 3.0 * x * x + 2.0 * x * x * x);
    const double growth = kSpeed_m_s * 6.0 * (x * x - x) / duration_s;
    const double angle = turns ? way / kCurve_m : 0.0;
    const Vec3 along(std::cos(angle), std::sin(angle), 0.0), left(-along.y(), along.x(), 0.0);
    const Vec3 place = turns ? Vec3(kCurve_m * std::sin(angle), kCurve_m * (1 - std::cos(angle)), 0)
                             : Vec3(way, 0, 0);
    stop.states.push_back({place + Vec3(0, 0, 2), speed * along,
                           growth * along + (turns ? speed * speed / kCurve_m : 0.0) * left,
                           Vec3::Zero()});
  }
  return stop;
}

// Flies at 2 m/s along x, commanded, until it is at (0, 0, 2).
Quadrotor flying(Config config = {}) {
  auto quadrotor = Quadrotor::create(config).value();
  EXPECT_TRUE(quadrotor.reset({-4.0, 0.0, 2.0}, 0.0));
  while (quadrotor.state().position_map.x() < 0.0) {
    const auto& s = quadrotor.state();
    const Vec3 wanted(kSpeed_m_s, 0, 0);
    Vec3 force = 3.0 * (wanted - s.velocity_map) + 4.0 * Vec3(0, 0, 2.0 - s.position_map.z()) +
                 Vec3(0.5, 0, kGravity_m_s2);
    force *= quadrotor.config().vehicle.mass_kg;
    AttitudeSetpoint command{.thrust_n = force.norm()};
    command.q_map_base = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), force);
    EXPECT_TRUE(quadrotor.command(command));
    EXPECT_TRUE(quadrotor.advance(0.004));
  }
  return quadrotor;
}

double off(const FallbackStop& stop, const Vec3& place) {
  double least_m = HUGE_VAL;
  for (double t = 0.0; t <= stop.duration_s(); t += 0.005) {
    least_m = std::min(least_m, (stop.at(t).position - place).norm());
  }
  return least_m;
}

void let_pass(Quadrotor& quadrotor, double time_s, const std::function<void()>& each) {
  for (double t = 0.0; t < time_s; t += 0.01) {
    ASSERT_TRUE(quadrotor.advance(0.01));
    each();
  }
}

TEST(FallbackPilot, WithoutCommandsTheStopIsFlownToItsEndAndHeldThere) {
  auto quadrotor = flying();
  const auto stop = stop_along(true, 1.8);
  const Status given = quadrotor.set_fallback(stop);
  ASSERT_TRUE(given) << given.error().message;
  double worst_m = 0.0;
  let_pass(quadrotor, 3.0, [&] {
    if (quadrotor.control() == Control::failsafe) {
      worst_m = std::max(worst_m, off(stop, quadrotor.state().position_map));
    }
  });
  EXPECT_LT(worst_m, 0.1) << "it was on a straight line until then";
  EXPECT_FALSE(quadrotor.flies_fallback());
  EXPECT_EQ(quadrotor.control(), Control::failsafe);
  EXPECT_LT((quadrotor.state().position_map - stop.states.back().position).norm(), 0.02);
  EXPECT_LT(quadrotor.state().velocity_map.norm(), 0.02);
}

TEST(FallbackPilot, OneThatDoesNotPassTheVehicleIsRefusedAndTheOneBeforeIsKept) {
  auto quadrotor = flying();
  const auto good = stop_along(true, 1.8);
  ASSERT_TRUE(quadrotor.set_fallback(good));
  auto elsewhere = stop_along(false, 1.8);
  for (auto& state : elsewhere.states) state.position.y() += 0.3;
  const Status far = quadrotor.set_fallback(elsewhere);
  ASSERT_EQ(far.code(), ErrorCode::not_at_start);
  EXPECT_NE(far.error().message.find("the vehicle is at (0"), std::string::npos)
      << far.error().message;
  const FallbackStop other_way{.step_s = 0.05, .states = {{.position = {0, 0, 2}}}};
  EXPECT_EQ(quadrotor.set_fallback(other_way).code(), ErrorCode::not_at_start)
      << "at the right place, at rest";
  FallbackStop none;
  EXPECT_EQ(quadrotor.set_fallback(none).code(), ErrorCode::invalid_input);
  let_pass(quadrotor, 0.2, [] {});
  EXPECT_TRUE(quadrotor.flies_fallback());
}

// It was given one, and has left it since: straight ahead is better than back over what lies
// between.
TEST(FallbackPilot, AStopThatNoLongerPassesTheVehicleIsNotFlown) {
  auto quadrotor = flying();
  ASSERT_TRUE(quadrotor.set_fallback(stop_along(true, 1.8)));
  for (int i = 0; i < 200; ++i) {  // straight on
    ASSERT_TRUE(quadrotor.command({.thrust_n = quadrotor.config().vehicle.weight_n()}));
    ASSERT_TRUE(quadrotor.advance(0.004));
  }
  const double y = quadrotor.state().position_map.y();
  let_pass(quadrotor, 3.0, [&] {
    EXPECT_FALSE(quadrotor.flies_fallback());
    EXPECT_NEAR(quadrotor.state().position_map.y(), y, 0.05);
  });
  EXPECT_LT(quadrotor.state().velocity_map.norm(), 0.02);
}

TEST(FallbackPilot, CommandsTakeOverAtAnyTime) {
  auto quadrotor = flying();
  ASSERT_TRUE(quadrotor.set_fallback(stop_along(false, 1.8)));
  let_pass(quadrotor, 0.5, [] {});
  ASSERT_TRUE(quadrotor.flies_fallback());
  ASSERT_TRUE(quadrotor.command({.thrust_n = 10.0}));
  ASSERT_TRUE(quadrotor.advance(0.004));
  EXPECT_FALSE(quadrotor.flies_fallback());
  EXPECT_EQ(quadrotor.control(), Control::commanded);
}

TEST(FallbackPilot, LandsAfterTheStopAsAfterAnyBraking) {
  Config config;
  config.failsafe_hold_s = 1.0;
  config.landing = LandingRule::anywhere;
  auto quadrotor = flying(config);
  ASSERT_TRUE(quadrotor.set_fallback(stop_along(false, 1.8)));
  let_pass(quadrotor, 1.5, [&] { EXPECT_NE(quadrotor.control(), Control::landing); });
  EXPECT_TRUE(quadrotor.flies_fallback()) << "to its end first";
  let_pass(quadrotor, 10.0, [] {});
  EXPECT_EQ(quadrotor.control(), Control::landing);
  EXPECT_NEAR(quadrotor.state().position_map.z(), config.land_height_m, 0.02);
}

TEST(FallbackPilot, WithAToleranceOfZeroTheVehicleBrakesStraightAhead) {
  Config config;
  config.fallback_tolerance_m = 0.0;
  auto quadrotor = flying(config);
  EXPECT_EQ(quadrotor.set_fallback(stop_along(true, 1.8)).code(), ErrorCode::not_at_start);
  let_pass(quadrotor, 2.0, [&] {
    EXPECT_FALSE(quadrotor.flies_fallback());
    EXPECT_NEAR(quadrotor.state().position_map.y(), 0.0, 0.02);
  });
}

}  // namespace
}  // namespace goshawk::simulator
