#include "goshawk/corridor_builder/horizon.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "goshawk/core/random.hpp"

namespace goshawk::corridor_builder {
namespace {

double length_of(const std::vector<Vec3>& path) {
  double length_m = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i) length_m += (path[i] - path[i - 1]).norm();
  return length_m;
}

TEST(Horizon, LeavesAPathWholeThatIsHardlyLonger) {
  const std::vector<Vec3> path{{0, 0, 0}, {6, 0, 0}, {6, 5, 0}};
  for (const double horizon_m : {0.0, 9.5, 11.0, 50.0}) {
    const auto part = within_horizon(path, horizon_m);
    EXPECT_EQ(part.waypoints_map, path) << horizon_m;
    EXPECT_EQ(part.beyond_m, 0.0);
  }
}

TEST(Horizon, CutsWithinASegmentAndSaysWhatIsLeft) {
  const std::vector<Vec3> path{{0, 0, 0}, {6, 0, 0}, {6, 10, 0}};
  const auto part = within_horizon(path, 8.0);
  ASSERT_EQ(part.waypoints_map.size(), 3U);
  EXPECT_EQ(part.waypoints_map[1], path[1]);
  EXPECT_LT((part.waypoints_map[2] - Vec3(6, 2, 0)).norm(), 1e-12);
  EXPECT_NEAR(part.beyond_m, 8.0, 1e-12);
}

TEST(Horizon, FirstPartAndRestMakeThePathWhateverItsShape) {
  Random random(4);
  for (int i = 0; i < 200; ++i) {
    std::vector<Vec3> path;
    for (int n = 2 + random.below(20); n > 0; --n) {
      path.emplace_back(random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-9, 9));
    }
    const double length_m = length_of(path);
    const double horizon_m = random.uniform(0.05, 0.8) * length_m;
    const auto part = within_horizon(path, horizon_m);
    EXPECT_NEAR(length_of(part.waypoints_map), horizon_m, 1e-9);
    EXPECT_NEAR(horizon_m + part.beyond_m, length_m, 1e-9);
    for (std::size_t k = 0; k + 1 < part.waypoints_map.size(); ++k) {
      EXPECT_EQ(part.waypoints_map[k], path[k]);
    }
  }
}

TEST(Horizon, LeavesPathsThatNoCorridorCanFollowToTheBuilder) {
  EXPECT_TRUE(within_horizon({}, 5.0).waypoints_map.empty());
  const std::vector<Vec3> wild{{0, 0, 0}, {std::numeric_limits<double>::quiet_NaN(), 0, 0}};
  EXPECT_EQ(within_horizon(wild, 5.0).waypoints_map.size(), 2U);
}

}  // namespace
}  // namespace goshawk::corridor_builder
