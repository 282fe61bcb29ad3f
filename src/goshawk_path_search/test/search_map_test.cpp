// What a search sees of the map: unknown space, a box, weights; and how it follows a map that changes.
#include <gtest/gtest.h>

#include <cmath>
#include <optional>

#include "goshawk/path_search/search_map.hpp"
#include "reference.hpp"
#include "stage_on.hpp"

namespace goshawk::path_search {
namespace {

using reference::grid_of;
using reference::Random;

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
    const auto path = stage_on(config, grid).plan(start, goal);
    return path.ok() ? path->cost / 0.2 : -1.0;
  };
  EXPECT_NEAR(cost(UnknownRule::as_mapped), 11.0, 1e-12);
  EXPECT_NEAR(cost(UnknownRule::free), 11.0, 1e-12);
  EXPECT_NEAR(cost(UnknownRule::costly), 11.0 + 0.6, 1e-12) << "cheaper through it than round it";
  EXPECT_NEAR(cost(UnknownRule::blocked), 9.0 + 2.0 * std::sqrt(2.0), 1e-12);
  grid->unknown_is_occupied = true;
  Config config;
  config.unknown = UnknownRule::costly;
  EXPECT_EQ(stage_on(config, grid).plan(start, goal).code(), ErrorCode::invalid_parameter);
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
    auto search = stage_on(config, grid);
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
  auto search = stage_on({}, before);
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
  auto search = stage_on({}, grid);
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
      stage_on(config, grid)
          .plan(grid->geometry.center({4, 10, 4}), grid->geometry.center({16, 10, 4}));
  ASSERT_TRUE(path.ok());
  EXPECT_EQ(path->implementation, "astar_weighted");
  for (const Vec3& p : path->raw_map) {
    const Vec3 away = (p - grid->geometry.center({10, 10, 4})) / 0.2;
    EXPECT_GT(std::max(std::abs(away.x()), std::abs(away.y())), 2.5);
  }
}

}  // namespace
}  // namespace goshawk::path_search
