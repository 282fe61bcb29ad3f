#include "goshawk/path_search/components.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "goshawk/path_search/planner.hpp"
#include "reference.hpp"

namespace goshawk::path_search {
namespace {

using reference::Random;

constexpr int kAllBricks = 1 << 30;

// Which voxels Dijkstra reaches from one voxel, against what the components say of it.
void expect_truth_from(const Components& components, const BitGrid& map, Index3 from,
                       bool squeeze) {
  const auto truth = reference::distances(map, from, squeeze);
  for (int z = 0; z < map.size().z; ++z) {
    for (int y = 0; y < map.size().y; ++y) {
      for (int x = 0; x < map.size().x; ++x) {
        if (map.get({x, y, z})) continue;
        const bool reached = !std::isinf(reference::distance_to(truth, map.size(), {x, y, z}));
        ASSERT_EQ(components.joined(from, {x, y, z}), reached)
            << to_text(from) << " to " << to_text(Index3{x, y, z}) << " of " << to_text(map.size());
      }
    }
  }
}

TEST(Components, JoinWhatDijkstraJoins) {
  for (const bool squeeze : {false, true}) {
    Random random(31);
    for (int n = 0; n < 1500; ++n) {
      BitGrid map = reference::any_map(random);
      if (n % 10 == 0) map = reference::noise_map({130, 20, 17}, random.uniform(0.3, 0.8), random);
      const Index3 from = reference::free_voxel(map, random);
      if (map.get(from)) continue;
      Components components(squeeze ? CornerRule::squeeze : CornerRule::no_squeeze);
      ASSERT_TRUE(components.advance(map, kAllBricks));
      expect_truth_from(components, map, from, squeeze);
      if (HasFatalFailure()) FAIL() << "map " << n;
    }
  }
}

TEST(Components, FollowAMapThatChangesInPortions) {
  for (const bool squeeze : {false, true}) {
    Random random(32);
    Components components(squeeze ? CornerRule::squeeze : CornerRule::no_squeeze);
    BitGrid map = reference::noise_map({150, 20, 19}, squeeze ? 0.75 : 0.6, random);
    for (int update = 0; update < 60; ++update) {
      for (int k = random.below(40); k > 0; --k) {
        map.set({random.below(150), random.below(20), random.below(19)}, random.chance(0.5));
      }
      components.forget();
      ASSERT_FALSE(components.ready());
      // Now and then the map changes before the work on the last one is done.
      for (int left = random.below(30); left > 0 && !components.advance(map, 1); --left) continue;
      if (random.chance(0.3)) continue;
      while (!components.advance(map, 3)) continue;
      const Index3 from = reference::free_voxel(map, random);
      if (map.get(from)) continue;
      expect_truth_from(components, map, from, squeeze);
      if (HasFatalFailure()) FAIL() << "update " << update;
    }
  }
}

TEST(Components, OfAnotherSizeAreFoundAnew) {
  Components components(CornerRule::no_squeeze);
  BitGrid map({70, 9, 1}, true);
  ASSERT_TRUE(components.advance(map, kAllBricks));
  EXPECT_TRUE(components.joined({0, 0, 0}, {69, 8, 0}));
  map = BitGrid({3, 40, 1}, true);
  map.set_run(0, 3, 20, 0, true);
  components.forget();
  ASSERT_TRUE(components.advance(map, kAllBricks));
  EXPECT_FALSE(components.joined({0, 0, 0}, {0, 39, 0}));
  EXPECT_TRUE(components.joined({0, 21, 0}, {2, 39, 0}));
}

// A wall cuts a map of 12.5 million voxels in two: the search learns of it long before it has
// looked at one half, and the next one at once; a hole in the wall is found as well.
TEST(Components, EndAHopelessSearchEarly) {
  for (const CornerRule rule : {CornerRule::no_squeeze, CornerRule::squeeze}) {
    BitGrid map({500, 500, 50}, true);
    for (int z = 0; z < 50; ++z) {
      for (int y = 0; y < 500; ++y) map.set_run(250, 252, y, z, true);
    }
    Config config;
    config.corner_rule = rule;
    const auto planner = std::move(make_planner(config)).value();
    planner->set_map(map);
    VoxelPath path;
    EXPECT_EQ(planner->search({10, 250, 25}, {490, 250, 25}, path).code(), ErrorCode::no_path);
    EXPECT_GT(path.counters.expanded, 0);
    EXPECT_LT(path.counters.expanded, 50'000);
    EXPECT_EQ(planner->search({10, 250, 25}, {490, 250, 25}, path).code(), ErrorCode::no_path);
    EXPECT_EQ(path.counters.expanded, 0);
    map.set_run(250, 252, 250, 25, false);
    planner->set_map(map);
    EXPECT_TRUE(planner->search({10, 250, 25}, {490, 250, 25}, path).ok());
  }
}

}  // namespace
}  // namespace goshawk::path_search
