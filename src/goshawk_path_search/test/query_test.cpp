// Queries beyond one start and one goal, on voxels: several goals, weights, stopping.
#include "goshawk/path_search/query.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "goshawk/path_search/planner.hpp"
#include "goshawk/path_search/reachable.hpp"
#include "goshawk/path_search/weighted_search.hpp"
#include "reference.hpp"

namespace goshawk::path_search {
namespace {

using reference::Random;

constexpr double kResolution = 0.2;

std::unique_ptr<GridPlanner> planner_of(const std::string& name, bool squeeze) {
  Config config;
  config.planner = from_word<Planner>(name).value();
  config.corner_rule = squeeze ? CornerRule::squeeze : CornerRule::no_squeeze;
  return std::move(make_planner(config)).value();
}

std::vector<End> random_goals(const BitGrid& map, int count, Random& random) {
  std::vector<End> goals;
  for (int k = 0; k < count; ++k) {
    const Index3 at = reference::free_voxel(map, random);
    if (!map.get(at)) goals.push_back(End::center_of(at));
  }
  return goals;
}

TEST(SeveralGoals, GiveTheShortestPathToTheNearestOfThem) {
  for (const bool squeeze : {false, true}) {
    Random random(21);
    std::vector<std::unique_ptr<GridPlanner>> planners;
    for (const auto* name : {"jastar", "astar", "astar_euclidean", "dijkstra"}) {
      planners.push_back(planner_of(name, squeeze));
    }
    int found = 0;
    for (int n = 0; n < 2000; ++n) {
      const BitGrid map = reference::any_map(random);
      const Index3 start = reference::free_voxel(map, random);
      const auto goals = random_goals(map, 1 + random.below(5), random);
      if (map.get(start) || goals.empty()) continue;
      const auto truth = reference::distances(map, start, squeeze);
      double expected = HUGE_VAL;
      for (const End& goal : goals) {
        expected = std::min(expected, reference::distance_to(truth, map.size(), goal.cell));
      }
      for (auto& planner : planners) {
        planner->set_map(map);
        VoxelPath path;
        const auto status =
            planner->search({.start = End::center_of(start), .goals = goals, .stop = {}}, path);
        ASSERT_EQ(status.code(), std::isinf(expected) ? ErrorCode::no_path : ErrorCode::ok);
        if (!status) continue;
        ++found;
        ASSERT_NEAR(path.cost_voxels, expected, 1e-9 * (1.0 + expected)) << planner->name();
        const Index3 end = goals.at(path.goal).cell;
        ASSERT_EQ(reference::fault_of_path(map, path.cells, start, end, squeeze, path.cost_voxels),
                  "");
      }
    }
    EXPECT_GT(found, 2000);
  }
}

TEST(Queries, WithoutAGoalAreRefused) {
  for (const auto* name : {"jastar", "rrt"}) {
    const auto planner = planner_of(name, false);
    planner->set_map(BitGrid({3, 3, 3}, true));
    VoxelPath path;
    const GridQuery query{.start = End::center_of({1, 1, 1}), .goals = {}, .stop = {}};
    EXPECT_EQ(planner->search(query, path).code(), ErrorCode::invalid_input) << name;
  }
}

// The definition of the cost, voxel by voxel.
struct Truth {
  const BitGrid& blocked;
  const BitGrid& known;
  Weights weights;

