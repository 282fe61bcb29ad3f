#include "goshawk/path_search/path_reuse.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "goshawk/path_search/grid_search.hpp"
#include "reference.hpp"

namespace goshawk::path_search {
namespace {

using reference::Random;

void change(BitGrid& map, Random& random) {
  const Index3 size = map.size();
  for (int k = random.below(10); k > 0; --k) {
    map.set({random.below(size.x), random.below(size.y), random.below(size.z)}, random.chance(0.7));
  }
}

// The start moves along the path, or anywhere; the goal stays for a while; voxels change.
TEST(PathReuse, AnswersAsShortAsDijkstraWhateverChanges) {
  for (const CornerRule rule : {CornerRule::no_squeeze, CornerRule::squeeze}) {
    const bool squeeze = rule == CornerRule::squeeze;
    Random random(51);
    int reused = 0, searched = 0;
    for (int n = 0; n < 300; ++n) {
      const auto planner = make_reusing(make_grid_search(Planner::jastar, rule), rule);
      BitGrid map = n % 2 == 0 ? reference::any_map(random)
                               : reference::box_map({25, 20, 8}, random.uniform(0.1, 0.3), random);
      Index3 start = reference::free_voxel(map, random), goal = reference::free_voxel(map, random);
      VoxelPath path;
      for (int update = 0; update < 12; ++update) {
        planner->set_map(map);
        if (map.get(start) || map.get(goal)) {
          EXPECT_FALSE(planner->search(start, goal, path).ok());
          break;
        }
        const auto status = planner->search(start, goal, path);
        const auto truth = reference::distances(map, start, squeeze);
        const double expected = reference::distance_to(truth, map.size(), goal);
        ASSERT_EQ(status.code(), std::isinf(expected) ? ErrorCode::no_path : ErrorCode::ok);
        if (!status) break;
        ASSERT_NEAR(path.cost_voxels, expected, 1e-9 * (1.0 + expected)) << n << ", " << update;
        ASSERT_EQ(reference::fault_of_path(map, path.cells, start, goal, squeeze, path.cost_voxels),
                  "");
        ++(path.counters.expanded == 0 ? reused : searched);
        if (random.chance(0.8)) start = path.cells[path.cells.size() / 3];
        if (random.chance(0.1)) goal = reference::free_voxel(map, random);
        change(map, random);
      }
    }
    EXPECT_GT(reused, 200) << to_word(rule);
    EXPECT_GT(searched, 300) << to_word(rule);
  }
}

TEST(PathReuse, SearchesAgainForSeveralGoals) {
  const auto rule = CornerRule::no_squeeze;
  const auto planner = make_reusing(make_grid_search(Planner::jastar, rule), rule);
  planner->set_map(BitGrid({20, 5, 5}, true));
  VoxelPath path;
  ASSERT_TRUE(planner->search({0, 2, 2}, {19, 2, 2}, path).ok());
  ASSERT_TRUE(planner->search({4, 2, 2}, {19, 2, 2}, path).ok());
  EXPECT_EQ(path.counters.expanded, 0);
  EXPECT_EQ(path.cells.size(), 16U);
  const std::vector<End> goals = {End::center_of({19, 2, 2}), End::center_of({5, 2, 2})};
  ASSERT_TRUE(
      planner->search({.start = End::center_of({4, 2, 2}), .goals = goals, .stop = {}}, path).ok());
  EXPECT_EQ(path.cells.size(), 2U);
  EXPECT_EQ(path.goal, 1U);
}

}  // namespace
}  // namespace goshawk::path_search
