#include "goshawk/mujoco/mujoco_plant.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "goshawk/simulator/plant.hpp"

namespace goshawk::mujoco {
namespace {

using plant::PlantState;
using plant::VehicleParameters;
using Vec4 = Vec4;

PlantState hovering(const VehicleParameters& p) {
  PlantState state;
  state.body.position_map = {1, 2, 3};
  state.rotor_speed_rad_s.setConstant(std::sqrt(p.weight_n() / 4.0 / p.thrust_coefficient_n_s2));
  return state;
}

TEST(MujocoPlant, HoversWhereRotorThrustEqualsWeight) {
  const VehicleParameters p;
  auto plant = make_mujoco_plant(p);
  const auto state = hovering(p);
  plant->reset(state);
  EXPECT_LT(plant->acceleration_map(Vec3::Zero()).norm(), 1e-9);
  for (int i = 0; i < 1000; ++i) plant->step(state.rotor_speed_rad_s, Vec3::Zero(), 0.001);
  EXPECT_LT((plant->state().body.position_map - Vec3(1, 2, 3)).norm(), 1e-9);
}

TEST(MujocoPlant, FallsAndDriftsByTheFormulas) {
  VehicleParameters p;
  p.linear_drag_xy_kg_s = p.linear_drag_z_kg_s = 0.4;
  p.quadratic_drag_kg_m = 0.0;
  auto plant = make_mujoco_plant(p);
  PlantState state;
  plant->reset(state);
  for (int i = 0; i < 500; ++i) plant->step(Vec4::Zero(), Vec3(2, 0, 0), 0.001);
  const double decay = std::exp(-0.4 * 0.5 / p.mass_kg);
  EXPECT_NEAR(plant->state().body.velocity_map.x(), 2.0 * (1.0 - decay), 1e-3);
  EXPECT_NEAR(plant->state().body.velocity_map.z(),
              -kGravity_m_s2 * p.mass_kg / 0.4 * (1.0 - decay), 2e-3);
}

// Every rotor alone, with an inertia that has no symmetry: force and torque must come from the same
// place and turn in the same sense. Two independent derivations of the same accelerations.
TEST(MujocoPlant, EachRotorPushesAndTwistsAsOurMixerSays) {
  VehicleParameters p;
  p.inertia_xy_kg_m2 = 0.001;
  p.inertia_xz_kg_m2 = -0.0005;
  p.inertia_yz_kg_m2 = 0.0008;
  ASSERT_TRUE(p.check());
  const simulator::Plant ours(p);
  for (int rotor = 0; rotor < 4; ++rotor) {
    PlantState state;
    state.body.q_map_base = Eigen::Quaterniond(0.8, 0.2, -0.3, 0.4).normalized();
    state.body.velocity_map = {1.0, -2.0, 0.5};
    state.rotor_speed_rad_s[rotor] = 700.0;
    auto plant = make_mujoco_plant(p);
    plant->reset(state);
    const Vec3 wind(0.5, 1.0, -0.2);
    EXPECT_LT((plant->acceleration_map(wind) - ours.acceleration_map(state, wind)).norm(), 1e-9);
    plant->step(state.rotor_speed_rad_s, wind, 1e-4);
    const auto next = ours.step(state, state.rotor_speed_rad_s, wind, 1e-4);
    const Vec3 rate = next.body.angular_velocity_base;
    EXPECT_GT(rate.norm(), 0.001);
    EXPECT_LT((plant->state().body.angular_velocity_base - rate).norm(), 1e-3 * rate.norm());
  }
}

// No force and no drag: the momentum of a tumbling, lopsided body stays, and the energy nearly.
TEST(MujocoPlant, ATumblingBodyKeepsItsMomentumAsFarAsTheStepAllows) {
  VehicleParameters p;
  p.linear_drag_xy_kg_s = p.linear_drag_z_kg_s = p.quadratic_drag_kg_m = 0.0;
  p.inertia_yy_kg_m2 = 0.011;
  auto plant = make_mujoco_plant(p);
  PlantState state;
  state.body.angular_velocity_base = {3.0, 2.0, -1.0};
  plant->reset(state);
  const Vec3 before = p.inertia_kg_m2() * state.body.angular_velocity_base;
  for (int i = 0; i < 2000; ++i) plant->step(Vec4::Zero(), Vec3::Zero(), 0.001);
  const auto& s = plant->state().body;
  const Vec3 after = s.q_map_base * (p.inertia_kg_m2() * s.angular_velocity_base);
  EXPECT_LT((after - before).norm(), 0.01 * before.norm());
}

}  // namespace
}  // namespace goshawk::mujoco
