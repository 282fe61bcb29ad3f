#include "goshawk/tracker/disturbance_observer.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace goshawk::tracker {
namespace {

TEST(DisturbanceObserver, LearnsAConstantForceWithItsTimeConstant) {
  DisturbanceObserver observer(2.0, 10.0);
  const Vec3 unknown(0.7, -0.3, 0.2), known(1.0, 0.0, 0.0);
  const double dt = 0.004;
  Vec3 v(5, 5, 5);
  observer.update(v, known, dt);
  for (int i = 0; i < 125; ++i) observer.update(v += dt * (known + unknown), known, dt);
  EXPECT_LT((observer.disturbance_map() - (1.0 - std::exp(-1.0)) * unknown).norm(), 1e-9);
  for (int i = 0; i < 2000; ++i) observer.update(v += dt * (known + unknown), known, dt);
  EXPECT_LT((observer.disturbance_map() - unknown).norm(), 1e-6);
  observer.reset();
  EXPECT_EQ(observer.disturbance_map(), Vec3::Zero());
}

TEST(DisturbanceObserver, IsBoundedAndRecoversFromTheBoundWithoutWindup) {
  DisturbanceObserver observer(5.0, 2.0);
  Vec3 v = Vec3::Zero();
  for (int i = 0; i < 5000; ++i) observer.update(v += 0.004 * Vec3(50, 0, 0), Vec3::Zero(), 0.004);
  EXPECT_NEAR(observer.disturbance_map().norm(), 2.0, 1e-12);
  for (int i = 0; i < 250; ++i) observer.update(v, Vec3::Zero(), 0.004);
  EXPECT_LT(observer.disturbance_map().norm(), 0.02);
}

TEST(DisturbanceObserver, AGapInTimeTeachesNothing) {
  DisturbanceObserver observer(20.0, 10.0);
  observer.update(Vec3::Zero(), Vec3::Zero(), 0.004);
  observer.update(Vec3(3, 0, 0), Vec3::Zero(), 0.5);
  observer.update(Vec3(9, 0, 0), Vec3::Zero(), 0.0);  // the same state once more
  EXPECT_EQ(observer.disturbance_map(), Vec3::Zero());
}

TEST(DisturbanceObserver, WithoutBandwidthItStaysSilent) {
  DisturbanceObserver observer(0.0, 10.0);
  for (int i = 0; i < 10; ++i) observer.update(Vec3(i, 0, 0), Vec3::Zero(), 0.01);
  EXPECT_EQ(observer.disturbance_map(), Vec3::Zero());
}

}  // namespace
}  // namespace goshawk::tracker
