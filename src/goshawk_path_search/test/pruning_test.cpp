#include "goshawk/path_search/pruning.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "goshawk/core/line_of_sight.hpp"
#include "goshawk/path_search/path_search.hpp"
#include "goshawk/path_search/planner.hpp"
#include "goshawk/path_search/relaxation.hpp"
#include "reference.hpp"

namespace goshawk::path_search {
namespace {

using reference::Random;

double length(const std::vector<Vec3>& nodes, const std::vector<int>& kept) {
  double sum = 0.0;
  for (std::size_t k = 1; k < kept.size(); ++k) {
    sum += (nodes[std::size_t(kept[k])] - nodes[std::size_t(kept[k - 1])]).norm();
  }
  return sum;
}

std::vector<int> all_of(const std::vector<Vec3>& nodes) {
  std::vector<int> kept;
  for (int i = 0; i < int(nodes.size()); ++i) kept.push_back(i);
  return kept;
}

// Quadratic, without any bound or order: the truth for `shortest`.
double shortest_length(const BitGrid& map, const std::vector<Vec3>& nodes) {
  std::vector<double> best(nodes.size(), std::numeric_limits<double>::infinity());
  best[0] = 0.0;
  for (std::size_t j = 1; j < nodes.size(); ++j) {
    for (std::size_t i = 0; i < j; ++i) {
      if (i + 1 != j && !line_is_free(map, nodes[i], nodes[j])) continue;
      best[j] = std::min(best[j], best[i] + (nodes[j] - nodes[i]).norm());
    }
  }
  return best.back();
}

// A path of the planner, with ends anywhere inside their voxels.
std::vector<Vec3> random_path(const BitGrid& map, CornerRule rule, Random& random) {
  Config config;
  config.corner_rule = rule;
  const auto planner = std::move(make_planner(config)).value();
  planner->set_map(map);
  const Index3 s = reference::free_voxel(map, random), g = reference::free_voxel(map, random);
  const auto path = planner->search(s, g);
  std::vector<Vec3> nodes;
  if (!path.ok()) return nodes;
  for (const Index3 c : path->cells) nodes.push_back(Vec3(c.x + 0.5, c.y + 0.5, c.z + 0.5));
  const auto shift = [&] {
    return Vec3(random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.4));
  };
  nodes.front() += shift();
  nodes.back() += shift();
  return nodes;
}

void expect_valid(const BitGrid& map, const std::vector<Vec3>& nodes, const std::vector<int>& kept,
                  bool squeeze) {
  ASSERT_GE(kept.size(), 1U);
  ASSERT_EQ(kept.front(), 0);
  ASSERT_EQ(kept.back(), int(nodes.size()) - 1);
  for (std::size_t k = 1; k < kept.size(); ++k) {
    ASSERT_LT(kept[k - 1], kept[k]);
    if (squeeze && kept[k] == kept[k - 1] + 1) continue;
    ASSERT_TRUE(line_is_free(map, nodes[std::size_t(kept[k - 1])], nodes[std::size_t(kept[k])]));
  }
  ASSERT_LE(length(nodes, kept), length(nodes, all_of(nodes)) * (1.0 + 1e-12));
}

TEST(Pruning, StaysFreeKeepsTheEndsAndIsNeverLonger) {
  for (const CornerRule rule : {CornerRule::no_squeeze, CornerRule::squeeze}) {
    Random random(10);
    PathPruner pruner;
    for (int n = 0; n < 1500; ++n) {
      const BitGrid map = reference::any_map(random);
      const auto nodes = random_path(map, rule, random);
      if (nodes.empty()) continue;
      for (const Pruning pruning : {Pruning::none, Pruning::greedy, Pruning::shortest}) {
        std::vector<int> kept;
        pruner.prune(pruning, map, nodes, kept);
        expect_valid(map, nodes, kept, rule == CornerRule::squeeze);
        if (HasFatalFailure()) FAIL() << "map " << n;
      }
    }
  }
}

TEST(Pruning, FindsTheShortestPolylineOverThePathsNodes) {
  Random random(11);
  PathPruner pruner;
  int bent = 0;
  for (int n = 0; n < 400; ++n) {
    const BitGrid map = reference::box_map({30, 30, 8}, random.uniform(0.1, 0.4), random);
    const auto nodes = random_path(map, CornerRule::no_squeeze, random);
    if (nodes.size() < 3) continue;
    std::vector<int> kept, greedy;
    pruner.prune(Pruning::shortest, map, nodes, kept);
    pruner.prune(Pruning::greedy, map, nodes, greedy);
    const double truth = shortest_length(map, nodes);
    ASSERT_NEAR(length(nodes, kept), truth, 1e-9 * truth) << "map " << n;
    ASSERT_LE(length(nodes, kept), length(nodes, greedy) * (1.0 + 1e-12));
    bent += kept.size() > 2;
  }
  EXPECT_GT(bent, 50);
}

// A path of thousands of nodes: the work is bounded, the answer is valid and no worse than greedy
// from either end.
TEST(Pruning, BoundsItsWorkOnLongPaths) {
  BitGrid map({300, 61, 1}, true);
  for (int y = 1; y < 60; y += 2) {
    for (int x = 0; x < 300; ++x) map.set({x, y, 0}, true);
    map.set({y % 4 == 1 ? 299 : 0, y, 0}, false);
  }
  Config config;
  const auto planner = std::move(make_planner(config)).value();
  planner->set_map(map);
  const auto path = planner->search({0, 0, 0}, {0, 60, 0});
  ASSERT_TRUE(path.ok());
  std::vector<Vec3> nodes;
  for (const Index3 c : path->cells) nodes.push_back(Vec3(c.x + 0.5, c.y + 0.5, c.z + 0.5));
  ASSERT_GT(nodes.size(), 9000U);
  PathPruner pruner;
  std::vector<int> kept;
  pruner.prune(Pruning::shortest, map, nodes, kept);
  expect_valid(map, nodes, kept, false);
  // Two waypoints at each of the 30 gaps and the start; the goal is the last gap's exit.
  EXPECT_EQ(kept.size(), 61U);
}

double length(const std::vector<Vec3>& points) {
  return length(points, all_of(points));
}

// Free, the same ends, never longer; only a move of the raw path (squeeze) may be what it was.
TEST(Relaxing, ShortensAndStaysFree) {
  for (const CornerRule rule : {CornerRule::no_squeeze, CornerRule::squeeze}) {
    Random random(12);
    PathPruner pruner;
    int shorter = 0;
    for (int n = 0; n < 800; ++n) {
      const BitGrid map = n % 2 == 0
                              ? reference::any_map(random)
                              : reference::box_map({30, 30, 8}, random.uniform(0.1, 0.4), random);
      const auto nodes = random_path(map, rule, random);
      if (nodes.empty()) continue;
      std::vector<int> kept;
      pruner.prune(Pruning::relaxed, map, nodes, kept);
      std::vector<Vec3> before;
      for (const int k : kept) before.push_back(nodes[std::size_t(k)]);
      std::vector<Vec3> after = before;
      const int changes = pull_tight(map, after);
      ASSERT_EQ(after.front(), before.front());
      ASSERT_EQ(after.back(), before.back());
      ASSERT_LE(after.size(), before.size());
      ASSERT_LE(length(after), length(before)) << "map " << n;
      ASSERT_EQ(changes == 0, after == before);
      shorter += length(after) < length(before) - 1e-3;
      for (std::size_t i = 1; i < after.size(); ++i) {
        if (line_is_free(map, after[i - 1], after[i])) continue;
        const auto from = std::ranges::find(nodes, after[i - 1]);
        ASSERT_TRUE(rule == CornerRule::squeeze && from != nodes.end() && *(from + 1) == after[i])
            << "map " << n << ", leg " << i;
      }
    }
    EXPECT_GT(shorter, 100) << to_word(rule);
  }
}

// The taut line round the edges of a wall is known.
TEST(Relaxing, TouchesTheCornerOfAWall) {
  BitGrid map({21, 21, 1}, true);
  for (int y = 0; y <= 10; ++y) map.set({10, y, 0}, true);
  std::vector<Vec3> points = {
      {4.5, 4.5, 0.5}, {9.5, 12.5, 0.5}, {12.5, 12.5, 0.5}, {16.5, 4.5, 0.5}};
  EXPECT_GT(pull_tight(map, points), 0);
  const double taut = 2.0 * std::hypot(10.0 - 4.5, 11.0 - 4.5) + 1.0;
  EXPECT_GT(length(points), taut);
  EXPECT_LT(length(points), taut * 1.02);
}

TEST(Relaxing, InTheStageIsNoLongerThanShortestAndFreeInMetres) {
  Random random(13);
  Config shortest, relaxed;
  relaxed.pruning = Pruning::relaxed;
  auto one = std::move(PathSearch::create(shortest)).value();
  auto other = std::move(PathSearch::create(relaxed)).value();
  for (int n = 0; n < 150; ++n) {
    auto grid = std::make_shared<VoxelGrid>();
    grid->grown = reference::box_map({30, 30, 8}, 0.3, random);
    grid->geometry = {Vec3(-1.37, 2.11, 0.53), 0.17, grid->grown.size()};
    one.set_map(grid);
    other.set_map(grid);
    const Vec3 s = grid->geometry.center(reference::free_voxel(grid->grown, random));
    const Vec3 g = grid->geometry.center(reference::free_voxel(grid->grown, random));
    const auto a = one.plan(s, g), b = other.plan(s, g);
    ASSERT_EQ(a.code(), b.code());
    if (!a.ok()) continue;
    ASSERT_LE(b->pruned_length_m, a->pruned_length_m * (1.0 + 1e-12));
    ASSERT_EQ(b->waypoints_map.front(), s);
    ASSERT_EQ(b->waypoints_map.back(), g);
    for (std::size_t i = 1; i < b->waypoints_map.size(); ++i) {
      ASSERT_TRUE(line_is_free(*grid, b->waypoints_map[i - 1], b->waypoints_map[i])) << n;
    }
  }
}

TEST(Pruning, CorrectsAlgorithmTwoAtTheEnd) {
  // The view from the start is cut at the last node only: the node before it must stay.
  BitGrid map({4, 2, 1}, true);
  map.set({2, 0, 0}, true);
  map.set({3, 0, 0}, true);
  map.set({0, 1, 0}, true);
  const std::vector<Vec3> nodes = {
      {0.5, 0.5, 0.5}, {1.5, 0.5, 0.5}, {1.5, 1.5, 0.5}, {2.5, 1.5, 0.5}, {3.5, 1.5, 0.5}};
  PathPruner pruner;
  std::vector<int> kept;
  pruner.prune(Pruning::greedy, map, nodes, kept);
  EXPECT_EQ(kept, (std::vector<int>{0, 1, 2, 4}));
}

TEST(Pruning, AcceptsPathsWithoutAnythingToPrune) {
  PathPruner pruner;
  std::vector<int> kept = {7};
  const BitGrid map({2, 2, 2}, true);
  for (const Pruning pruning : {Pruning::none, Pruning::greedy, Pruning::shortest}) {
    pruner.prune(pruning, map, {}, kept);
    EXPECT_TRUE(kept.empty());
    const std::vector<Vec3> one = {{0.5, 0.5, 0.5}};
    pruner.prune(pruning, map, one, kept);
    EXPECT_EQ(kept, std::vector<int>{0});
  }
  std::vector<Vec3> none, two = {{0.5, 0.5, 0.5}, {1.5, 1.5, 1.5}};
  EXPECT_EQ(pull_tight(map, none), 0);
  EXPECT_EQ(pull_tight(map, two), 0);
}

}  // namespace
}  // namespace goshawk::path_search
