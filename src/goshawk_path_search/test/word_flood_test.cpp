#include "goshawk/path_search/word_flood.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "goshawk/path_search/planner.hpp"
#include "reference.hpp"

namespace goshawk::path_search {
namespace {

using reference::Random;

BitGrid map_for_floods(Random& random, int n) {
  if (n % 25 == 0) return reference::noise_map({200, 12, 11}, random.uniform(0.3, 0.8), random);
  return reference::any_map(random);
}

// Which voxels Dijkstra reaches from the sources, against what the flood holds once it is closed.
void expect_truth(const WordFlood& flood, const BitGrid& map, bool squeeze,
                  const std::vector<Index3>& sources) {
  std::vector<std::vector<double>> truth;
  for (const Index3 source : sources) {
    truth.push_back(reference::distances(map, source, squeeze));
  }
  for (int z = 0; z < map.size().z; ++z) {
    for (int y = 0; y < map.size().y; ++y) {
      for (int x = 0; x < map.size().x; ++x) {
        const Index3 at{x, y, z};
        const bool reached = std::ranges::any_of(truth, [&](const std::vector<double>& from) {
          return !std::isinf(reference::distance_to(from, map.size(), at));
        });
        ASSERT_EQ(flood.contains(at), reached) << to_text(at) << " of " << to_text(map.size());
      }
    }
  }
}

// One object for all maps of a rule, so that sizes and floods follow each other.
TEST(WordFlood, MeetsWhatDijkstraReachesAndFillsTheRest) {
  for (const bool squeeze : {false, true}) {
    Random random(61);
    WordFlood flood(squeeze ? CornerRule::squeeze : CornerRule::no_squeeze);
    int met = 0, closed = 0;
    for (int n = 0; n < 1000; ++n) {
      const BitGrid map = map_for_floods(random, n);
      const Index3 wanted = reference::free_voxel(map, random);
      std::vector<Index3> sources;
      for (int k = 1 + random.below(3); k > 0; --k) {
        sources.push_back(reference::free_voxel(map, random));
      }
      if (map.get(wanted)) continue;
      if (std::ranges::any_of(sources, [&](Index3 s) { return map.get(s); })) continue;
      flood.forget();
      ASSERT_TRUE(flood.start(map, wanted));
      for (const Index3 source : sources) flood.add_source(map, source);
      while (flood.advance(map, 1 + random.below(5)) == WordFlood::State::open) continue;
      const auto truth = reference::distances(map, wanted, squeeze);
      const bool joined = std::ranges::any_of(sources, [&](Index3 s) {
        return !std::isinf(reference::distance_to(truth, map.size(), s));
      });
      ASSERT_EQ(flood.state() == WordFlood::State::met, joined) << "map " << n;
      ++(joined ? met : closed);
      if (!joined) expect_truth(flood, map, squeeze, sources);
      for (const Index3 source : sources) {
        ASSERT_EQ(flood.joins(wanted, source), joined && sources.size() == 1);
      }
      if (HasFatalFailure()) FAIL() << "map " << n;
    }
    EXPECT_GT(met, 50);
    EXPECT_GT(closed, 50);
  }
}

TEST(WordFlood, DoesNoMoreWordsThanAsked) {
  WordFlood flood(CornerRule::no_squeeze);
  const BitGrid map({640, 20, 20}, true);
  ASSERT_TRUE(flood.start(map, {639, 19, 19}));
  flood.add_source(map, {0, 0, 0});
  EXPECT_EQ(flood.advance(map, 7), WordFlood::State::open);
  EXPECT_EQ(flood.words_done(), 7);
  EXPECT_EQ(flood.advance(map, 1000), WordFlood::State::met);
  EXPECT_LT(flood.words_done(), 100);  // straight towards the wanted voxel
}

// A goal in a closed room of a large map: the room is full long before the components of the map
// are known, and the next query for it ends at once; until the room has a door.
TEST(WordFlood, EndsTheSearchForAGoalInAClosedRoom) {
  for (const CornerRule rule : {CornerRule::no_squeeze, CornerRule::squeeze}) {
    BitGrid map({500, 500, 50}, true);
    for (int z = 0; z < 20; ++z) {
      for (int y = 400; y < 460; ++y) {
        const bool wall = z == 19 || y == 400 || y == 459;
        map.set_run(300, wall ? 400 : 301, y, z, true);
        if (!wall) map.set_run(399, 400, y, z, true);
      }
    }
    Config config;
    config.corner_rule = rule;
    const auto planner = std::move(make_planner(config)).value();
    planner->set_map(map);
    const Index3 start{10, 10, 10}, inside{350, 430, 10}, outside{490, 490, 40};
    VoxelPath path;
    EXPECT_EQ(planner->search(start, inside, path).code(), ErrorCode::no_path);
    EXPECT_GT(path.counters.expanded, 0);
    EXPECT_LT(path.counters.expanded, 10'000);
    EXPECT_EQ(planner->search(start, inside, path).code(), ErrorCode::no_path);
    EXPECT_EQ(path.counters.expanded, 0);
    EXPECT_TRUE(planner->search(start, outside, path).ok());
    EXPECT_TRUE(planner->search(inside, {310, 410, 1}, path).ok());
    const End goals[] = {End::center_of(inside), End::center_of(outside)};
    const GridQuery either{.start = End::center_of(start), .goals = goals, .stop = {}};
    ASSERT_TRUE(planner->search(either, path).ok());
    EXPECT_EQ(path.goal, 1U);
    map.set_run(300, 301, 430, 10, false);
    planner->set_map(map);
    EXPECT_TRUE(planner->search(start, inside, path).ok());
  }
}

}  // namespace
}  // namespace goshawk::path_search