  double factor(Index3 at) const {
    double f = 1.0 + (known.get(at) ? 0.0 : weights.unknown);
    if (!weights.near_obstacles()) return f;
    for (int k = 1; k <= weights.reach_voxels; ++k) {
      if (!blocked_within(at, k)) continue;
      return f + weights.clearance * (1.0 - double(k - 1) / weights.reach_voxels);
    }
    return f;
  }
  bool blocked_within(Index3 at, int k) const {
    for (int z = -k; z <= k; ++z) {
      for (int y = -k; y <= k; ++y) {
        for (int x = -k; x <= k; ++x) {
          if (blocked.test(at + Index3{x, y, z})) return true;
        }
      }
    }
    return false;
  }
};

TEST(Weights, AreWhatTheyAreDefinedAsEverywhere) {
  Random random(22);
  for (int n = 0; n < 60; ++n) {
    const BitGrid map = reference::any_map(random);
    const BitGrid known = reference::noise_map(map.size(), 0.7, random);
    const Weights weights{.climb = 0.0,
                          .unknown = random.uniform(0.0, 3.0),
                          .clearance = random.uniform(0.0, 3.0),
                          .reach_voxels = random.below(5)};
    CostField field(weights);
    field.assign(map, &known);
    const Truth truth{map, known, weights};
    for (int k = 0; k < 100; ++k) {
      const Index3 at = reference::free_voxel(map, random);
      if (map.get(at)) continue;
      ASSERT_DOUBLE_EQ(field.factor(at), truth.factor(at)) << to_text(at);
    }
  }
}

TEST(Weights, FollowAMapThatChanges) {
  Random random(25);
  for (int n = 0; n < 20; ++n) {
    const Index3 size{40 + random.below(100), 5 + random.below(30), 5 + random.below(20)};
    BitGrid map = reference::noise_map(size, random.uniform(0.0, 0.02), random);
    BitGrid known = reference::noise_map(size, 0.7, random);
    const Weights weights{.unknown = random.chance(0.3) ? 0.0 : 1.3,
                          .clearance = random.chance(0.2) ? 0.0 : 2.0,
                          .reach_voxels = 1 + random.below(6)};
    CostField kept(weights);
    kept.assign(map, &known);
    for (int update = 0; update < 6; ++update) {
      for (int k = random.below(12); k > 0; --k) {
        const Index3 at{random.below(size.x), random.below(size.y), random.below(size.z)};
        map.set(at, random.chance(0.5));
        known.set(at, random.chance(0.5));
      }
      kept.assign(map, &known);
      CostField fresh(weights);
      fresh.assign(map, &known);
      for (int k = 0; k < size.x * size.y * size.z; ++k) {
        const Index3 at{k % size.x, k / size.x % size.y, k / size.x / size.y};
        ASSERT_EQ(kept.factor(at), fresh.factor(at)) << to_text(at);
      }
    }
  }
}

TEST(WeightedSearch, IsExactAboutItsCost) {
  for (const bool squeeze : {false, true}) {
    Random random(23);
    for (int n = 0; n < 700; ++n) {
      const BitGrid map = reference::any_map(random);
      const BitGrid known = reference::noise_map(map.size(), random.uniform(), random);
      const Weights weights{.climb = random.chance(0.5) ? random.uniform(0.0, 5.0) : 0.0,
                            .unknown = random.chance(0.5) ? random.uniform(0.0, 5.0) : 0.0,
                            .clearance = random.chance(0.5) ? random.uniform(0.0, 5.0) : 0.0,
                            .reach_voxels = 1 + random.below(3)};
      const Index3 start = reference::free_voxel(map, random);
      const auto goals = random_goals(map, 1 + random.below(2), random);
      if (map.get(start) || goals.empty()) continue;
      CostField field(weights);
      field.assign(map, &known);
      const auto cost = [&](Index3 from, Index3 to) {
        const double length = std::hypot(double(to.x - from.x), to.y - from.y, to.z - from.z);
        return length * field.factor(to) + weights.climb * std::max(0, to.z - from.z);
      };
      const auto truth = reference::distances(map, start, squeeze, cost);
      double expected = HUGE_VAL;
      for (const End& goal : goals) {
        expected = std::min(expected, reference::distance_to(truth, map.size(), goal.cell));
      }
      for (const bool heuristic : {true, false}) {
        const auto rule = squeeze ? CornerRule::squeeze : CornerRule::no_squeeze;
        const auto planner = make_weighted_search("weighted", heuristic, rule, weights);
        planner->set_map(map, &known);
        VoxelPath path;
        const auto status =
            planner->search({.start = End::center_of(start), .goals = goals, .stop = {}}, path);
        ASSERT_EQ(status.code(), std::isinf(expected) ? ErrorCode::no_path : ErrorCode::ok);
        if (!status) continue;
        ASSERT_NEAR(path.cost_voxels, expected, 1e-9 * (1.0 + expected)) << n;
        ASSERT_EQ(reference::fault_of_path(map, path.cells, start, goals[path.goal].cell, squeeze,
                                           path.cost_voxels, cost),
                  "");
      }
    }
  }
}

TEST(WeightedSearch, StandsInForJaStarAndAStarAndIsRefusedByTheOthers) {
  for (const auto& [name, expected] :
       std::vector<std::pair<std::string, std::string>>{{"jastar", "astar_weighted"},
                                                        {"astar", "astar_weighted"},
                                                        {"dijkstra", "dijkstra_weighted"},
                                                        {"astar_euclidean", ""},
                                                        {"astar_manhattan", ""},
                                                        {"rrt", ""},
                                                        {"prm", ""}}) {
    Config config;
    config.planner = from_word<Planner>(name).value();
    config.z_weight = 0.5;
    const auto planner = make_planner(config, kResolution);
    if (expected.empty()) {
      EXPECT_EQ(planner.code(), ErrorCode::invalid_parameter) << name;
    } else {
      ASSERT_TRUE(planner.ok());
      EXPECT_EQ((*planner)->name(), expected);
    }
  }
}

TEST(StopSignal, EndsEverySearchByDeadlineOrCancellation) {
  Random random(24);
  const BitGrid map = reference::noise_map({80, 80, 40}, 0.4, random);
  const Index3 start = reference::free_voxel(map, random);
  const std::vector<End> goals = {End::center_of(reference::free_voxel(map, random))};
  for (const std::string name : {"astar_euclidean", "dijkstra", "weighted", "rrtstar", "prm"}) {
    Config config;
    config.planner = name == "weighted" ? Planner::dijkstra : from_word<Planner>(name).value();
    config.z_weight = name == "weighted" ? 1.0 : 0.0;
    const auto planner = std::move(make_planner(config)).value();
    planner->set_map(map);
    VoxelPath path;
    GridQuery query{.start = End::center_of(start), .goals = goals, .stop = StopSignal::after(0.0)};
    EXPECT_EQ(planner->search(query, path).code(), ErrorCode::deadline_exceeded) << name;
    std::stop_source source;
    query.stop = {.deadline = {}, .token = source.get_token()};
    source.request_stop();
    EXPECT_EQ(planner->search(query, path).code(), ErrorCode::cancelled) << name;
    if (config.planner != Planner::dijkstra) continue;
    query.stop = StopSignal::after(1e300);
    EXPECT_TRUE(planner->search(query, path).ok()) << name;
  }
}

TEST(NearestReachable, IsTheNearestOfAllThatDijkstraReaches) {
  for (const bool squeeze : {false, true}) {
    Random random(25);
    for (int n = 0; n < 500; ++n) {
      const BitGrid map = reference::any_map(random);
      const Index3 start = reference::free_voxel(map, random);
      if (map.get(start)) continue;
      const std::vector<End> goals = {End::center_of(reference::free_voxel(map, random)),
                                      End::center_of(reference::free_voxel(map, random))};
      const auto truth = reference::distances(map, start, squeeze);
      const auto distance = [&](Index3 at) {
        double least = HUGE_VAL;
        for (const End& goal : goals) {
          least = std::min(least, (End::center_of(at).at_grid - goal.at_grid).norm());
        }
        return least;
      };
      double expected = HUGE_VAL;
      for (int z = 0; z < map.size().z; ++z) {
        for (int y = 0; y < map.size().y; ++y) {
          for (int x = 0; x < map.size().x; ++x) {
            if (std::isinf(reference::distance_to(truth, map.size(), {x, y, z}))) continue;
            expected = std::min(expected, distance({x, y, z}));
          }
        }
      }
      const auto rule = squeeze ? CornerRule::squeeze : CornerRule::no_squeeze;
      const GridQuery query{.start = End::center_of(start), .goals = goals, .stop = {}};
      const auto at = nearest_reachable(map, rule, query);
      ASSERT_TRUE(at.ok());
      ASSERT_FALSE(std::isinf(reference::distance_to(truth, map.size(), *at)));
      ASSERT_DOUBLE_EQ(distance(*at), expected);
    }
  }
}

}  // namespace
}  // namespace goshawk::path_search
