// Rays and distances against boxes, against dense sampling and FCL.
#include "goshawk/movers/oriented_box.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "fcl_truth.hpp"
#include "goshawk/core/random.hpp"

namespace goshawk::movers {
namespace {

TEST(OrientedBox, DistancesToPointsAreThoseOfFcl) {
  Random random(1);
  for (int i = 0; i < 2000; ++i) {
    const OrientedBox box = random_box(random);
    const Vec3 p = random_vector(random, 6.0);
    EXPECT_NEAR(box.distance_m(p), std::max(0.0, fcl_distance_m(box, p, 1e-3) + 1e-3), 2e-5);
    EXPECT_EQ(box.contains(p), box.distance_m(p) == 0.0);
  }
}

// A ray enters where it goes from outside to inside: points just before are outside, points just
// behind inside, and no point of a ray that misses is inside.
TEST(OrientedBox, ARayMeetsTheFirstPointOfTheBox) {
  Random random(2);
  int hits = 0;
  for (int i = 0; i < 5000; ++i) {
    const OrientedBox box = random_box(random);
    const Vec3 origin = random_vector(random, 6.0);
    const Vec3 direction = (random_vector(random, 2.0) + box.center_map - origin).normalized();
    const auto hit = box.cast(origin, direction);
    const double end_m = hit ? hit->range_m : 15.0;
    for (double s = 0.0; s < end_m - 1e-6; s += 0.02) {
      ASSERT_FALSE(box.contains(origin + s * direction));
    }
    if (!hit) continue;
    ++hits;
    EXPECT_LT(box.distance_m(origin + hit->range_m * direction), 1e-9);
    EXPECT_GE(hit->cosine, 0.0);
    EXPECT_LE(hit->cosine, 1.0 + 1e-12);
  }
  EXPECT_GT(hits, 1000);
}

TEST(OrientedBox, ARayFromInsideMeetsItAtOnceAndOneThatLeavesNever) {
  const OrientedBox box{.half_m = Vec3(1.0, 2.0, 3.0)};
  EXPECT_EQ(box.cast(Vec3(0.5, 0.5, 0.5), Vec3::UnitX())->range_m, 0.0);
  EXPECT_FALSE(box.cast(Vec3(1.5, 0.0, 0.0), Vec3::UnitX()));
  const auto hit = box.cast(Vec3(-3.0, 0.0, 0.0), Vec3::UnitX());
  ASSERT_TRUE(hit);
  EXPECT_DOUBLE_EQ(hit->range_m, 2.0);
  EXPECT_DOUBLE_EQ(hit->cosine, 1.0);
}

}  // namespace
}  // namespace goshawk::movers
