#include "goshawk/px4/map_frame.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "goshawk/core/random.hpp"

namespace goshawk::px4 {
namespace {

Vec3 random_point(Random& random) {
  return {random.uniform(-20, 20), random.uniform(-20, 20), random.uniform(-5, 5)};
}

TEST(MapFrame, APointGoesThereAndBack) {
  Random random(3);
  for (int i = 0; i < 200; ++i) {
    const MapFrame frame(random_point(random), random.uniform(-3, 3));
    const Vec3 p = random_point(random);
    EXPECT_LT((frame.point_to_local(frame.point_to_map(p)) - p).norm(), 1e-12);
    EXPECT_LT((frame.vector_to_local(frame.vector_to_map(p)) - p).norm(), 1e-12);
  }
}

TEST(MapFrame, TheOriginAndItsHeadingAreWhereTheyWereSet) {
  const MapFrame frame({1, 2, 3}, 0.5 * std::numbers::pi);
  EXPECT_LT((frame.point_to_map({1, 0, 0}) - Vec3(1, 3, 3)).norm(), 1e-12);
  EXPECT_NEAR(frame.yaw_to_local(0.0), -0.5 * std::numbers::pi, 1e-12);
}

// Whatever is reset, the vehicle stays where it is in the map, and looks where it looked.
TEST(MapFrame, AResetMovesTheFrameNotTheVehicle) {
  Random random(4);
  for (int i = 0; i < 200; ++i) {
    MapFrame frame(random_point(random), random.uniform(-3, 3));
    const Vec3 before = random_point(random), delta = random_point(random);
    const double yaw = random.uniform(-3, 3), turned = random.uniform(-1, 1);
    const Vec3 place = frame.point_to_map(before);
    const Quaternion attitude(Eigen::AngleAxisd(yaw, Vec3::UnitZ()));
    const double heading = yaw_of(frame.attitude_to_map(attitude));
    frame.reset(delta, turned, before + delta);
    EXPECT_LT((frame.point_to_map(before + delta) - place).norm(), 1e-11);
    const Quaternion after(Eigen::AngleAxisd(yaw + turned, Vec3::UnitZ()));
    EXPECT_NEAR(
        std::remainder(yaw_of(frame.attitude_to_map(after)) - heading, 2.0 * std::numbers::pi), 0.0,
        1e-11);
  }
}

TEST(MapFrame, AResetOfThePositionMovesEverythingByIt) {
  MapFrame frame(Vec3::Zero(), 0.0);
  frame.reset({2, 0, 0}, 0.0, {7, 1, 1});
  EXPECT_LT((frame.point_to_map({2, 0, 0}) - Vec3(0, 0, 0)).norm(), 1e-12);
  // A point that was planned in the map is 2 m further in PX4's frame.
  EXPECT_LT((frame.point_to_local({1, 1, 1}) - Vec3(3, 1, 1)).norm(), 1e-12);
}

}  // namespace
}  // namespace goshawk::px4
