#include "goshawk/path_search/planner.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "goshawk/path_search/grid_search.hpp"
#include "goshawk/path_search/sampling_search.hpp"
#include "reference.hpp"

namespace goshawk::path_search {
namespace {

using reference::Random;

std::unique_ptr<GridPlanner> planner_of(const std::string& name, const std::string& rule) {
  Config config;
  config.planner = from_word<Planner>(name).value();
  config.corner_rule = from_word<CornerRule>(rule).value();
  return std::move(make_planner(config)).value();
}

const std::vector<std::string> kRuleNames = {"no_squeeze", "squeeze"};
const std::vector<std::string> kExact = {"jastar", "astar", "astar_euclidean", "dijkstra"};

// Compares planners with the truth on one map, for a few goals.
void expect_truth(std::vector<std::unique_ptr<GridPlanner>>& planners, const BitGrid& map,
                  bool squeeze, Random& random) {
  const Index3 start = reference::free_voxel(map, random);
  if (map.get(start)) return;
  const auto truth = reference::distances(map, start, squeeze);
  for (auto& planner : planners) planner->set_map(map);
  for (int k = 0; k < 3; ++k) {
    const Index3 goal = reference::free_voxel(map, random);
    if (map.get(goal)) return;
    const double expected = reference::distance_to(truth, map.size(), goal);
    for (auto& planner : planners) {
      const auto path = planner->search(start, goal);
      if (std::isinf(expected)) {
        ASSERT_EQ(path.code(), ErrorCode::no_path);
        continue;
      }
      ASSERT_TRUE(path.ok()) << path.error().message;
      const auto& cells = path->cells;
      ASSERT_EQ(reference::fault_of_path(map, cells, start, goal, squeeze, path->cost_voxels), "");
      ASSERT_GE(path->cost_voxels, expected * (1.0 - 1e-9));
      if (planner->name() == "astar_manhattan") continue;  // not exact
      ASSERT_LE(path->cost_voxels, expected * (1.0 + 1e-9))
          << planner->name() << " on " << to_text(map.size());
    }
  }
}

// Three goals a map: 102,000 queries of JA* and A*, a tenth of them of the others.
TEST(Planners, FindTheDijkstraLengthOnEveryRandomMap) {
  for (const auto& rule : kRuleNames) {
    std::vector<std::unique_ptr<GridPlanner>> best, all;
    for (const auto* name : {"jastar", "astar"}) best.push_back(planner_of(name, rule));
    for (const auto& name : kExact) all.push_back(planner_of(name, rule));
    all.push_back(planner_of("astar_manhattan", rule));
    Random random(1);
    for (int n = 0; n < 17000; ++n) {
      const BitGrid map = reference::any_map(random);
      expect_truth(n % 10 == 0 ? all : best, map, rule == "squeeze", random);
      if (HasFatalFailure()) FAIL() << rule << ", map " << n;
    }
  }
}

// Maps as small as these have labels in rows, unless asked for otherwise.
TEST(JaStar, FindsTheDijkstraLengthWithLabelsInTiles) {
  for (const CornerRule rule : {CornerRule::no_squeeze, CornerRule::squeeze}) {
    std::vector<std::unique_ptr<GridPlanner>> planners;
    planners.push_back(make_jastar(rule, true));
    Random random(5);
    for (int n = 0; n < 6000; ++n) {
      const BitGrid map =
          n % 20 == 0 ? reference::box_map({40, 30, 10}, 0.2, random) : reference::any_map(random);
      expect_truth(planners, map, rule == CornerRule::squeeze, random);
      if (HasFatalFailure()) FAIL() << to_word(rule) << ", map " << n;
    }
  }
}

TEST(JaStar, FindsTheDijkstraLengthOnLargerMaps) {
  for (const auto& rule : kRuleNames) {
    std::vector<std::unique_ptr<GridPlanner>> planners;
    planners.push_back(planner_of("jastar", rule));
    Random random(2);
    for (int n = 0; n < 40; ++n) {
      const Index3 size{20 + random.below(60), 20 + random.below(20), 5 + random.below(20)};
      const double ratio = random.uniform(0.02, 0.5);
      const BitGrid map = n % 2 == 0 ? reference::noise_map(size, ratio, random)
                                     : reference::box_map(size, ratio, random);
      expect_truth(planners, map, rule == "squeeze", random);
      if (HasFatalFailure()) FAIL() << rule << ", map " << n;
    }
  }
}

TEST(Planners, CrossAnEmptyMapInAStraightLine) {
  for (const auto& rule : kRuleNames) {
    for (const auto& name : kExact) {
      const auto planner = planner_of(name, rule);
      planner->set_map(BitGrid({200, 3, 2}, true));
      const auto path = planner->search({0, 1, 1}, {199, 1, 1});
      ASSERT_TRUE(path.ok());
      EXPECT_EQ(path->cells.size(), 200U);
      EXPECT_DOUBLE_EQ(path->cost_voxels, 199.0);
      EXPECT_GT(path->counters.expanded, 0);
      EXPECT_GE(path->counters.generated, path->counters.expanded);
    }
  }
}

TEST(Planners, AnswerWhereStartIsTheGoal) {
  const auto planner = planner_of("jastar", "no_squeeze");
  planner->set_map(BitGrid({3, 3, 3}, true));
  const auto path = planner->search({1, 1, 1}, {1, 1, 1});
  ASSERT_TRUE(path.ok());
  EXPECT_EQ(path->cells.size(), 1U);
  EXPECT_EQ(path->cost_voxels, 0.0);
}

TEST(Planners, PassADiagonalGapOnlyUnderSqueeze) {
  BitGrid map({2, 2, 1}, true);
  map.set({1, 0, 0}, true);
  map.set({0, 1, 0}, true);
  for (const auto& name : kExact) {
    const auto squeeze = planner_of(name, "squeeze");
    const auto no_squeeze = planner_of(name, "no_squeeze");
    squeeze->set_map(map);
    no_squeeze->set_map(map);
    EXPECT_NEAR(squeeze->search({0, 0, 0}, {1, 1, 0})->cost_voxels, std::sqrt(2.0), 1e-15);
    EXPECT_EQ(no_squeeze->search({0, 0, 0}, {1, 1, 0}).code(), ErrorCode::no_path);
  }
}

TEST(Planners, SayWhatIsWrongWithAQuery) {
  const auto planner = planner_of("jastar", "no_squeeze");
  EXPECT_EQ(planner->search({0, 0, 0}, {1, 1, 1}).code(), ErrorCode::no_map);
  planner->set_map(BitGrid());
  EXPECT_EQ(planner->search({0, 0, 0}, {1, 1, 1}).code(), ErrorCode::no_map);
  BitGrid map({4, 4, 4}, true);
  map.set({0, 0, 0}, true);
  map.set({3, 3, 3}, true);
  planner->set_map(map);
  EXPECT_EQ(planner->search({-1, 0, 0}, {1, 1, 1}).code(), ErrorCode::start_outside);
  EXPECT_EQ(planner->search({1, 0, 0}, {1, 1, 4}).code(), ErrorCode::goal_outside);
  EXPECT_EQ(planner->search({0, 0, 0}, {1, 1, 1}).code(), ErrorCode::start_occupied);
  EXPECT_EQ(planner->search({1, 1, 1}, {3, 3, 3}).code(), ErrorCode::goal_occupied);
  EXPECT_TRUE(planner->search({1, 1, 1}, {2, 2, 2}).ok());
}

TEST(Planners, RefuseAMapWithMoreVoxelsThanNodeNumbers) {
  const auto planner = planner_of("jastar", "no_squeeze");
  planner->set_map(BitGrid({500'000'000, 1, 1}, true));
  const auto path = planner->search({0, 0, 0}, {1, 1, 1});
  EXPECT_EQ(path.code(), ErrorCode::map_too_large);
  planner->set_map(BitGrid({2, 2, 2}, true));
  EXPECT_TRUE(planner->search({0, 0, 0}, {1, 1, 1}).ok());
}

TEST(Planners, AreChosenByName) {
  for (const auto& name : {"jastar", "astar", "astar_euclidean", "astar_manhattan", "dijkstra"}) {
    EXPECT_EQ(planner_of(name, "squeeze")->name(), name);
  }
  Config config;
  config.planner = Planner(100);
  EXPECT_EQ(make_planner(config).code(), ErrorCode::invalid_parameter);
  EXPECT_THROW(make_grid_search(Planner::prm, CornerRule::squeeze), std::invalid_argument);
  EXPECT_THROW(make_sampling_search(Planner::jastar, {}), std::invalid_argument);
}

TEST(Planners, FollowAMapThatChangesLikeANewOne) {
  Random random(3);
  const Index3 size{67, 9, 8};
  BitGrid map = reference::noise_map(size, 0.3, random);
  const auto kept = planner_of("jastar", "no_squeeze");
  for (int n = 0; n < 200; ++n) {
    for (int k = 0; k < 20; ++k) {
      map.set({random.below(size.x), random.below(size.y), random.below(size.z)},
              random.chance(0.3));
    }
    kept->set_map(map);
    const auto fresh = planner_of("jastar", "no_squeeze");
    fresh->set_map(map);
    const Index3 start = reference::free_voxel(map, random);
    const Index3 goal = reference::free_voxel(map, random);
    const auto a = kept->search(start, goal);
    const auto b = fresh->search(start, goal);
    ASSERT_EQ(a.code(), b.code());
    if (!a.ok()) continue;
    ASSERT_EQ(a->cells, b->cells);
  }
}

TEST(Planners, RepeatBitForBitAndForgetEarlierQueries) {
  Random random(4);
  const BitGrid map = reference::noise_map({30, 30, 10}, 0.2, random);
  for (const auto& name : kExact) {
    const auto planner = planner_of(name, "no_squeeze");
    planner->set_map(map);
    std::vector<std::pair<Index3, Index3>> queries;
    std::vector<Result<VoxelPath>> answers;
    for (int k = 0; k < 20; ++k) {
      queries.emplace_back(reference::free_voxel(map, random), reference::free_voxel(map, random));
      answers.push_back(planner->search(queries.back().first, queries.back().second));
    }
    for (std::size_t k = queries.size(); k-- > 0;) {
      const auto again = planner->search(queries[k].first, queries[k].second);
      ASSERT_EQ(again.code(), answers[k].code());
      if (!again.ok()) continue;
      EXPECT_EQ(again->cells, answers[k]->cells);
      EXPECT_EQ(again->counters, answers[k]->counters);
      EXPECT_EQ(again->cost_voxels, answers[k]->cost_voxels);
    }
  }
}

TEST(Planners, OutliveTheQueryNumbersOfTheirLabels) {
  BitGrid map({4, 4, 1}, true);
  map.set_run(0, 3, 1, 0, true);
  const auto planner = planner_of("jastar", "no_squeeze");
  planner->set_map(map);
  VoxelPath path;
  for (int n = 0; n < 70000; ++n) {
    ASSERT_TRUE(planner->search({n % 4, 0, 0}, {n % 3, 2, 0}, path).ok());
    const double sideways = 3 - n % 4 + 3 - n % 3;
    ASSERT_DOUBLE_EQ(path.cost_voxels, sideways + 2.0) << n;
  }
}

}  // namespace
}  // namespace goshawk::path_search
