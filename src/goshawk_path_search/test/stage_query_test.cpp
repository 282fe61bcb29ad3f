// What users ask of the stage, in metres: moved ends, box, cut-off goals, faults.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "goshawk/core/line_of_sight.hpp"
#include "reference.hpp"
#include "stage_on.hpp"

namespace goshawk::path_search {
namespace {

using reference::grid_of;
using reference::Random;
using testing::HasSubstr;

// A wall across x = 5 of a 10 x 5 x 5 map.
BitGrid walled() {
  BitGrid blocked({10, 5, 5}, true);
  for (int z = 0; z < 5; ++z) {
    for (int y = 0; y < 5; ++y) blocked.set({5, y, z}, true);
  }
  return blocked;
}

TEST(MovedEnds, GoToTheNearestFreeVoxelWithinTheRadius) {
  Random random(31);
  Config config;
  config.move_within_m = 0.5;
  int moved = 0;
  for (int n = 0; n < 600; ++n) {
    const auto grid = grid_of(reference::any_map(random));
    PathSearch search = stage_on(config, grid);
    const Index3 s = grid->geometry.size;
    const auto any = [&] {
      return Vec3(grid->geometry.lower_corner({0, 0, 0}) + 0.2 * Vec3(random.uniform() * s.x,
                                                                      random.uniform() * s.y,
                                                                      random.uniform() * s.z));
    };
    const Vec3 start = any(), goal = any();
    const auto path = search.plan(start, goal);
    double nearest = std::numeric_limits<double>::infinity();
    for (int z = 0; z < s.z; ++z) {
      for (int y = 0; y < s.y; ++y) {
        for (int x = 0; x < s.x; ++x) {
          if (grid->grown.get({x, y, z})) continue;
          nearest = std::min(nearest, (grid->geometry.center({x, y, z}) - goal).norm());
        }
      }
    }
    if (path.code() == ErrorCode::goal_occupied) {
      ASSERT_GT(nearest, 0.5 - 1e-9);
    }
    if (!path.ok()) continue;
    ASSERT_NEAR(path->goal_moved_m, (path->waypoints_map.back() - goal).norm(), 1e-12);
    ASSERT_NEAR(path->start_moved_m, (path->waypoints_map.front() - start).norm(), 1e-12);
    for (std::size_t i = 1; i < path->waypoints_map.size(); ++i) {
      ASSERT_TRUE(line_is_free(*grid, path->waypoints_map[i - 1], path->waypoints_map[i]));
    }
    if (path->goal_moved_m == 0.0) continue;
    ++moved;
    ASSERT_NEAR(path->goal_moved_m, nearest, 1e-12);
    ASSERT_THAT(path->note(), HasSubstr("goal moved by"));
  }
  EXPECT_GT(moved, 50);
}

TEST(MovedEnds, StayWhereTheyAreUnlessAsked) {
  const auto grid = grid_of(walled());
  const Vec3 free = grid->geometry.center({1, 1, 1}), wall = grid->geometry.center({5, 2, 2});
  EXPECT_EQ(stage_on({}, grid).plan(free, wall).code(), ErrorCode::goal_occupied);
  EXPECT_EQ(stage_on({}, grid).plan(wall, free).code(), ErrorCode::start_occupied);
  Config config;
  config.move_within_m = 0.19;
  const auto too_far = stage_on(config, grid).plan(free, wall);
  EXPECT_EQ(too_far.code(), ErrorCode::goal_occupied);
  EXPECT_THAT(too_far.error().message, HasSubstr("move_within_m"));
  config.move_within_m = 0.21;
  const auto path = stage_on(config, grid).plan(free, wall);
  ASSERT_TRUE(path.ok());
  EXPECT_EQ(path->waypoints_map.back(), grid->geometry.center({4, 2, 2}));
  EXPECT_EQ(stage_on(config, grid).plan(free, free + Vec3(50, 0, 0)).code(), ErrorCode::goal_outside);
}

TEST(SeveralGoals, MayContainSomeThatAreBlockedOrCutOff) {
  const auto grid = grid_of(walled());
  PathSearch search = stage_on({}, grid);
  const GridGeometry& g = grid->geometry;
  const std::vector<Vec3> goals = {g.center({5, 2, 2}), g.center({8, 2, 2}), g.center({1, 4, 4})};
  const auto path = search.plan({.start_map = g.center({1, 1, 1}), .goals_map = goals});
  ASSERT_TRUE(path.ok()) << path.error().message;
  EXPECT_EQ(path->goal, 2U);
  EXPECT_EQ(path->waypoints_map.back(), goals[2]);
  const std::span<const Vec3> blocked(goals.data(), 1);
  EXPECT_EQ(search.plan({.start_map = goals[2], .goals_map = blocked}).code(),
            ErrorCode::goal_occupied);
  EXPECT_EQ(search.plan({.start_map = goals[2], .goals_map = {}}).code(), ErrorCode::invalid_input);
}

TEST(CutOffGoals, AreApproachedOnRequest) {
  const auto grid = grid_of(walled());
  const GridGeometry& g = grid->geometry;
  const Vec3 start = g.center({1, 1, 1}), goal = g.center({8, 2, 3});
  EXPECT_EQ(stage_on({}, grid).plan(start, goal).code(), ErrorCode::no_path);
  Config config;
  config.nearest_reachable = true;
  for (const Planner planner : {Planner::jastar, Planner::dijkstra, Planner::rrtstar}) {
    config.planner = planner;
    config.max_iterations = 300;
    const auto path = stage_on(config, grid).plan(start, goal);
    ASSERT_TRUE(path.ok()) << path.error().message;
    EXPECT_TRUE(path->cut_off);
    EXPECT_EQ(path->waypoints_map.back(), g.center({4, 2, 3}));
    EXPECT_NEAR(path->goal_moved_m, 0.8, 1e-12);
    EXPECT_THAT(path->note(), HasSubstr("no goal can be reached"));
  }
  PathSearch search = stage_on(config, grid);
  const auto stay = search.plan(g.center({4, 2, 3}), goal);
  ASSERT_TRUE(stay.ok());
  EXPECT_EQ(stay->waypoints_map.size(), 2U);
  EXPECT_TRUE(stay->cut_off);
  EXPECT_FALSE(search.plan(start, start)->cut_off) << "of the query before";
}

TEST(SearchBox, KeepsThePathInside) {
  // The short way round the wall is above it, outside the box.
  BitGrid blocked({20, 20, 10}, true);
  for (int y = 0; y < 19; ++y) {
    for (int z = 0; z < 9; ++z) blocked.set({10, y, z}, true);
  }
  const auto grid = grid_of(blocked);
  const GridGeometry& g = grid->geometry;
  const Vec3 start = g.center({5, 10, 7}), goal = g.center({15, 10, 7});
  const auto over = stage_on({}, grid).plan(start, goal);
  ASSERT_TRUE(over.ok());
  Config config;
  config.search_box = "-1,2,0.5,3,6,2.2";  // all but the layers above the wall
  PathSearch search = stage_on(config, grid);
  const auto around = search.plan(start, goal);
  ASSERT_TRUE(around.ok()) << around.error().message;
  EXPECT_GT(around->cost, over->cost + 0.5);
  for (const Vec3& p : around->raw_map) EXPECT_LT(p.z(), 2.2);
  const auto outside = search.plan(start, g.center({15, 10, 9}));
  EXPECT_EQ(outside.code(), ErrorCode::goal_outside);
  EXPECT_THAT(outside.error().message, HasSubstr("search_box"));
  config.search_box = "50,50,50,60,60,60";
  EXPECT_EQ(stage_on(config, grid).plan(start, goal).code(), ErrorCode::map_empty);
}

TEST(Config, RefusesEveryWrongNumberAtOnce) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (double Config::*field :
       {&Config::z_weight, &Config::unknown_weight, &Config::clearance_m, &Config::clearance_weight,
        &Config::move_within_m, &Config::time_limit_s, &Config::step_m}) {
    for (const double wrong : {-1.0, nan, std::numeric_limits<double>::infinity()}) {
      Config config;
      config.*field = wrong;
      EXPECT_EQ(PathSearch::create(config).code(), ErrorCode::invalid_parameter) << wrong;
    }
  }
  for (const auto* box : {"1", "0,0,0,1,1", "0,0,0,1,1,1,1", "0,0,0,1,1,x", "0,0,0,0,1,1",
                          "nan,0,0,1,1,1", "0,0,0,inf,1,1", "0,0,0,1,1,1,"}) {
    Config config;
    config.search_box = box;
    EXPECT_EQ(PathSearch::create(config).code(), ErrorCode::invalid_parameter) << box;
  }
  Config config;
  config.z_weight = -1.0;
  config.max_iterations = 0;
  const auto both = PathSearch::create(config);
  ASSERT_FALSE(both.ok());
  EXPECT_THAT(both.error().message, HasSubstr("z_weight"));
  EXPECT_THAT(both.error().message, HasSubstr("max_iterations"));
}

}  // namespace
}  // namespace goshawk::path_search
