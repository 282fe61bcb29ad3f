#include "goshawk/core/vehicle.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace goshawk {
namespace {

Quaternion turned(double yaw_rad, double tilt_rad, const Vec3& tilt_axis) {
  return Quaternion(Eigen::AngleAxisd(yaw_rad, Vec3::UnitZ()) *
                    Eigen::AngleAxisd(tilt_rad, tilt_axis));
}

TEST(Yaw, IsTheHeadingOfTheBodysXAxisWhateverItsTilt) {
  for (double yaw = -3.1; yaw < 3.14; yaw += 0.1) {
    EXPECT_NEAR(yaw_of(turned(yaw, 0.0, Vec3::UnitX())), yaw, 1e-12);
    EXPECT_NEAR(yaw_of(turned(yaw, 0.4, Vec3::UnitY())), yaw, 1e-12) << "pitch";
    EXPECT_NEAR(yaw_of(turned(yaw, -0.4, Vec3::UnitX())), yaw, 1e-12) << "roll";
  }
}

TEST(RigidBodyState, IsFiniteOnlyIfEveryNumberIs) {
  EXPECT_TRUE(RigidBodyState{}.is_finite());
  RigidBodyState state;
  state.q_map_base.w() = NAN;
  EXPECT_FALSE(state.is_finite());
  for (Vec3 RigidBodyState::*part : {&RigidBodyState::position_map, &RigidBodyState::velocity_map,
                                     &RigidBodyState::angular_velocity_base}) {
    state = {};
    (state.*part).y() = INFINITY;
    EXPECT_FALSE(state.is_finite());
  }
}

}  // namespace
}  // namespace goshawk
