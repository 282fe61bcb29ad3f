#include "goshawk/px4_wire/frames.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "goshawk/core/random.hpp"

namespace goshawk::px4 {
namespace {

void expect_near(const Vec3& a, const Vec3& b) {
  EXPECT_LT((a - b).norm(), 1e-9) << a.transpose() << " against " << b.transpose();
}

void expect_near(const Quaternion& a, const Quaternion& b, double tolerance) {
  EXPECT_LT((a.coeffs() - b.coeffs()).norm(), tolerance)
      << a.coeffs().transpose() << " against " << b.coeffs().transpose();
}

Vec3 any_vector(Random& random) {
  return {random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-9, 9)};
}

Quaternion any_rotation(Random& random) {
  Quaternion q(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1),
               random.uniform(-1, 1));
  q.normalize();
  if (q.w() < 0.0) q.coeffs() *= -1.0;
  return q;
}

TEST(Frames, VectorsOfTheWorld) {
  expect_near(swap_world({1, 2, 3}), {2, 1, -3});
  expect_near(swap_world({-4.5, 0.25, -7}), {0.25, -4.5, 7});
  expect_near(swap_world({3, -1, -0.5}), {-1, 3, 0.5});
  expect_near(swap_world({0, 12, 1.5}), {12, 0, -1.5});
  expect_near(swap_variance({1, 2, 3}), {2, 1, 3});
}

TEST(Frames, VectorsOfTheBody) {
  expect_near(swap_body({0.1, 0.2, 0.3}), {0.1, -0.2, -0.3});
  expect_near(swap_body({-1.5, 0.4, -0.05}), {-1.5, -0.4, 0.05});
}

TEST(Frames, Attitudes) {
  expect_near(swap_attitude({0.965926, 0, 0, 0.258819}), {0.866025, 0, 0, 0.5}, 1e-6);
  // Roll 10, pitch -20, yaw 120 degrees.
  expect_near(swap_attitude({0.477423, 0.192727, -0.012161, 0.857190}),
              {0.943714, 0.127679, 0.144878, -0.268536}, 1e-6);
}

TEST(Frames, Headings) {
  EXPECT_NEAR(swap_yaw(0.5), 1.070796, 1e-6);
  EXPECT_NEAR(swap_yaw(-2.8), -1.912389, 1e-6);
  EXPECT_EQ(swap_yaw_rate(0.3), -0.3);
}

TEST(Frames, EachConversionIsItsOwnInverse) {
  Random random(1);
  for (int i = 0; i < 1000; ++i) {
    const Vec3 v = any_vector(random);
    expect_near(swap_world(swap_world(v)), v);
    expect_near(swap_body(swap_body(v)), v);
    const Quaternion q = any_rotation(random);
    expect_near(swap_attitude(swap_attitude(q)), q, 1e-12);
    const double yaw = random.uniform(-3.1, 3.1);
    EXPECT_NEAR(swap_yaw(swap_yaw(yaw)), yaw, 1e-12);
  }
}

// The same by rotation matrices: a point of the body lands in the same place of the world.
TEST(Frames, AttitudesAgreeWithRotationMatrices) {
  Eigen::Matrix3d world, body;
  world << 0, 1, 0, 1, 0, 0, 0, 0, -1;
  body << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  Random random(2);
  for (int i = 0; i < 1000; ++i) {
    const Quaternion q = any_rotation(random);
    const Eigen::Matrix3d expected = world * q.toRotationMatrix() * body;
    EXPECT_LT((swap_attitude(q).toRotationMatrix() - expected).norm(), 1e-12);
    EXPECT_NEAR(
        std::remainder(yaw_of(swap_attitude(q)) - swap_yaw(yaw_of(q)), 2.0 * std::numbers::pi), 0.0,
        1e-9);
  }
}

TEST(Frames, AVelocityInTheBodyIsTheSameInBothWorlds) {
  const Quaternion q(0.477423, 0.192727, -0.012161, 0.857190);
  const Vec3 body(2, 0.5, -0.3);
  EXPECT_LT((q * body - Vec3(-1.446918, 1.417139, 0.488003)).norm(), 1e-5);
  EXPECT_LT((swap_attitude(q) * swap_body(body) - swap_world(q * body)).norm(), 1e-5);
}

TEST(Frames, ArraysKeepTheirOrder) {
  expect_near(from_array(to_array(Vec3(1, 2, 3))), {1, 2, 3});
  const Quaternion q(0.5, -0.5, 0.5, -0.5);
  EXPECT_EQ(to_array(q)[0], 0.5f);
  expect_near(from_array(to_array(q)), q, 1e-12);
}

}  // namespace
}  // namespace goshawk::px4
