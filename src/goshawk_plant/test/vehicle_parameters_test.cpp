#include "goshawk/plant/vehicle_parameters.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <functional>
#include <limits>
#include <vector>

namespace goshawk::plant {
namespace {

using testing::HasSubstr;

TEST(VehicleParameters, DefaultsAreAVehicleThatLiftsWellAboveItsWeight) {
  const VehicleParameters p;
  ASSERT_TRUE(p.check());
  EXPECT_GT(p.max_thrust_n() / p.weight_n(), 2.5);
  EXPECT_LT(p.max_thrust_n() / p.weight_n(), 3.0);
}

TEST(VehicleParameters, EveryFaultIsListedAtOnce) {
  VehicleParameters p;
  p.mass_kg = 0.0;
  p.inertia_xx_kg_m2 = -0.01;
  p.arm_length_m = std::nan("");
  p.motor_time_constant_s = -1.0;
  p.quadratic_drag_kg_m = -0.1;
  const auto status = p.check();
  ASSERT_FALSE(status);
  EXPECT_EQ(status.code(), ErrorCode::invalid_parameter);
  for (const char* name : {"mass_kg", "positive definite", "arm_length_m", "motor_time_constant_s",
                           "quadratic_drag_kg_m"}) {
    EXPECT_THAT(status.error().message, HasSubstr(name));
  }
  EXPECT_THAT(status.error().message, testing::Not(HasSubstr("thrust_coefficient")));
}

TEST(VehicleParameters, EachValueThatNoVehicleHasIsRefused) {
  using Change = std::function<void(VehicleParameters&)>;
  const double infinity = std::numeric_limits<double>::infinity();
  const std::vector<Change> changes{
      [](auto& p) { p.mass_kg = -1.0; },
      [&](auto& p) { p.mass_kg = infinity; },
      [](auto& p) { p.inertia_zz_kg_m2 = 0.0; },
      [](auto& p) { p.inertia_zz_kg_m2 = 0.0161; },  // above Ixx + Iyy
      [](auto& p) { p.inertia_xy_kg_m2 = 0.009; },   // indefinite
      [](auto& p) { p.inertia_yz_kg_m2 = std::nan(""); },
      [](auto& p) { p.max_motor_thrust_n = 2.4; },  // 9.6 N under a weight of 9.8 N
      [](auto& p) { p.thrust_coefficient_n_s2 = 0.0; },
      [](auto& p) { p.torque_coefficient_nm_s2 = -1e-7; },
      [](auto& p) { p.linear_drag_xy_kg_s = -0.1; },
      [&](auto& p) { p.linear_drag_z_kg_s = infinity; }};
  for (std::size_t i = 0; i < changes.size(); ++i) {
    VehicleParameters p;
    changes[i](p);
    EXPECT_EQ(p.check().code(), ErrorCode::invalid_parameter) << "change " << i;
  }
}

TEST(VehicleParameters, AFlatPlateIsTheLimitOfTheTriangleInequality) {
  VehicleParameters p;
  p.inertia_zz_kg_m2 = p.inertia_xx_kg_m2 + p.inertia_yy_kg_m2;
  EXPECT_TRUE(p.check());
}

}  // namespace
}  // namespace goshawk::plant
