// One pose at a time: FCL's distances against geometry done by hand and by projection.
#include <gtest/gtest.h>

#include "worlds.hpp"

namespace goshawk::flight_check::test {
namespace {

constexpr double kClose_m = 2e-5;

TEST(Clearance, OfALevelCylinderBesideAVoxelIsTheGapToItsRim) {
  const auto v = judge(tree_of({{10, 0, 0}}), {at(0.0, Vec3(0.0, 0.05, 0.05))});
  EXPECT_FALSE(v.touched);
  EXPECT_NEAR(v.clearance_m, 1.0 - 0.15, kClose_m);
  EXPECT_NEAR(v.clearance_place_map.x(), 1.0, 1e-3);
}

TEST(Clearance, AboveAVoxelIsTheGapToTheBottom) {
  const auto v = judge(tree_of({{0, 0, 0}}), {at(0.0, Vec3(0.05, 0.05, 0.4))});
  EXPECT_NEAR(v.clearance_m, 0.4 - 0.1 - 0.05, kClose_m);
}

TEST(Clearance, FollowsTheTrueAttitude) {
  // On its side, the disc reaches down by its radius instead of half its height.
  const auto v =
      judge(tree_of({{0, 0, 0}}), {at(0.0, Vec3(0.05, 0.05, 0.4), turn(M_PI_2, {1, 0, 0}))});
  EXPECT_NEAR(v.clearance_m, 0.4 - 0.1 - 0.15, kClose_m);
  // Tilted by 30 degrees: the lowest point of the rim.
  const double a = M_PI / 6.0;
  const auto tilted =
      judge(tree_of(wall_at_x(0, 20)), {at(0.0, Vec3(0.5, 0.0, 0.0), turn(M_PI_2 - a, {0, 1, 0}))});
  EXPECT_NEAR(tilted.clearance_m, 0.4 - 0.15 * std::sin(a) - 0.05 * std::cos(a), kClose_m);
}

TEST(Clearance, OfABoxFollowsItsYaw) {
  const Body box{.height_m = 0.1, .is_box = true, .length_m = 0.4, .width_m = 0.2};
  const Vec3 p(0.5, 0.0, 0.0);
  EXPECT_NEAR(judge(tree_of(wall_at_x(0, 20)), {at(0.0, p)}, box).clearance_m, 0.2, kClose_m);
  EXPECT_NEAR(
      judge(tree_of(wall_at_x(0, 20)), {at(0.0, p, turn(M_PI_2, {0, 0, 1}))}, box).clearance_m, 0.3,
      kClose_m);
  EXPECT_NEAR(
      judge(tree_of(wall_at_x(0, 20)), {at(0.0, p, turn(M_PI_4, {0, 0, 1}))}, box).clearance_m,
      0.4 - 0.3 * M_SQRT1_2, kClose_m);
}

TEST(Clearance, AgreesWithProjectionOnRandomPosesAndWorlds) {
  Random random(7);
  const Body body{.radius_m = 0.2, .height_m = 0.12};
  int touching = 0;
  for (int world = 0; world < 20; ++world) {
    std::vector<Index3> voxels;
    for (int i = 0; i < 60; ++i) {
      voxels.push_back({random.below(20) - 10, random.below(20) - 10, random.below(20) - 10});
    }
    const auto check = FlightCheck::from_tree(tree_of(voxels), body).value();
    for (int k = 0; k < 40; ++k) {
      const Vec3 p(random.uniform(-1.2, 1.2), random.uniform(-1.2, 1.2), random.uniform(-1.2, 1.2));
      const Vec3 axis(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(0.1, 1));
      const Sample s = at(0.0, p, turn(random.uniform(-3, 3), axis));
      const Bracket truth = brute_force(s, body, voxels);
      const Verdict v = check.judge(std::span(&s, 1)).value();
      touching += v.touched;
      if (truth.at_least_m > 2e-4) {
        EXPECT_GE(v.clearance_m, truth.at_least_m - kClose_m) << "world " << world << " pose " << k;
      }
      EXPECT_LE(v.clearance_m, truth.at_most_m + kClose_m) << "world " << world << " pose " << k;
      EXPECT_TRUE(v.touched || truth.at_most_m > 1e-6);
    }
  }
  EXPECT_GT(touching, 50);
  EXPECT_LT(touching, 750);
}

TEST(Clearance, CountsLargeLeavesWhole) {
  auto tree = std::make_unique<octomap::OcTree>(kVoxel_m);
  for (int x = 0; x < 16; ++x) {
    for (int y = 0; y < 16; ++y) {
      for (int z = 0; z < 16; ++z) {
        tree->updateNode(octomap::point3d(float(x) * 0.1F + 0.05F, float(y) * 0.1F + 0.05F,
                                          float(z) * 0.1F + 0.05F),
                         true);
      }
    }
  }
  tree->prune();
  ASSERT_LT(tree->getNumLeafNodes(), 4096U);
  const auto v = judge(std::move(tree), {at(0.0, Vec3(2.0, 0.83, 0.83))});
  EXPECT_NEAR(v.clearance_m, 0.4 - 0.15, kClose_m);
}

TEST(Clearance, SeesLeavesWhoseInnerNodesAreStale) {
  auto tree = std::make_unique<octomap::OcTree>(kVoxel_m);
  const bool lazy = true;
  tree->updateNode(octomap::point3d(5.05F, 5.05F, 5.05F), false, lazy);
  tree->updateNode(octomap::point3d(1.05F, 0.05F, 0.05F), true, lazy);
  EXPECT_NEAR(judge(std::move(tree), {at(0.0, Vec3(0.0, 0.05, 0.05))}).clearance_m, 0.85, kClose_m);
}

TEST(Clearance, IsInfiniteWhereThereIsNoObstacle) {
  auto tree = std::make_unique<octomap::OcTree>(kVoxel_m);
  tree->updateNode(octomap::point3d(0.05F, 0.05F, 0.05F), false);
  const auto v = judge(std::move(tree), {at(0.0, Vec3(1, 1, 1)), at(1.0, Vec3(2, 1, 1))});
  EXPECT_FALSE(v.touched);
  EXPECT_TRUE(std::isinf(v.clearance_m));
}

TEST(Clearance, UnknownAndOutsideAreFreeOrObstaclesAsAsked) {
  const auto free_block = [] {
    auto tree = std::make_unique<octomap::OcTree>(kVoxel_m);
    for (int x = -10; x < 10; ++x) {
      for (int y = -10; y < 10; ++y) {
        for (int z = -10; z < 10; ++z) {
          tree->updateNode(octomap::point3d(float(x) * 0.1F + 0.05F, float(y) * 0.1F + 0.05F,
                                            float(z) * 0.1F + 0.05F),
                           false);
        }
      }
    }
    tree->prune();
    return tree;
  };
  const std::vector<Sample> inside{at(0.0, Vec3(0.31, 0.02, 0.03))};
  const std::vector<Sample> leaving{at(0.0, Vec3(0, 0, 0)), at(1.0, Vec3(5, 0, 0))};
  const Options strict{.count_unknown_as_obstacle = true};
  EXPECT_TRUE(std::isinf(judge(free_block(), inside).clearance_m));
  EXPECT_NEAR(judge(free_block(), inside, {}, strict).clearance_m, 1.0 - 0.31 - 0.15, 1e-3);
  EXPECT_FALSE(judge(free_block(), leaving).touched);
  const auto v = judge(free_block(), leaving, {}, strict);
  EXPECT_TRUE(v.touched);
  EXPECT_NEAR(v.clearance_t_s, (1.0 - 0.15) / 5.0, 1e-3);
}

}  // namespace
}  // namespace goshawk::flight_check::test
