#include "goshawk/map_server/pose_buffer.hpp"

#include <gmock/gmock.h>

#include <numbers>

namespace goshawk::map_server {
namespace {

using ::testing::HasSubstr;

constexpr std::int64_t kSecond = 1'000'000'000;

Pose turned(double x_m, double yaw_rad) {
  return {Vec3(x_m, 0, 0), Quaternion(Eigen::AngleAxisd(yaw_rad, Vec3::UnitZ()))};
}

PoseBuffer odometry() {
  return PoseBuffer("odometry", 5.0, 0.5);
}

TEST(PoseBuffer, InterpolatesPositionAndAttitude) {
  PoseBuffer buffer = odometry();
  ASSERT_TRUE(buffer.add(10 * kSecond, turned(1.0, 0.0)));
  ASSERT_TRUE(buffer.add(10 * kSecond + kSecond / 5, turned(2.0, 1.0)));
  for (const double share : {0.0, 0.25, 0.5, 1.0}) {
    const auto pose = buffer.at(10 * kSecond + std::int64_t(share * 0.2e9)).value();
    EXPECT_NEAR(pose.position.x(), 1.0 + share, 1e-9);
    const Eigen::AngleAxisd angle(Quaternion(pose.q).toRotationMatrix());
    EXPECT_NEAR(angle.angle(), share, 1e-9);
  }
}

TEST(PoseBuffer, TurnsTheShortWayRound) {
  PoseBuffer buffer = odometry();
  Pose b = turned(0.0, 0.2);
  b.q.coeffs() *= -1.0;  // the same attitude
  ASSERT_TRUE(buffer.add(kSecond, turned(0.0, 0.0)));
  ASSERT_TRUE(buffer.add(kSecond + 100, b));
  const Vec3 ahead = buffer.at(kSecond + 50).value().q * Vec3::UnitX();
  EXPECT_NEAR(std::atan2(ahead.y(), ahead.x()), 0.1, 1e-9);
}

TEST(PoseBuffer, SaysWhyThereIsNoPose) {
  PoseBuffer buffer = odometry();
  EXPECT_EQ(buffer.at(kSecond).code(), ErrorCode::tracking_lost);
  EXPECT_THAT(buffer.at(kSecond).error().message, HasSubstr("before any pose of odometry"));
  ASSERT_TRUE(buffer.add(10 * kSecond, turned(0, 0)));
  ASSERT_TRUE(buffer.add(11 * kSecond, turned(1, 0)));
  EXPECT_THAT(buffer.at(9 * kSecond).error().message, HasSubstr("1 s before the oldest pose"));
  EXPECT_THAT(buffer.at(13 * kSecond).error().message, HasSubstr("2 s after the newest pose"));
  EXPECT_THAT(buffer.at(10 * kSecond + 1).error().message, HasSubstr("gap of 1 s"));
  for (const std::int64_t stamp : {9 * kSecond, 13 * kSecond, 10 * kSecond + 1}) {
    EXPECT_EQ(buffer.at(stamp).code(), ErrorCode::tracking_lost);
  }
  EXPECT_EQ(buffer.at(0).code(), ErrorCode::invalid_input);
  EXPECT_TRUE(buffer.at(11 * kSecond));
}

TEST(PoseBuffer, AClockThatJumpsBackForgetsWhatWasBefore) {
  PoseBuffer buffer = odometry();
  ASSERT_TRUE(buffer.add(100 * kSecond, turned(1, 0)));
  const auto jumped = buffer.add(50 * kSecond, turned(2, 0));
  EXPECT_EQ(jumped.code(), ErrorCode::clock_set);
  EXPECT_THAT(jumped.error().message, HasSubstr("jumped back by 50 s"));
  EXPECT_FALSE(buffer.at(100 * kSecond));
  EXPECT_EQ(buffer.at(50 * kSecond).value().position.x(), 2.0);
  ASSERT_TRUE(buffer.add(50 * kSecond + 1, turned(3, 0)));
}

TEST(PoseBuffer, APoseOutOfOrderIsDropped) {
  PoseBuffer buffer = odometry();
  ASSERT_TRUE(buffer.add(kSecond, turned(1, 0)));
  ASSERT_TRUE(buffer.add(kSecond + kSecond / 50, turned(3, 0)));
  EXPECT_TRUE(buffer.add(kSecond + kSecond / 100, turned(99, 0)));
  EXPECT_NEAR(buffer.at(kSecond + kSecond / 100).value().position.x(), 2.0, 1e-9);
}

TEST(PoseBuffer, TheSameStampAgainReplacesAndZeroIsRefused) {
  PoseBuffer buffer = odometry();
  EXPECT_EQ(buffer.add(0, turned(1, 0)).code(), ErrorCode::invalid_input);
  EXPECT_TRUE(buffer.empty());
  ASSERT_TRUE(buffer.add(kSecond, turned(1, 0)));
  ASSERT_TRUE(buffer.add(kSecond, turned(2, 0)));
  EXPECT_EQ(buffer.at(kSecond).value().position.x(), 2.0);
}

TEST(PoseBuffer, KeepsItsTimeAndNotMuchMore) {
  PoseBuffer buffer = odometry();
  for (int i = 1; i <= 100'000; ++i) ASSERT_TRUE(buffer.add(i * kSecond / 100, turned(i, 0)));
  const std::int64_t now = 1000 * kSecond;
  EXPECT_TRUE(buffer.at(now - 5 * kSecond));
  EXPECT_FALSE(buffer.at(now - 20 * kSecond));
  std::vector<Vec3> path;
  buffer.positions(now - kSecond / 10, now, path);
  ASSERT_EQ(path.size(), 10U);
  EXPECT_EQ(path.back().x(), 100'000.0);
  buffer.positions(now, now, path);
  EXPECT_TRUE(path.empty());
}

}  // namespace
}  // namespace goshawk::map_server
