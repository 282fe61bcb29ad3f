#include "goshawk/corridor_builder/corridor_builder.hpp"

#include <gtest/gtest.h>

#include "support/builders.hpp"
#include "support/corridor_checker.hpp"
#include "support/worlds.hpp"

namespace goshawk::corridor_builder {
namespace {

using test_support::builder_of;
using test_support::faults_of;
using test_support::world_with_wall;

struct Tally {
  int segments = 0;
  int corridors = 0;
  int disjoint = 0;
};

// Corridors around random free paths of one world, each proven by the independent checker.
void prove(CorridorBuilder& builder, const VoxelGrid& grid, int paths, Random& random,
           Tally& tally) {
  for (int k = 0; k < paths; ++k) {
    const auto path =
        test_support::random_free_path(grid, 1 + random.below(4), random.uniform(0.3, 6.0), random);
    if (path.empty()) continue;
    const auto corridor = builder.build(grid, path);
    if (!corridor.ok()) {
      ASSERT_EQ(corridor.code(), ErrorCode::corridor_disjoint) << corridor.error().message;
      ++tally.disjoint;
      continue;
    }
    ++tally.corridors;
    tally.segments += int(path.size()) - 1;
    ASSERT_EQ(faults_of(*corridor, grid, path), "") << "path " << k;
  }
}

VoxelGrid random_world(int kind, Random& random) {
  const double resolution_m = random.chance(0.5) ? 0.2 : random.uniform(0.05, 0.5);
  const Vec3 origin(random.uniform(-50, 50), random.uniform(-50, 50), random.uniform(-5, 5));
  const Index3 size{8 + random.below(60), 8 + random.below(40), 4 + random.below(20)};
  VoxelGrid grid = test_support::empty_world(size, resolution_m, origin);
  if (kind == 0) test_support::add_noise(grid, random.uniform(0.0, 0.3), random);
  if (kind == 1) {
    grid = test_support::boxes_and_pillars(size, resolution_m, random.uniform(0.1, 0.5),
                                           resolution_m, random.next());
  }
  if (kind == 2) {
    grid =
        test_support::forest(size, resolution_m, 1 + random.below(12), resolution_m, random.next());
  }
  grid.geometry.origin_map = origin;
  return grid;
}

void prove_many(const Config& config, std::uint64_t seed, int worlds, int paths, Tally& tally) {
  CorridorBuilder builder = builder_of(config);
  Random random(seed);
  for (int w = 0; w < worlds; ++w) {
    const VoxelGrid grid = random_world(w % 3, random);
    ASSERT_NO_FATAL_FAILURE(prove(builder, grid, paths, random, tally)) << "world " << w;
  }
}

TEST(CorridorBuilder, NeverCutsIntoAnObstacleOnTenThousandRandomSegments) {
  Tally tally;
  prove_many(Config{}, 1, 300, 20, tally);
  EXPECT_GE(tally.segments, 10000);
  EXPECT_LE(tally.disjoint, tally.corridors / 100);
  RecordProperty("segments", tally.segments);
}

// A checker that finds nothing wrong proves little unless it sees what is wrong.
TEST(CorridorBuilder, TheCheckerSeesPlanesThatAreAMicrometreTooFarOut) {
  CorridorBuilder builder = builder_of({});
  Random random(8);
  const VoxelGrid grid = test_support::boxes_and_pillars({30, 40, 20}, 0.2, 0.4, 0.2, 1);
  for (int k = 0; k < 20; ++k) {
    const auto path = test_support::random_free_path(grid, 2, 3.0, random);
    if (path.empty()) continue;
    auto corridor = builder.build(grid, path);
    ASSERT_TRUE(corridor.ok());
    EXPECT_EQ(faults_of(*corridor, grid, path), "");
    for (Polytope& polytope : corridor->polytopes) {
      for (HalfSpace& face : polytope.half_spaces) face.offset_m += 1e-6;
    }
    EXPECT_NE(faults_of(*corridor, grid, path), "");
  }
}

TEST(CorridorBuilder, NeverCutsIntoAnObstacleWithOtherSettings) {
  Tally tally;
  prove_many({.local_box_m = 1.0, .expansion_passes = 0}, 2, 45, 10, tally);
  prove_many({.expansion_passes = 3, .drop_covered = false}, 3, 45, 10, tally);
  prove_many({.max_segment_m = 0.7, .max_faces = 10}, 4, 45, 10, tally);
  EXPECT_GE(tally.segments, 1500);
}

TEST(CorridorBuilder, BoxesNeverCutIntoAnObstacle) {
  Tally tally;
  prove_many({.generator = Generator::box}, 5, 150, 15, tally);
  EXPECT_GE(tally.segments, 3000);
  EXPECT_EQ(tally.disjoint, 0);
}

// The least free ball along the path is half a voxel, for all its voxels and their faces are free;
// so no overlap needs to be smaller. Passages of one voxel are the narrowest that there are.
TEST(CorridorBuilder, NeighboursShareABallOfHalfAVoxelWhereverTheGridAllowsIt) {
  CorridorBuilder builder = builder_of({});
  Random random(21);
  int overlaps = 0, narrow = 0, fallen_short = 0;
  for (int w = 0; w < 60; ++w) {
    const VoxelGrid grid = random_world(w % 3, random);
    const double half_voxel_m = 0.5 * grid.geometry.resolution_m;
    for (int k = 0; k < 15; ++k) {
      const auto path = test_support::random_free_path(grid, 4, 4.0, random);
      if (path.empty()) continue;
      const auto corridor = builder.build(grid, path);
      if (!corridor.ok()) continue;
      for (const Ball& ball : corridor->overlaps) {
        ++overlaps;
        narrow += ball.radius_m < 1.001 * half_voxel_m;
        fallen_short += ball.radius_m < (1.0 - 1e-5) * half_voxel_m;
      }
    }
  }
  EXPECT_GT(overlaps, 500);
  EXPECT_GT(narrow, 20);  // half a voxel is all there is
  EXPECT_EQ(fallen_short, 0);
}

TEST(CorridorBuilder, FollowsATunnelOfOneVoxelWithHalfAVoxelAtEveryTurn) {
  VoxelGrid grid = test_support::empty_world({12, 12, 12}, 0.2);
  test_support::fill(grid, {0, 0, 0}, {12, 12, 12});
  std::vector<Vec3> path;
  for (int k = 1; k < 10; ++k) {  // a staircase, one voxel along each axis in turn
    for (const Index3 i : {Index3{k, k, k}, Index3{k + 1, k, k}, Index3{k + 1, k + 1, k}}) {
      grid.grown.set(i, false);
      path.push_back(grid.geometry.center(i));
    }
  }
  const auto corridor = builder_of({}).build(grid, path);
  ASSERT_TRUE(corridor.ok()) << corridor.error().message;
  EXPECT_EQ(faults_of(*corridor, grid, path), "");
  EXPECT_GT(corridor->min_overlap_radius_m(), (1.0 - 1e-5) * 0.1);
  EXPECT_LT(corridor->min_overlap_radius_m(), 0.1);
}

TEST(CorridorBuilder, FillsAnEmptyWorldWithOnePolytope) {
  const VoxelGrid grid = test_support::empty_world({10, 10, 10}, 0.2);
  const std::vector<Vec3> path{{0.1, 0.1, 0.1}, {1.9, 0.1, 0.1}, {1.9, 1.9, 1.9}};
  const auto corridor = builder_of({}).build(grid, path);
  ASSERT_TRUE(corridor.ok()) << corridor.error().message;
  ASSERT_EQ(corridor->polytopes.size(), 1U);
  EXPECT_EQ(corridor->polytopes[0].faces(), 6);
  EXPECT_NEAR(test_support::volume_of(corridor->polytopes[0]), 8.0, 1e-5);
}

TEST(CorridorBuilder, PolytopesAndOverlapsAreLargeWhereThereIsRoom) {
  const VoxelGrid grid = world_with_wall();  // free above the wall
  const std::vector<Vec3> path{{1.1, 1.1, 0.5}, {1.5, 1.1, 1.5}, {2.7, 1.1, 1.5}, {3.1, 1.1, 0.5}};
  const auto corridor = builder_of({}).build(grid, path);
  ASSERT_TRUE(corridor.ok()) << corridor.error().message;
  EXPECT_EQ(faults_of(*corridor, grid, path), "");
  EXPECT_LE(corridor->polytopes.size(), 3U);
  EXPECT_GT(corridor->min_overlap_radius_m(), 0.3);
}

TEST(CorridorBuilder, ANewConfigBuildsAsOneThatBeganWithIt) {
  const VoxelGrid grid = world_with_wall();
  const std::vector<Vec3> path{{1.1, 1.1, 0.5}, {1.5, 1.1, 1.5}, {2.7, 1.1, 1.5}, {3.1, 1.1, 0.5}};
  Config boxes;
  boxes.generator = Generator::box;
  CorridorBuilder builder = builder_of({});
  ASSERT_TRUE(builder.build(grid, path));
  ASSERT_TRUE(builder.reconfigure(boxes));
  EXPECT_EQ(builder.implementation(), "box");
  const auto wanted = builder_of(boxes).build(grid, path), got = builder.build(grid, path);
  ASSERT_TRUE(wanted && got);
  ASSERT_EQ(got->polytopes.size(), wanted->polytopes.size());
  for (std::size_t k = 0; k < got->polytopes.size(); ++k) {
    EXPECT_EQ(got->polytopes[k], wanted->polytopes[k]);
  }
  Config bad;
  bad.max_faces = 3;
  EXPECT_EQ(builder.reconfigure(bad).code(), ErrorCode::invalid_parameter);
  EXPECT_EQ(builder.implementation(), "box");
}

}  // namespace
}  // namespace goshawk::corridor_builder
