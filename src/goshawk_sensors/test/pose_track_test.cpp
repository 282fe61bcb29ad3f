#include "goshawk/sensors/pose_track.hpp"

#include <gtest/gtest.h>

#include "support.hpp"

namespace goshawk::sensors {
namespace {

constexpr std::int64_t kMs = 1'000'000;

Pose pose_at(double t) {
  Pose p;
  p.position_map = Vec3(1.0 + 2.0 * t, -t, 0.5 * t);
  p.q_map_base = Eigen::AngleAxisd(1.5 * t, Vec3(0.6, 0.0, 0.8));
  return p;
}

void expect_near(const Pose& a, const Pose& b) {
  EXPECT_LT((a.position_map - b.position_map).norm(), 1e-9);
  EXPECT_LT(a.q_map_base.angularDistance(b.q_map_base), 1e-7);
}

TEST(PoseTrack, ASteadyMotionIsFollowedExactlyBetweenThePoses) {
  PoseTrack track;
  for (int i = 0; i <= 100; ++i) ASSERT_TRUE(track.add(i * 10 * kMs, pose_at(0.01 * i)));
  // Forward, backward, and at the poses themselves.
  for (int i = 0; i <= 1000; ++i) expect_near(*track.at(i * kMs), pose_at(0.001 * i));
  for (int i = 1000; i >= 0; i -= 7) expect_near(*track.at(i * kMs), pose_at(0.001 * i));
}

TEST(PoseTrack, TheShorterWayAroundIsTaken) {
  PoseTrack track;
  Pose turned;
  turned.q_map_base = Eigen::AngleAxisd(0.2, Vec3::UnitZ());
  turned.q_map_base.coeffs() *= -1.0;  // the same attitude
  ASSERT_TRUE(track.add(0, {}));
  ASSERT_TRUE(track.add(10 * kMs, turned));
  EXPECT_NEAR(track.at(5 * kMs)->q_map_base.angularDistance(Quaternion::Identity()), 0.1, 1e-9);
}

TEST(PoseTrack, OutsideAndInAGapThereIsNoPose) {
  PoseTrack track(0.1, 10.0);
  EXPECT_FALSE(track.at(0));
  ASSERT_TRUE(track.add(100 * kMs, pose_at(0.1)));
  ASSERT_TRUE(track.add(200 * kMs, pose_at(0.2)));
  ASSERT_TRUE(track.add(301 * kMs, pose_at(0.3)));
  EXPECT_FALSE(track.at(99 * kMs));
  EXPECT_FALSE(track.at(302 * kMs));
  EXPECT_TRUE(track.at(150 * kMs));
  EXPECT_FALSE(track.at(250 * kMs)) << "101 ms are not bridged";
  EXPECT_TRUE(track.at(200 * kMs));
  EXPECT_TRUE(track.at(301 * kMs));
}

TEST(PoseTrack, OldPosesGoAndAnEarlierStampStartsAnew) {
  PoseTrack track(0.25, 1.0);
  for (int i = 0; i <= 300; ++i) ASSERT_TRUE(track.add(i * 10 * kMs, {}));
  EXPECT_EQ(track.first_ns(), 2000 * kMs);
  EXPECT_EQ(track.last_ns(), 3000 * kMs);
  ASSERT_TRUE(track.add(500 * kMs, {}));
  EXPECT_EQ(track.first_ns(), 500 * kMs);
  EXPECT_EQ(track.last_ns(), 500 * kMs);
}

TEST(PoseTrack, WhatIsNotFiniteIsRefused) {
  PoseTrack track;
  Pose bad;
  bad.position_map.y() = std::nan("");
  EXPECT_EQ(track.add(0, bad).code(), ErrorCode::invalid_input);
  bad = {};
  bad.q_map_base.w() = INFINITY;
  EXPECT_EQ(track.add(0, bad).code(), ErrorCode::invalid_input);
  EXPECT_TRUE(track.empty());
}

}  // namespace
}  // namespace goshawk::sensors
