#include "goshawk/simulator/plant.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace goshawk::simulator {

using plant::PlantState;
using plant::VehicleParameters;

namespace {

using Vec4 = Vec4;

VehicleParameters without_drag() {
  VehicleParameters p;
  p.linear_drag_xy_kg_s = p.linear_drag_z_kg_s = p.quadratic_drag_kg_m = 0.0;
  return p;
}

PlantState run(const Plant& plant, PlantState state, const Vec4& command, double duration_s,
               double dt_s) {
  const int steps = int(std::lround(duration_s / dt_s));
  for (int i = 0; i < steps; ++i) state = plant.step(state, command, Vec3::Zero(), dt_s);
  return state;
}

double distance(const PlantState& a, const PlantState& b) {
  return (a.body.position_map - b.body.position_map).norm() +
         (a.body.velocity_map - b.body.velocity_map).norm() +
         (a.body.q_map_base.coeffs() - b.body.q_map_base.coeffs()).norm() +
         (a.body.angular_velocity_base - b.body.angular_velocity_base).norm() +
         (a.rotor_speed_rad_s - b.rotor_speed_rad_s).norm() / 1000.0;
}

PlantState tumbling() {
  PlantState s;
  s.body.velocity_map = {1.0, -2.0, 3.0};
  s.body.q_map_base = Eigen::Quaterniond(0.9, 0.1, -0.3, 0.2).normalized();
  s.body.angular_velocity_base = {3.0, -4.0, 2.0};
  return s;
}

TEST(Plant, HoversWhereRotorThrustEqualsWeight) {
  const Plant plant{VehicleParameters{}};
  const double weight = plant.parameters().weight_n();
  PlantState s;
  s.rotor_speed_rad_s = plant.rotor_speed_rad_s(Vec4::Constant(weight / 4.0));
  EXPECT_NEAR(plant.rotor_thrust_n(s.rotor_speed_rad_s).sum(), weight, 1e-12);
  EXPECT_LT(plant.acceleration_map(s, Vec3::Zero()).norm(), 1e-12);
  EXPECT_LT(distance(run(plant, s, s.rotor_speed_rad_s, 1.0, 0.001), s), 1e-9);
}

TEST(Plant, FallsFreelyWithoutRotorsAndDrag) {
  const Plant plant(without_drag());
  const auto s = run(plant, PlantState{}, Vec4::Zero(), 2.0, 0.001);
  EXPECT_NEAR(s.body.position_map.z(), -0.5 * kGravity_m_s2 * 4.0, 1e-9);
  EXPECT_NEAR(s.body.velocity_map.z(), -kGravity_m_s2 * 2.0, 1e-9);
}

TEST(Plant, DragEndsAFallAtItsTerminalSpeed) {
  const Plant plant{VehicleParameters{}};
  const auto& p = plant.parameters();
  const auto s = run(plant, PlantState{}, Vec4::Zero(), 60.0, 0.01);
  const double v = -s.body.velocity_map.z();
  EXPECT_NEAR(p.linear_drag_z_kg_s * v + p.quadratic_drag_kg_m * v * v, p.weight_n(), 1e-6);
}

TEST(Plant, WindCarriesAnUnpoweredVehicleAlong) {
  const Plant plant{VehicleParameters{}};
  PlantState s;
  const Vec3 wind(3.0, -1.0, 0.0);
  for (int i = 0; i < 6000; ++i) s = plant.step(s, Vec4::Zero(), wind, 0.01);
  EXPECT_LT((s.body.velocity_map.head<2>() - wind.head<2>()).norm(), 1e-6);
}

TEST(Plant, TumblingKeepsAngularMomentumAndEnergy) {
  auto parameters = without_drag();
  parameters.inertia_yy_kg_m2 = 0.011;  // three different moments: the general motion
  parameters.inertia_xy_kg_m2 = 0.001;
  const Plant plant(parameters);
  const auto& J = plant.inertia_kg_m2();
  const auto momentum = [&](const PlantState& s) {
    return Vec3(s.body.q_map_base * (J * s.body.angular_velocity_base));
  };
  const auto energy = [&](const PlantState& s) {
    return 0.5 * s.body.angular_velocity_base.dot(J * s.body.angular_velocity_base) +
           0.5 * parameters.mass_kg * s.body.velocity_map.squaredNorm() +
           parameters.weight_n() * s.body.position_map.z();
  };
  const auto before = tumbling();
  const auto after = run(plant, before, Vec4::Zero(), 3.0, 0.001);
  EXPECT_GT((before.body.angular_velocity_base - after.body.angular_velocity_base).norm(), 0.1);
  EXPECT_LT((momentum(before) - momentum(after)).norm(), 1e-8);
  EXPECT_NEAR(energy(before), energy(after), 1e-7);
  EXPECT_NEAR(after.body.q_map_base.norm(), 1.0, 1e-14);
}

TEST(Plant, HalvingTheStepDividesTheErrorBySixteen) {
  const Plant plant{VehicleParameters{}};
  const Vec4 command(600.0, 550.0, 580.0, 620.0);
  auto start = tumbling();
  start.rotor_speed_rad_s = Vec4::Constant(400.0);
  const auto truth = run(plant, start, command, 0.4, 0.00025);
  const double coarse = distance(run(plant, start, command, 0.4, 0.008), truth);
  const double fine = distance(run(plant, start, command, 0.4, 0.004), truth);
  EXPECT_GT(std::log2(coarse / fine), 3.7);
  EXPECT_LT(std::log2(coarse / fine), 4.5);
}

TEST(Plant, RotorsFollowTheirCommandAsAFirstOrderLag) {
  const Plant plant{VehicleParameters{}};
  const double tau = plant.parameters().motor_time_constant_s;
  const auto s = run(plant, PlantState{}, Vec4::Constant(500.0), tau, tau / 100.0);
  EXPECT_NEAR(s.rotor_speed_rad_s[0], 500.0 * (1.0 - std::exp(-1.0)), 1e-6);
}

TEST(Plant, AccelerationIsTheDerivativeOfVelocity) {
  const Plant plant{VehicleParameters{}};
  auto s = tumbling();
  s.rotor_speed_rad_s = Vec4::Constant(500.0);
  const Vec3 wind(2.0, 0.0, -1.0);
  const double h = 1e-5;
  const auto next = plant.step(s, s.rotor_speed_rad_s, wind, h);
  EXPECT_LT(
      ((next.body.velocity_map - s.body.velocity_map) / h - plant.acceleration_map(s, wind)).norm(),
      1e-3);
}

}  // namespace
}  // namespace goshawk::simulator
