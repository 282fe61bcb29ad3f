#include "goshawk/px4/reference_track.hpp"

#include <gtest/gtest.h>

namespace goshawk::px4 {
namespace {

constexpr std::int64_t kOneSecond_ns = 1'000'000'000;

/// From rest at `from` to rest 0.2 m further along x, in a second.
FallbackStop stop_from(const Vec3& from) {
  return {.step_s = 1.0, .states = {{.position = from}, {.position = from + Vec3(0.2, 0.0, 0.0)}}};
}

class Tracks : public testing::Test {
 protected:
  Tracks() { vehicle.position_map = {1, 2, 3}; }
  Config config;
  RigidBodyState vehicle;
  ReferenceTrack track{config};
};

TEST_F(Tracks, HoldsWhereTheVehicleCanStop) {
  vehicle.velocity_map = {0.6, 0, 0};
  track.hold(vehicle);
  // 0.6^2 / (2 * 3) further.
  EXPECT_LT((track.at(0).position - Vec3(1.06, 2, 3)).norm(), 1e-12);
  EXPECT_TRUE(track.at_rest(0));
  EXPECT_FALSE(track.age_s(0));
}

TEST_F(Tracks, ClimbsAndStops) {
  track.hold(vehicle);
  track.climb(1.0, 0);
  EXPECT_FALSE(track.at_rest(kOneSecond_ns));
  EXPECT_NEAR(track.at(kOneSecond_ns).position.z(), 3.5, 1e-9);
  EXPECT_NEAR(track.at(kOneSecond_ns).velocity.z(), 0.5, 1e-12);
  EXPECT_TRUE(track.at_rest(2 * kOneSecond_ns));
  EXPECT_NEAR(track.at(9 * kOneSecond_ns).position.z(), 4.0, 1e-12);
}

TEST_F(Tracks, TheTrackersStopIsFlownToRestIfNothingNewerComes) {
  track.hold(vehicle);
  ASSERT_TRUE(track.offer(stop_from({1, 2, 3}), vehicle, 0));
  EXPECT_NEAR(track.at(kOneSecond_ns / 2).position.x(), 1.1, 1e-9);
  EXPECT_GT(track.at(kOneSecond_ns / 2).velocity.x(), 0.1);
  EXPECT_TRUE(track.at_rest(kOneSecond_ns));
  EXPECT_LT((track.at(5 * kOneSecond_ns).position - Vec3(1.2, 2, 3)).norm(), 1e-12);
  EXPECT_EQ(track.at(5 * kOneSecond_ns).velocity.norm(), 0.0);
  EXPECT_NEAR(*track.age_s(5 * kOneSecond_ns), 5.0, 1e-12);
}

TEST_F(Tracks, AReferenceFarFromTheVehicleIsNotFlown) {
  track.hold(vehicle);
  EXPECT_EQ(track.offer(stop_from({2, 2, 3}), vehicle, 0).code(), ErrorCode::not_at_start);
  EXPECT_LT((track.at(0).position - Vec3(1, 2, 3)).norm(), 1e-12);
}

// The vehicle may lag behind what is flown already.
TEST_F(Tracks, AReferenceThatGoesOnIsFlown) {
  track.hold(vehicle);
  ASSERT_TRUE(track.offer(stop_from({1.3, 2, 3}), vehicle, 0));
  vehicle.position_map = {0.5, 2, 3};
  EXPECT_TRUE(track.offer(stop_from({1.3, 2, 3}), vehicle, 0));
  EXPECT_EQ(track.offer(stop_from({1.9, 2, 3}), vehicle, 0).code(), ErrorCode::not_at_start);
}

TEST_F(Tracks, AReferenceThatTheMarginDoesNotCoverIsNotFlown) {
  track.hold(vehicle);
  FallbackStop fast = stop_from({1, 2, 3});
  fast.states.front().velocity = {0.6, 0, 0};
  const auto refused = track.offer(fast, vehicle, 0);
  EXPECT_EQ(refused.code(), ErrorCode::trajectory_infeasible);
  EXPECT_NE(refused.error().message.find("v_max_m_s"), std::string::npos);
}

}  // namespace
}  // namespace goshawk::px4
