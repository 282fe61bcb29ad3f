#include "goshawk/path_search/path_search.hpp"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "goshawk/core/line_of_sight.hpp"
#include "reference.hpp"

namespace goshawk::path_search {
namespace {

using reference::grid_of;
using reference::Random;

PathSearch stage(const Config& config = {}) {
  return std::move(PathSearch::create(config)).value();
}

Vec3 inside(const VoxelGrid& grid, Index3 i, Random& random) {
  const Vec3 shift(random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.4));
  return grid.geometry.center(i) + grid.geometry.resolution_m * shift;
}

double sum_of(const std::vector<Vec3>& points) {
  double sum = 0.0;
  for (std::size_t i = 1; i < points.size(); ++i) sum += (points[i] - points[i - 1]).norm();
  return sum;
}

void expect_free(const VoxelGrid& grid, const std::vector<Vec3>& points) {
  for (std::size_t i = 1; i < points.size(); ++i) {
    ASSERT_TRUE(line_is_free(grid, points[i - 1], points[i])) << "segment " << i;
  }
}

TEST(PathSearch, GivesFreeSegmentsBetweenTheExactEnds) {
  Random random(12);
  PathSearch search = stage();
  int found = 0;
  for (int n = 0; n < 1500; ++n) {
    const auto grid = grid_of(reference::any_map(random));
    search.set_map(grid);
    const Index3 s = reference::free_voxel(grid->grown, random);
    const Index3 g = reference::free_voxel(grid->grown, random);
    const Vec3 start = inside(*grid, s, random), goal = inside(*grid, g, random);
    const auto path = search.plan(start, goal);
    if (!path.ok()) continue;
    ++found;
    for (const auto* points : {&path->raw_map, &path->waypoints_map}) {
      ASSERT_GE(points->size(), 2U);
      ASSERT_EQ(points->front(), start);
      ASSERT_EQ(points->back(), goal);
      expect_free(*grid, *points);
    }
    ASSERT_NEAR(path->raw_length_m, sum_of(path->raw_map), 1e-12);
    ASSERT_NEAR(path->pruned_length_m, sum_of(path->waypoints_map), 1e-12);
    ASSERT_LE(path->pruned_length_m, path->raw_length_m * (1.0 + 1e-12));
    const auto truth = reference::distances(grid->grown, s, false);
    const double cost = 0.2 * reference::distance_to(truth, grid->grown.size(), g);
    ASSERT_NEAR(path->cost, cost, 1e-9 * (1.0 + cost));
    ASSERT_EQ(path->implementation, "jastar");
  }
  EXPECT_GT(found, 500);
}

TEST(PathSearch, AnswersInsideOneVoxelWithTwoPoints) {
  PathSearch search = stage();
  search.set_map(grid_of(BitGrid({5, 5, 5}, true)));
  const Vec3 start(-0.55, 2.45, 0.95), goal(-0.45, 2.55, 1.05);
  for (const Vec3& end : {goal, start}) {
    const auto path = search.plan(start, end);
    ASSERT_TRUE(path.ok());
    EXPECT_EQ(path->raw_map, (std::vector<Vec3>{start, end}));
    EXPECT_EQ(path->waypoints_map, (std::vector<Vec3>{start, end}));
    EXPECT_DOUBLE_EQ(path->raw_length_m, (end - start).norm());
    EXPECT_EQ(path->cost, 0.0);
  }
}

TEST(PathSearch, SaysWhyThereIsNoPath) {
  PathSearch search = stage();
  const Vec3 start(-0.9, 2.1, 0.6), goal(-0.1, 2.9, 1.4);
  EXPECT_EQ(search.plan(start, goal).code(), ErrorCode::no_map);
  search.set_map(nullptr);
  EXPECT_EQ(search.plan(start, goal).code(), ErrorCode::no_map);
  BitGrid blocked({5, 5, 5}, true);
  for (int y = 0; y < 5; ++y) {
    for (int z = 0; z < 5; ++z) blocked.set({2, y, z}, true);
  }
  const auto grid = grid_of(blocked);
  search.set_map(grid);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double inf = std::numeric_limits<double>::infinity();
  EXPECT_EQ(search.plan(start, goal).code(), ErrorCode::no_path);
  EXPECT_EQ(search.plan(Vec3(nan, 2.1, 0.6), goal).code(), ErrorCode::invalid_input);
  EXPECT_EQ(search.plan(start, Vec3(0, inf, 0)).code(), ErrorCode::invalid_input);
  EXPECT_EQ(search.plan(Vec3(-9, 2.1, 0.6), goal).code(), ErrorCode::start_outside);
  EXPECT_EQ(search.plan(start, Vec3(1e300, 2.9, 1.4)).code(), ErrorCode::goal_outside);
  EXPECT_EQ(search.plan(Vec3(-0.5, 2.5, 1.0), goal).code(), ErrorCode::start_occupied);
  EXPECT_EQ(search.plan(start, Vec3(-0.5, 2.5, 1.0)).code(), ErrorCode::goal_occupied);
  EXPECT_EQ(search.plan(Vec3(-1.0, 2.5, 1.0), goal).code(), ErrorCode::start_occupied)
      << "on the face of the map";
  auto wrong = std::make_shared<VoxelGrid>(*grid);
  wrong->geometry.size = {5, 5, 6};
  search.set_map(wrong);
  EXPECT_EQ(search.plan(start, goal).code(), ErrorCode::invalid_input);
}

TEST(PathSearch, RefusesValuesWithoutAWord) {
  Config config;
  config.corner_rule = CornerRule(7);
  config.pruning = Pruning(-1);
  const auto refused = PathSearch::create(config);
  EXPECT_EQ(refused.code(), ErrorCode::invalid_parameter);
  EXPECT_THAT(refused.error().message, testing::HasSubstr("one of no_squeeze, squeeze; pruning"));
}

TEST(PathSearch, KeepsRawMovesThatTouchCornersUnderSqueeze) {
  BitGrid blocked({2, 2, 1}, true);
  blocked.set({1, 0, 0}, true);
  blocked.set({0, 1, 0}, true);
  const auto grid = grid_of(blocked);
  Config config;
  config.corner_rule = CornerRule::squeeze;
  PathSearch search = stage(config);
  search.set_map(grid);
  const auto path = search.plan(grid->geometry.center({0, 0, 0}), grid->geometry.center({1, 1, 0}));
  ASSERT_TRUE(path.ok());
  EXPECT_EQ(path->waypoints_map.size(), 2U);
}

TEST(PathSearch, ANewConfigAnswersAsOneThatBeganWithIt) {
  Random random(77);
  Config other;
  other.planner = Planner::astar;
  other.pruning = Pruning::none;
  other.clearance_m = 0.5;
  PathSearch fresh = stage(other);
  PathSearch changed = stage();
  EXPECT_TRUE(changed.reconfigure(other)) << "before any map";
  ASSERT_TRUE(changed.reconfigure(Config{}));
  for (int n = 0; n < 30; ++n) {
    const auto grid = grid_of(reference::any_map(random));
    const Vec3 start = inside(*grid, reference::free_voxel(grid->grown, random), random);
    const Vec3 goal = inside(*grid, reference::free_voxel(grid->grown, random), random);
    fresh.set_map(grid);
    changed.set_map(grid);
    (void)changed.plan(start, goal);
    ASSERT_TRUE(changed.reconfigure(other));
    const auto wanted = fresh.plan(start, goal), got = changed.plan(start, goal);
    ASSERT_EQ(got.code(), wanted.code());
    if (got) {
      EXPECT_EQ(got->waypoints_map, wanted->waypoints_map);
    }
    ASSERT_TRUE(changed.reconfigure(Config{}));
  }
}

TEST(PathSearch, AConfigThatTheMapCannotServeIsRefusedAndTheOldOneStays) {
  Random random(78);
  PathSearch search = stage();
  const auto grid = grid_of(reference::any_map(random));
  search.set_map(grid);
  Config bad;
  bad.search_box = "1000,1000,1000,1001,1001,1001";
  EXPECT_FALSE(search.reconfigure(bad));
  bad.search_box = "not a box";
  EXPECT_FALSE(search.reconfigure(bad));
  bad = Config{};
  bad.z_weight = -1.0;
  EXPECT_EQ(search.reconfigure(bad).code(), ErrorCode::invalid_parameter);
  const Vec3 start = inside(*grid, reference::free_voxel(grid->grown, random), random);
  EXPECT_TRUE(search.plan(start, start));
}

TEST(Config, OffersOnlyWordsThatItTakes) {
  Config config;
  int words_seen = 0;
  describe(config, [&](const char*, auto& value, const char*, const char*, const auto&) {
    using T = std::remove_reference_t<decltype(value)>;
    if constexpr (Worded<T>) {
      for (const auto& named : words_of(T{})) {
        const T before = std::exchange(value, named.value);
        EXPECT_TRUE(PathSearch::create(config).ok()) << named.word;
        value = before;
        ++words_seen;
      }
    }
  });
  EXPECT_EQ(words_seen, 8 + 2 + 4 + 4 + 2);
}

}  // namespace
}  // namespace goshawk::path_search
