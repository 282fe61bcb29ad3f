#include "goshawk/simulator/sensor.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "goshawk/simulator/quadrotor.hpp"

namespace goshawk::simulator {
namespace {

RigidBodyState at(double x) {
  RigidBodyState state;
  state.position_map.x() = x;
  return state;
}

TEST(Sensor, APerfectOneTellsTheTruthAtOnce) {
  Sensor sensor({}, 1'000'000);
  sensor.reset(at(0.0), 0);
  EXPECT_EQ(sensor.measure().state.position_map, at(0.0).position_map);
  sensor.record(at(1.0), 1'000'000);
  EXPECT_EQ(sensor.measure().state.position_map, at(1.0).position_map);
  EXPECT_EQ(sensor.measure().time_ns, 1'000'000);
}

TEST(Sensor, ADelayedStateCarriesTheTimeAtWhichItWasTrue) {
  SensorParameters parameters;
  parameters.delay_s = 0.02;
  Sensor sensor(parameters, 1'000'000);
  sensor.reset(at(0.0), 0);
  for (int k = 1; k <= 100; ++k) {
    sensor.record(at(k), k * 1'000'000);
    const auto m = sensor.measure();
    EXPECT_EQ(m.state.position_map.x(), std::max(0, k - 20));
    EXPECT_EQ(m.time_ns, std::max(0, k - 20) * std::int64_t{1'000'000});
  }
}

TEST(Sensor, NoiseHasTheConfiguredDeviationNoBiasAndItsSeed) {
  SensorParameters parameters;
  parameters.position_noise_m = 0.02;
  parameters.velocity_noise_m_s = 0.05;
  parameters.attitude_noise_rad = 0.01;
  parameters.body_rate_noise_rad_s = 0.03;
  Sensor sensor(parameters, 1'000'000), twin(parameters, 1'000'000);
  sensor.reset(at(0.0), 0);
  twin.reset(at(0.0), 0);
  const int count = 20000;
  Vec3 mean = Vec3::Zero(), position = mean, velocity = mean, attitude = mean, rate = mean;
  for (int k = 0; k < count; ++k) {
    const auto m = sensor.measure().state;
    EXPECT_EQ(m.position_map, twin.measure().state.position_map);
    EXPECT_NEAR(m.q_map_base.norm(), 1.0, 1e-12);
    mean += m.position_map;
    position += m.position_map.cwiseAbs2();
    velocity += m.velocity_map.cwiseAbs2();
    attitude += (2.0 * m.q_map_base.vec()).cwiseAbs2();
    rate += m.angular_velocity_base.cwiseAbs2();
  }
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_NEAR(mean[axis] / count, 0.0, 6e-4);
    EXPECT_NEAR(std::sqrt(position[axis] / count), 0.02, 5e-4);
    EXPECT_NEAR(std::sqrt(velocity[axis] / count), 0.05, 1.2e-3);
    EXPECT_NEAR(std::sqrt(attitude[axis] / count), 0.01, 2.5e-4);
    EXPECT_NEAR(std::sqrt(rate[axis] / count), 0.03, 8e-4);
  }
}

TEST(Sensor, TheQuadrotorsMeasurementIsItsStateOfBefore) {
  Config config;
  config.sensor.delay_s = 0.03;
  auto quadrotor = Quadrotor::create(config).value();
  AttitudeSetpoint up{.thrust_n = 15.0};
  ASSERT_TRUE(quadrotor.command(up));
  ASSERT_TRUE(quadrotor.advance(0.05));
  const auto then = quadrotor.state();
  ASSERT_TRUE(quadrotor.advance(0.03));
  const auto m = quadrotor.measure();
  EXPECT_EQ(m.state.position_map, then.position_map);
  EXPECT_EQ(m.time_ns, 50'000'000);
}

}  // namespace
}  // namespace goshawk::simulator
