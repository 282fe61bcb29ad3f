// What users ask of the stage, in metres: moved ends, box, unknown space, cut-off goals, faults.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "goshawk/core/line_of_sight.hpp"
#include "goshawk/path_search/path_search.hpp"
#include "goshawk/path_search/segment_validity.hpp"
#include "reference.hpp"

namespace goshawk::path_search {
namespace {

using reference::grid_of;
using reference::Random;
using testing::HasSubstr;

PathSearch stage(const Config& config, std::shared_ptr<const VoxelGrid> map) {
  PathSearch search = std::move(PathSearch::create(config)).value();
  search.set_map(std::move(map));
  return search;
}

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
    PathSearch search = stage(config, grid);
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
  EXPECT_EQ(stage({}, grid).plan(free, wall).code(), ErrorCode::goal_occupied);
  EXPECT_EQ(stage({}, grid).plan(wall, free).code(), ErrorCode::start_occupied);
  Config config;
  config.move_within_m = 0.19;
  const auto too_far = stage(config, grid).plan(free, wall);
  EXPECT_EQ(too_far.code(), ErrorCode::goal_occupied);
  EXPECT_THAT(too_far.error().message, HasSubstr("move_within_m"));
  config.move_within_m = 0.21;
  const auto path = stage(config, grid).plan(free, wall);
  ASSERT_TRUE(path.ok());
  EXPECT_EQ(path->waypoints_map.back(), grid->geometry.center({4, 2, 2}));
  EXPECT_EQ(stage(config, grid).plan(free, free + Vec3(50, 0, 0)).code(), ErrorCode::goal_outside);
}

TEST(SeveralGoals, MayContainSomeThatAreBlockedOrCutOff) {
  const auto grid = grid_of(walled());
  PathSearch search = stage({}, grid);
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
  EXPECT_EQ(stage({}, grid).plan(start, goal).code(), ErrorCode::no_path);
  Config config;
  config.nearest_reachable = true;
  for (const Planner planner : {Planner::jastar, Planner::dijkstra, Planner::rrtstar}) {
    config.planner = planner;
    config.max_iterations = 300;
    const auto path = stage(config, grid).plan(start, goal);
    ASSERT_TRUE(path.ok()) << path.error().message;
    EXPECT_TRUE(path->cut_off);
    EXPECT_EQ(path->waypoints_map.back(), g.center({4, 2, 3}));
    EXPECT_NEAR(path->goal_moved_m, 0.8, 1e-12);
    EXPECT_THAT(path->note(), HasSubstr("no goal can be reached"));
  }
  PathSearch search = stage(config, grid);
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
  const auto over = stage({}, grid).plan(start, goal);
  ASSERT_TRUE(over.ok());
  Config config;
  config.search_box = "-1,2,0.5,3,6,2.2";  // all but the layers above the wall
  PathSearch search = stage(config, grid);
  const auto around = search.plan(start, goal);
  ASSERT_TRUE(around.ok()) << around.error().message;
  EXPECT_GT(around->cost, over->cost + 0.5);
  for (const Vec3& p : around->raw_map) EXPECT_LT(p.z(), 2.2);
  const auto outside = search.plan(start, g.center({15, 10, 9}));
  EXPECT_EQ(outside.code(), ErrorCode::goal_outside);
  EXPECT_THAT(outside.error().message, HasSubstr("search_box"));
  config.search_box = "50,50,50,60,60,60";
  EXPECT_EQ(stage(config, grid).plan(start, goal).code(), ErrorCode::map_empty);
}

// A corridor of 12 x 3 x 1 that leaves unknown space free; the middle of the straight way is
// not measured.
std::shared_ptr<VoxelGrid> half_known_corridor() {
  auto grid = grid_of(BitGrid({12, 3, 1}, true));
  grid->known = BitGrid({12, 3, 1}, false, true);
  for (int x = 3; x < 9; ++x) grid->known.set({x, 1, 0}, false);
  grid->unknown_is_occupied = false;
  return grid;
}

TEST(UnknownSpace, IsFreeBlockedOrCostly) {
  const auto grid = half_known_corridor();
  const Vec3 start = grid->geometry.center({0, 1, 0}), goal = grid->geometry.center({11, 1, 0});
  const auto cost = [&](UnknownRule unknown) {
    Config config;
    config.unknown = unknown;
    config.unknown_weight = 0.1;
    const auto path = stage(config, grid).plan(start, goal);
    return path.ok() ? path->cost / 0.2 : -1.0;
  };
  EXPECT_NEAR(cost(UnknownRule::as_mapped), 11.0, 1e-12);
  EXPECT_NEAR(cost(UnknownRule::free), 11.0, 1e-12);
  EXPECT_NEAR(cost(UnknownRule::costly), 11.0 + 0.6, 1e-12) << "cheaper through it than round it";
  EXPECT_NEAR(cost(UnknownRule::blocked), 9.0 + 2.0 * std::sqrt(2.0), 1e-12);
  grid->unknown_is_occupied = true;
  Config config;
  config.unknown = UnknownRule::costly;
  EXPECT_EQ(stage(config, grid).plan(start, goal).code(), ErrorCode::invalid_parameter);
}

TEST(UnknownSpace, IsTakenAsTheRequestSaysElseAsConfigured) {
  const auto grid = half_known_corridor();
  PlanRequest request;
  request.start.position = grid->geometry.center({0, 1, 0});
  request.goal.position = grid->geometry.center({11, 1, 0});
  const double straight = 11.0, around = 9.0 + 2.0 * std::sqrt(2.0);
  for (const UnknownRule configured : {UnknownRule::as_mapped, UnknownRule::blocked}) {
    Config config;
    config.unknown = configured;
    config.unknown_weight = 0.1;
    auto search = stage(config, grid);
    const auto cost = [&](UnknownSpace unknown) {
      request.unknown = unknown;
      const auto path = search.plan(request);
      return path.ok() ? path->cost / 0.2 : -1.0;
    };
    const bool blocks = configured == UnknownRule::blocked;
    EXPECT_NEAR(cost(UnknownSpace::as_configured), blocks ? around : straight, 1e-12);
    EXPECT_NEAR(cost(UnknownSpace::free), straight, 1e-12);
    EXPECT_NEAR(cost(UnknownSpace::costly), straight + 0.6, 1e-12);
    EXPECT_NEAR(cost(UnknownSpace::blocked), around, 1e-12);
    EXPECT_NEAR(cost(UnknownSpace::as_configured), blocks ? around : straight, 1e-12)
        << "a request does not change how the next one is taken";
  }
}

TEST(UnknownSpace, OfARequestFollowsTheMap) {
  const auto before = half_known_corridor();
  auto search = stage({}, before);
  PlanRequest request;
  request.start.position = before->geometry.center({0, 1, 0});
  request.goal.position = before->geometry.center({11, 1, 0});
  request.unknown = UnknownSpace::blocked;
  EXPECT_NEAR(search.plan(request)->cost / 0.2, 9.0 + 2.0 * std::sqrt(2.0), 1e-12);
  auto measured = half_known_corridor();
  measured->known = BitGrid({12, 3, 1}, false, true);
  search.set_map(measured);
  EXPECT_NEAR(search.plan(request)->cost / 0.2, 11.0, 1e-12);
  auto closed = half_known_corridor();
  closed->unknown_is_occupied = true;
  search.set_map(closed);
  request.unknown = UnknownSpace::free;
  EXPECT_EQ(search.plan(request).code(), ErrorCode::invalid_parameter);
}

TEST(Request, IsSearchedToWhicheverGoalIsNearest) {
  const auto grid = half_known_corridor();
  auto search = stage({}, grid);
  const auto at = [&](int x) { return grid->geometry.center({x, 1, 0}); };
  PlanRequest request;
  request.start.position = at(0);
  request.goal.position = at(11);
  request.other_goals_map = {at(6), at(3)};
  const auto path = search.plan(request);
  ASSERT_TRUE(path.ok()) << path.error().message;
  EXPECT_EQ(path->goal, 2u);
  EXPECT_EQ(path->waypoints_map.back(), request.other_goals_map[1]);
}

// What a search sees, by its definition.
void expect_seen(const VoxelGrid& seen, const VoxelGrid& map, UnknownRule rule,
                 const std::optional<SearchBox>& box) {
  std::int64_t inside = 0;
  const Index3 n = map.geometry.size;
  for (int k = 0; k < n.x * n.y * n.z; ++k) {
    const Index3 i{k % n.x, k / n.x % n.y, k / n.x / n.y};
    const Vec3 center = map.geometry.center(i);
    if (box && ((center.array() < box->lower_map.array()).any() ||
                (center.array() > box->upper_map.array()).any())) {
      continue;
    }
    ++inside;
    const auto at = seen.geometry.index_of(center);
    ASSERT_TRUE(at) << to_text(i);
    const bool blocked = rule == UnknownRule::blocked && !map.is_known(i);
    ASSERT_EQ(seen.grown.get(*at), map.grown.get(i) || blocked) << to_text(i);
    ASSERT_EQ(seen.is_known(*at), map.is_known(i)) << to_text(i);
  }
  EXPECT_EQ(seen.grown.voxels(), inside);
  EXPECT_EQ(seen.version, map.version);
  EXPECT_TRUE(seen.check());
}

TEST(SearchMap, FollowsAMapThatChanges) {
  Random random(35);
  for (int n = 0; n < 40; ++n) {
    auto grid = grid_of(BitGrid({20 + random.below(100), 30, 20}, true));
    const Index3 size = grid->geometry.size;
    if (random.chance(0.8)) grid->known = BitGrid(size, false, random.chance(0.5));
    grid->unknown_is_occupied = false;
    const auto rule = random.chance(0.5) ? UnknownRule::blocked : UnknownRule::free;
    std::optional<SearchBox> box;
    if (random.chance(0.7)) {
      const Vec3 lower(random.uniform(0.0, 2.0), random.uniform(0.0, 3.0), random.uniform());
      box = SearchBox{lower, lower + Vec3(random.uniform(0.5, 20.0), 2.0, 1.5)};
    }
    SearchMap followed(rule, box);
    for (int update = 0; update < 8; ++update) {
      auto next = std::make_shared<VoxelGrid>(*grid);
      ++next->version;
      for (int k = random.below(40); k > 0; --k) {
        const Index3 at{random.below(size.x), random.below(size.y), random.below(size.z)};
        next->grown.set(at, random.chance(0.6));
        if (!next->known.empty()) next->known.set(at, random.chance(0.6));
      }
      if (random.chance(0.1)) next->geometry.origin_map.x() += 0.4;
      grid = next;
      const auto seen = followed.follow(grid);
      ASSERT_TRUE(seen.ok()) << seen.error().message;
      ASSERT_NO_FATAL_FAILURE(expect_seen(**seen, *grid, rule, box));
    }
  }
}

TEST(Weights, BendThePathAsTheyShould) {
  // A pillar in the middle of a room: with clearance the path keeps away from it.
  BitGrid blocked({21, 21, 9}, true);
  for (int z = 0; z < 9; ++z) blocked.set({10, 10, z}, true);
  const auto grid = grid_of(blocked);
  Config config;
  config.pruning = Pruning::none;
  config.clearance_m = 0.6;
  config.clearance_weight = 5.0;
  const auto path =
      stage(config, grid)
          .plan(grid->geometry.center({4, 10, 4}), grid->geometry.center({16, 10, 4}));
  ASSERT_TRUE(path.ok());
  EXPECT_EQ(path->implementation, "astar_weighted");
  for (const Vec3& p : path->raw_map) {
    const Vec3 away = (p - grid->geometry.center({10, 10, 4})) / 0.2;
    EXPECT_GT(std::max(std::abs(away.x()), std::abs(away.y())), 2.5);
  }
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

TEST(SamplingPlanners, FindFreePathsThatRepeatBitForBit) {
  Random random(32);
  const auto grid = grid_of(reference::box_map({40, 40, 12}, 0.15, random));
  for (const Planner planner : {Planner::rrt, Planner::rrtstar, Planner::prm}) {
    Config config;
    config.planner = planner;
    config.pruning = Pruning::none;
    config.max_iterations = 1500;
    PathSearch search = stage(config, grid), again = stage(config, grid);
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
    PathSearch search = stage(config, grid), again = stage(config, grid);
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
