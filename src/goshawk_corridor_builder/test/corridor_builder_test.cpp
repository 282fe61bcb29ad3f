#include "goshawk/corridor_builder/corridor_builder.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "support/corridor_checker.hpp"
#include "support/worlds.hpp"

namespace goshawk::corridor_builder {
namespace {

using support::faults_of;
using ::testing::HasSubstr;

CorridorBuilder builder_of(const Config& config) {
  return std::move(CorridorBuilder::create(config)).value();
}

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
        support::random_free_path(grid, 1 + random.below(4), random.uniform(0.3, 6.0), random);
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
  VoxelGrid grid = support::empty_world(size, resolution_m, origin);
  if (kind == 0) support::add_noise(grid, random.uniform(0.0, 0.3), random);
  if (kind == 1) {
    grid = support::boxes_and_pillars(size, resolution_m, random.uniform(0.1, 0.5), resolution_m,
                                      random.next());
  }
  if (kind == 2) {
    grid = support::forest(size, resolution_m, 1 + random.below(12), resolution_m, random.next());
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

TEST(CorridorBuilder, NeverCutsIntoAnObstacleWithOtherSettings) {
  Tally tally;
  prove_many({.local_box_m = 1.0, .growth_passes = 0}, 2, 45, 10, tally);
  prove_many({.growth_passes = 3, .drop_covered = false}, 3, 45, 10, tally);
  prove_many({.max_segment_m = 0.7, .max_faces = 10}, 4, 45, 10, tally);
  EXPECT_GE(tally.segments, 1500);
}

TEST(CorridorBuilder, BoxesNeverCutIntoAnObstacle) {
  Tally tally;
  prove_many({.generator = "box"}, 5, 150, 15, tally);
  EXPECT_GE(tally.segments, 3000);
  EXPECT_EQ(tally.disjoint, 0);
}

}  // namespace
}  // namespace goshawk::corridor_builder
