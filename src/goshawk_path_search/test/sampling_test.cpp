// Sampling planners, and the validity of segments that they ask for: the grid's own, and FCL's.
#include <gtest/gtest.h>

#include <limits>

#include "goshawk/core/line_of_sight.hpp"
#include "goshawk/path_search/segment_validity.hpp"
#include "reference.hpp"
#include "stage_on.hpp"

namespace goshawk::path_search {
namespace {

using reference::grid_of;
using reference::Random;

TEST(SamplingPlanners, FindFreePathsThatRepeatBitForBit) {
  Random random(32);
  const auto grid = grid_of(reference::box_map({40, 40, 12}, 0.15, random));
  for (const Planner planner : {Planner::rrt, Planner::rrtstar, Planner::prm}) {
    Config config;
    config.planner = planner;
    config.pruning = Pruning::none;
    config.max_iterations = 1500;
    PathSearch search = stage_on(config, grid), again = stage_on(config, grid);
    int found = 0;
    for (int n = 0; n < 6; ++n) {
      const Vec3 start = grid->geometry.center(reference::free_voxel(grid->grown, random));
      const Vec3 goal = grid->geometry.center(reference::free_voxel(grid->grown, random));
      const auto path = search.plan(start, goal);
      const auto repeated = again.plan(start, goal);
      ASSERT_EQ(path.code(), repeated.code());
      if (!path.ok()) continue;
      ++found;
      EXPECT_EQ(path->raw_map, repeated->raw_map) << to_word(planner);
      EXPECT_EQ(path->raw_map, search.plan(start, goal)->raw_map)
          << to_word(planner) << ", same object";
      EXPECT_EQ(path->raw_map.front(), start);
      EXPECT_EQ(path->raw_map.back(), goal);
      for (std::size_t i = 1; i < path->raw_map.size(); ++i) {
        ASSERT_TRUE(line_is_free(*grid, path->raw_map[i - 1], path->raw_map[i]))
            << to_word(planner);
      }
    }
    EXPECT_GT(found, 3) << to_word(planner);
  }
}

// What FCL calls free is free on the grid; what keeps away from obstacles is free for both.
TEST(FclValidity, AgreesWithTheGridButForAHair) {
  Random random(33);
  int free_for_both = 0, blocked_for_both = 0;
  for (int n = 0; n < 60; ++n) {
    const BitGrid map = reference::any_map(random);
    const auto grid = make_grid_validity(map), fcl = make_fcl_validity(map);
    const Vec3 size(map.size().x, map.size().y, map.size().z);
    for (int k = 0; k < 60; ++k) {
      const auto any = [&] {
        return Vec3(random.uniform() * size.x(), random.uniform() * size.y(),
                    random.uniform() * size.z());
      };
      const Vec3 a = any();
      const Vec3 b = k % 4 == 0 ? a : k % 4 == 1 ? any() : Vec3(a + 0.1 * (any() - a));
      const bool exact = grid->is_free(a, b), by_fcl = fcl->is_free(a, b);
      if (by_fcl) {
        ASSERT_TRUE(exact) << "map " << n << ", " << a.transpose() << " to " << b.transpose();
      }
      free_for_both += exact && by_fcl;
      blocked_for_both += !exact && !by_fcl;
      // Free with all that lies within 4 of the capsule's radii: also free for FCL.
      bool clear = exact;
      for (int corner = 0; corner < 8; ++corner) {
        const Vec3 aside(corner & 1 ? 1 : -1, corner & 2 ? 1 : -1, corner & 4 ? 1 : -1);
        clear = clear && grid->is_free(a + 4.0 * kFclMargin * aside, b + 4.0 * kFclMargin * aside);
      }
      ASSERT_TRUE(!clear || by_fcl)
          << "map " << n << ", " << a.transpose() << " to " << b.transpose();
    }
  }
  EXPECT_GT(free_for_both, 300);
  EXPECT_GT(blocked_for_both, 300);
  const BitGrid map({2, 2, 2}, true);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(make_fcl_validity(map)->is_free(Vec3(nan, 1, 1), Vec3(1, 1, 1)));
}

TEST(FclValidity, GivesSamplingPlannersPathsThatAreFreeOnTheGrid) {
  Random random(34);
  const auto grid = grid_of(reference::box_map({30, 30, 10}, 0.15, random));
  for (const Planner planner : {Planner::rrt, Planner::rrtstar, Planner::prm}) {
    Config config;
    config.planner = planner;
    config.validity = Validity::fcl;
    config.pruning = Pruning::none;
    config.max_iterations = 400;
    PathSearch search = stage_on(config, grid), again = stage_on(config, grid);
    int found = 0;
    for (int n = 0; n < 4; ++n) {
      const Vec3 start = grid->geometry.center(reference::free_voxel(grid->grown, random));
      const Vec3 goal = grid->geometry.center(reference::free_voxel(grid->grown, random));
      const auto path = search.plan(start, goal);
      if (!path.ok()) continue;
      ++found;
      EXPECT_EQ(path->raw_map, again.plan(start, goal)->raw_map) << to_word(planner);
      for (std::size_t i = 1; i < path->raw_map.size(); ++i) {
        ASSERT_TRUE(line_is_free(*grid, path->raw_map[i - 1], path->raw_map[i]))
            << to_word(planner);
      }
    }
    EXPECT_GT(found, 1) << to_word(planner);
  }
}

}  // namespace
}  // namespace goshawk::path_search
