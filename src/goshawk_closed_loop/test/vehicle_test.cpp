#include "goshawk/closed_loop/vehicle.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace goshawk::closed_loop {
namespace {

const Vec3 kHome(1.0, 2.0, 3.0);

TEST(Vehicle, HoversWhereItBegins) {
  for (const Tracking tracking : {Tracking::physical, Tracking::ideal}) {
    auto vehicle = make_vehicle(tracking, {}, kHome).value();
    for (int i = 0; i < 1000; ++i) vehicle->advance();
    EXPECT_EQ(vehicle->time_ns(), 1'000'000'000);
    EXPECT_LT((vehicle->state().position_map - kHome).norm(), 1e-3);
  }
}

TEST(Vehicle, AnIdealOneIsOnItsReference) {
  auto vehicle = make_vehicle(Tracking::ideal, {}, kHome).value();
  const BezierPiece curve = BezierPiece::between(
      {.position = kHome}, {.position = Vec3(6, 0, 2), .velocity = Vec3(4, 0, 0)}, 2.0);
  double worst_m = 0.0, worst_m_s = 0.0;
  for (int ms = 0; ms < 2000; ++ms) {
    const FlatState reference = curve.sample(1e-3 * ms);
    if (ms % 4 == 0) {
      ASSERT_TRUE(vehicle->command({}, reference));
    }
    if (ms > 0) {
      worst_m = std::max(worst_m, (vehicle->state().position_map - reference.position).norm());
      worst_m_s = std::max(worst_m_s, (vehicle->state().velocity_map - reference.velocity).norm());
    }
    vehicle->advance();
  }
  EXPECT_LT(worst_m, 1e-6);
  EXPECT_LT(worst_m_s, 1e-3);
}

TEST(Vehicle, APhysicalOneFallsBehindACommandThatItCannotFollow) {
  auto vehicle = make_vehicle(Tracking::physical, {}, kHome).value();
  for (int ms = 0; ms < 100; ++ms) {
    ASSERT_TRUE(vehicle->command({.thrust_n = 9.80665}, {.position = kHome + Vec3(5, 0, 0)}));
    vehicle->advance();
  }
  EXPECT_LT((vehicle->state().position_map - kHome).norm(), 0.1);
}

TEST(Vehicle, WhatCannotFlyIsRefused) {
  simulator::Config config;
  config.vehicle.mass_kg = 100.0;
  EXPECT_EQ(make_vehicle(Tracking::physical, config, kHome).error().code,
            ErrorCode::invalid_parameter);
  EXPECT_EQ(make_vehicle(Tracking::ideal, config, kHome).error().code,
            ErrorCode::invalid_parameter);
  EXPECT_FALSE(make_vehicle(Tracking::ideal, {}, Vec3(std::nan(""), 0, 0)));
}

}  // namespace
}  // namespace goshawk::closed_loop
