// What both generators promise: refusals that name the place, exactness anywhere, the same bits
// again.
#include <gmock/gmock.h>

#include <limits>

#include "goshawk/corridor_builder/corridor_builder.hpp"
#include "support/builders.hpp"
#include "support/corridor_checker.hpp"
#include "support/worlds.hpp"

namespace goshawk::corridor_builder {
namespace {

using test_support::builder_of;
using test_support::faults_of;
using test_support::world_with_wall;
using ::testing::HasSubstr;

constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

void expect_error(const Result<Corridor>& result, ErrorCode code, const char* words) {
  ASSERT_FALSE(result.ok());
  EXPECT_EQ(result.code(), code) << result.error().message;
  EXPECT_THAT(result.error().message, HasSubstr(words));
}

class BothGenerators : public ::testing::TestWithParam<Generator> {
 protected:
  CorridorBuilder builder_ = builder_of({.generator = GetParam()});
};

INSTANTIATE_TEST_SUITE_P(Corridor, BothGenerators,
                         ::testing::Values(Generator::ellipsoid, Generator::box));

TEST_P(BothGenerators, SaysItsName) {
  EXPECT_EQ(builder_.implementation(), to_word(GetParam()));
}

TEST_P(BothGenerators, RefusesAPathThatIsNoPath) {
  const VoxelGrid grid = world_with_wall();
  const Vec3 a(0.5, 0.5, 0.5);
  expect_error(builder_.build(grid, {}), ErrorCode::invalid_input, "0 points");
  expect_error(builder_.build(grid, std::vector{a}), ErrorCode::invalid_input, "1 points");
  for (const double bad : {kNaN, kInf, -kInf}) {
    expect_error(builder_.build(grid, std::vector{a, Vec3(bad, 1, 1)}), ErrorCode::invalid_input,
                 "waypoint 1 of the path, an end of segment 0");
  }
  VoxelGrid torn = grid;
  torn.geometry.size.x = 7;
  EXPECT_FALSE(builder_.build(torn, std::vector{a, a}).ok());
  EXPECT_FALSE(builder_.build(VoxelGrid{}, std::vector{a, a}).ok());
}

TEST_P(BothGenerators, NamesTheSegmentThatIsBlockedOrLeavesTheMap) {
  const VoxelGrid grid = world_with_wall();
  const Vec3 a(0.5, 0.5, 0.5), b(1.5, 0.5, 0.5), behind(3.0, 0.5, 0.5);
  expect_error(builder_.build(grid, std::vector{a, b, behind}), ErrorCode::segment_blocked,
               "segment 1");
  expect_error(builder_.build(grid, std::vector{Vec3(2.1, 0.5, 0.5), a}),
               ErrorCode::segment_blocked, "segment 0");
  expect_error(builder_.build(grid, std::vector{a, b, Vec3(0.5, 0.5, 2.5)}),
               ErrorCode::segment_blocked, "segment 1");
  expect_error(builder_.build(grid, std::vector{Vec3(1e300, 0, 0), a}), ErrorCode::segment_blocked,
               "leaves the map");
}

TEST_P(BothGenerators, SaysWhereASegmentEntersSpaceThatWasNeverMeasured) {
  VoxelGrid grid = world_with_wall();
  grid.known = BitGrid(grid.geometry.size, false, true);
  const std::vector<Vec3> path{{0.5, 0.5, 0.5}, {1.5, 0.5, 0.5}, {3.0, 0.5, 0.5}};
  expect_error(builder_.build(grid, path), ErrorCode::segment_blocked, "an obstacle (inflated");
  for (int y = 0; y < 10; ++y) {
    for (int z = 0; z < 5; ++z) grid.known.set({10, y, z}, false);
  }
  expect_error(builder_.build(grid, path), ErrorCode::segment_blocked, "segment 1");
  expect_error(builder_.build(grid, path), ErrorCode::segment_blocked, "never measured");
}

TEST_P(BothGenerators, StaysExactFarFromTheOriginAndRefusesAMapThatIsTooFar) {
  VoxelGrid grid = world_with_wall();
  const std::vector<Vec3> near{{2.0, 1.0, 0.5}, {0.5, 1.0, 0.5}, {1.5, 1.5, 1.9}};
  for (const double away_m : {1e3, 1e5, 1e12}) {
    grid.geometry.origin_map = Vec3(away_m, -away_m, 0.0);
    std::vector<Vec3> path;
    for (const Vec3& p : near) path.push_back(p + grid.geometry.origin_map);
    const auto corridor = builder_.build(grid, path);
    if (away_m > 1e6) {
      expect_error(corridor, ErrorCode::invalid_input, "too far");
      continue;
    }
    ASSERT_TRUE(corridor.ok()) << corridor.error().message;
    for (const Polytope& polytope : corridor->polytopes) {
      const Vec3 in_wall = grid.geometry.origin_map + Vec3(2.0 + 1e-6, 1.0, 0.5);
      EXPECT_GT(polytope.violation(in_wall), 0.0);
    }
  }
}

TEST_P(BothGenerators, WrapsAPathOfNoLength) {
  const VoxelGrid grid = world_with_wall();
  for (const Vec3& p : {Vec3(1.1, 1.1, 1.1), Vec3(2.0, 0.9, 0.5), Vec3(0.0, 0.0, 0.0)}) {
    const std::vector<Vec3> path{p, p, p};
    const auto corridor = builder_.build(grid, path);
    ASSERT_TRUE(corridor.ok()) << corridor.error().message;
    EXPECT_EQ(corridor->polytopes.size(), 1U);
    EXPECT_EQ(faults_of(*corridor, grid, path), "");
    EXPECT_GT(chebyshev_ball(corridor->polytopes[0]).radius_m, 0.1);
  }
}

TEST_P(BothGenerators, NamesASegmentOfNoLengthWithinAPath) {
  const VoxelGrid grid = world_with_wall();
  const Vec3 a(0.5, 1.0, 1.5), b(1.1, 1.1, 1.5);
  for (const auto& [path, name] : std::vector<std::pair<std::vector<Vec3>, const char*>>{
           {{a, a, b}, "segment 0"}, {{a, b, b}, "segment 1"}, {{a, b, b, a}, "segment 1"}}) {
    expect_error(builder_.build(grid, path), ErrorCode::invalid_input, name);
    expect_error(builder_.build(grid, path), ErrorCode::invalid_input, "no length");
  }
}

TEST_P(BothGenerators, StartAndGoalMayLieOnFacesEdgesAndCornersOfObstaclesAndOfTheMap) {
  const VoxelGrid grid = world_with_wall();
  const std::vector<std::vector<Vec3>> paths{
      {{2.0, 1.0, 0.5}, {0.5, 1.0, 0.5}},  // begins on the wall's face
      {{0.5, 1.0, 0.5}, {2.0, 1.0, 0.5}},  // ends there
      {{2.0, 1.0, 1.0}, {0.5, 1.0, 0.5}},  // begins on its upper edge
      {{1.0, 0.0, 0.5}, {1.0, 2.0, 0.5}},  // from map face to map face
      {{0.0, 0.0, 0.0}, {4.0, 2.0, 2.0}},  // from corner to corner, over the wall's edge
      {{0.0, 0.0, 2.0}, {4.0, 0.0, 2.0}},  // along an edge of the map
      {{0.1, 1.0, 0.5}, {2.0, 1.0, 1.5}, {3.9, 1.0, 0.5}},
  };
  for (const auto& path : paths) {
    const auto corridor = builder_.build(grid, path);
    ASSERT_TRUE(corridor.ok()) << to_text(path[0]) << " " << corridor.error().message;
    EXPECT_EQ(faults_of(*corridor, grid, path), "") << to_text(path[0]);
  }
}

TEST(CorridorBuilder, FollowsAPathAlongAnObstaclesFace) {
  const VoxelGrid grid = world_with_wall();
  const std::vector<Vec3> path{{2.0, 0.1, 0.5}, {2.0, 1.9, 0.5}};
  const auto corridor = builder_of({}).build(grid, path);
  ASSERT_TRUE(corridor.ok()) << corridor.error().message;
  EXPECT_EQ(faults_of(*corridor, grid, path), "");
}

TEST_P(BothGenerators, RefusesAGapOfNoWidth) {
  VoxelGrid grid = test_support::empty_world({4, 4, 1}, 1.0);
  test_support::fill(grid, {0, 2, 0}, {2, 4, 1});
  test_support::fill(grid, {2, 0, 0}, {4, 2, 1});
  expect_error(builder_.build(grid, std::vector<Vec3>{{0.5, 0.5, 0.5}, {3.5, 3.5, 0.5}}),
               ErrorCode::segment_blocked, "segment 0");
  const auto bent = builder_.build(
      grid, std::vector<Vec3>{{0.5, 1.0, 0.5}, {1.5, 1.5, 0.5}, {2.5, 2.5, 0.5}, {3.5, 2.5, 0.5}});
  EXPECT_FALSE(bent.ok());
}

TEST(CorridorBuilder, ConfigFaultsAreAllListedAtOnce) {
  const auto made = CorridorBuilder::create({.generator = Generator(9),
                                             .local_box_m = kNaN,
                                             .max_segment_m = 0.0,
                                             .expansion_passes = -1});
  ASSERT_FALSE(made.ok());
  EXPECT_EQ(made.code(), ErrorCode::invalid_parameter);
  for (const char* name : {"generator", "local_box_m", "max_segment_m", "expansion_passes"}) {
    EXPECT_THAT(made.error().message, HasSubstr(name));
  }
}

bool same_bits(const Corridor& a, const Corridor& b) {
  if (a.polytopes.size() != b.polytopes.size() || a.waypoints_map != b.waypoints_map) return false;
  for (std::size_t k = 0; k < a.polytopes.size(); ++k) {
    const Polytope& p = a.polytopes[k];
    const Polytope& q = b.polytopes[k];
    if (p != q) return false;
  }
  for (std::size_t k = 0; k < a.overlaps.size(); ++k) {
    if (a.overlaps[k].center_map != b.overlaps[k].center_map) return false;
    if (a.overlaps[k].radius_m != b.overlaps[k].radius_m) return false;
  }
  return true;
}

TEST_P(BothGenerators, AnswersTheSameBitsWhateverWasBuiltBefore) {
  Random random(11);
  const VoxelGrid grid = test_support::boxes_and_pillars({30, 40, 20}, 0.2, 0.3, 0.2, 3);
  for (int k = 0; k < 30; ++k) {
    const auto path = test_support::random_free_path(grid, 3, 3.0, random);
    if (path.empty()) continue;
    CorridorBuilder fresh = builder_of({.generator = GetParam()});
    const auto a = builder_.build(grid, path);
    const auto b = fresh.build(grid, path);
    ASSERT_TRUE(a.ok() && b.ok());
    EXPECT_TRUE(same_bits(*a, *b));
  }
}

// Only the last rounding of coordinates differs, and what it does to bisections.
TEST_P(BothGenerators, MovesWithTheWorldByWholeVoxels) {
  Random random(12);
  const VoxelGrid grid = test_support::boxes_and_pillars({40, 30, 16}, 0.25, 0.3, 0.25, 5);
  VoxelGrid moved = grid;
  const Vec3 shift(100 * 0.25, -37 * 0.25, 8 * 0.25);
  moved.geometry.origin_map += shift;
  for (int k = 0; k < 60; ++k) {
    auto path = test_support::random_free_path(grid, 3, 3.0, random);
    if (path.empty()) continue;
    std::vector<Vec3> there;
    for (Vec3& p : path) {
      p = (p * 0x1p20).array().round() * 0x1p-20;  // so that the sum is exact
      there.push_back(p + shift);
    }
    const auto a = builder_.build(grid, path);
    const auto b = builder_.build(moved, there);
    ASSERT_TRUE(a.ok() && b.ok());
    ASSERT_EQ(a->polytopes.size(), b->polytopes.size());
    for (std::size_t i = 0; i < a->polytopes.size(); ++i) {
      const Polytope& p = a->polytopes[i];
      const Polytope& q = b->polytopes[i];
      ASSERT_EQ(p.faces(), q.faces());
      EXPECT_LT((p.A() - q.A()).cwiseAbs().maxCoeff(), 1e-12);
      EXPECT_LT((p.b() + p.A() * shift - q.b()).cwiseAbs().maxCoeff(), 1e-11);
    }
  }
}

}  // namespace
}  // namespace goshawk::corridor_builder
