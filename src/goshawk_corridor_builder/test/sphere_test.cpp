// The margin `sphere`: polytopes keep a radius from the obstacles as measured.

#include <gmock/gmock.h>

#include <cmath>

#include "goshawk/core/grid_update.hpp"
#include "goshawk/core/inflation.hpp"
#include "goshawk/corridor_builder/corridor_builder.hpp"
#include "support/corridor_checker.hpp"
#include "support/worlds.hpp"

namespace goshawk::corridor_builder {
namespace {

using ::testing::HasSubstr;

VoxelGrid random_scene(int kind, Random& random) {
  const double resolution_m = random.chance(0.5) ? 0.2 : random.uniform(0.05, 0.5);
  const Index3 size{16 + random.below(40), 16 + random.below(30), 6 + random.below(16)};
  VoxelGrid scene = test_support::empty_world(
      size, resolution_m, Vec3(random.uniform(-50, 50), random.uniform(-50, 50), 0));
  scene.inflation_m = resolution_m * (random.chance(0.5) ? 1.0 : random.uniform(0.2, 2.5));
  if (kind == 0) test_support::add_noise(scene, random.uniform(0.0, 0.02), random);
  for (int k = 0; kind > 0 && k < 12; ++k) {
    const Index3 lo{random.below(size.x), random.below(size.y),
                    kind == 1 ? random.below(size.z) : 0};
    test_support::fill(scene, lo,
                       {lo.x + 1 + random.below(3), lo.y + 1 + random.below(3),
                        kind == 1 ? lo.z + 1 + random.below(6) : size.z});
  }
  scene.raw = scene.grown;
  scene.grown = inflate(scene.raw, scene.inflation_m, resolution_m).value();
  return scene;
}

// The same map as one that was measured except for a box, which counts as an obstacle.
void forget(VoxelGrid& scene, Index3 lo, Index3 hi, bool grows) {
  VoxelGrid unknown = test_support::empty_world(scene.geometry.size, 0.2);
  test_support::fill(unknown, lo, hi);
  scene.known = BitGrid(scene.geometry.size, false, true);
  for (int z = lo.z; z < hi.z; ++z) {
    for (int y = lo.y; y < hi.y; ++y) scene.known.set_run(lo.x, hi.x, y, z, false);
  }
  scene.unknown_is_occupied = true;
  scene.unknown_grows = grows;
  scene.grown = grows ? inflate(unknown.grown, scene.inflation_m, 0.2).value() : unknown.grown;
}

CorridorBuilder sphere_builder() {
  return std::move(CorridorBuilder::create({.margin = Margin::sphere})).value();
}

TEST(DistanceToBox, AgreesWithKnownCases) {
  const Polytope box = Polytope::box({0, 0, 0}, {1, 1, 1});
  using test_support::distance_to_box;
  EXPECT_NEAR(distance_to_box(box, {2, 0.2, 0.2}, {3, 0.4, 0.4}), 1.0, 1e-9);         // faces
  EXPECT_NEAR(distance_to_box(box, {2, 2, 0.2}, {3, 3, 0.4}), std::sqrt(2.0), 1e-9);  // edges
  EXPECT_NEAR(distance_to_box(box, {2, 2, 2}, {3, 3, 3}), std::sqrt(3.0), 1e-9);      // corners
  EXPECT_EQ(distance_to_box(box, {0.5, 0.5, 0.5}, {3, 3, 3}), 0.0);
  Polytope roof;  // two faces that slope towards an edge along x at height 1
  roof.add(Vec3(0, 1, 1).normalized(), std::sqrt(0.5));
  roof.add(Vec3(0, -1, 1).normalized(), std::sqrt(0.5));
  roof.add(-Vec3::UnitZ(), 0.0);
  roof.add(Vec3::UnitX(), 1.0);
  roof.add(-Vec3::UnitX(), 1.0);
  EXPECT_NEAR(distance_to_box(roof, {-0.1, -5, 3}, {0.1, 5, 4}), 2.0, 1e-9);  // crossing edges
  EXPECT_NEAR(distance_to_box(roof, {-0.1, 1.5, 1}, {0.1, 5, 4}), 1.5 / std::sqrt(2.0), 1e-9);
}

TEST(SphereMargin, KeepsTheRadiusFromEveryRawVoxelAndHoldsThePath) {
  CorridorBuilder builder = sphere_builder();
  Random random(31);
  int segments = 0, narrow = 0;
  for (int w = 0; w < 90; ++w) {
    const VoxelGrid scene = random_scene(w % 3, random);
    for (int k = 0; k < 12; ++k) {
      const auto path = test_support::random_free_path(scene, 3, 5.0, random);
      if (path.empty()) continue;
      const auto corridor = builder.build(scene, path);
      ASSERT_TRUE(corridor.ok()) << corridor.error().message;
      ASSERT_TRUE(corridor->check().ok()) << corridor->check().error().message;
      EXPECT_EQ(corridor->waypoints_map.front(), path.front());
      EXPECT_EQ(corridor->waypoints_map.back(), path.back());
      for (const Polytope& polytope : corridor->polytopes) {
        ASSERT_EQ(
            test_support::sphere_faults(polytope, scene.raw, scene.geometry, scene.inflation_m), "")
            << "world " << w << ", path " << k;
      }
      for (const Ball& ball : corridor->overlaps) {
        narrow += ball.radius_m < (0.5 - 1e-5) * scene.geometry.resolution_m;
      }
      segments += int(path.size()) - 1;
    }
  }
  EXPECT_GT(segments, 1500);
  EXPECT_EQ(narrow, 0);
}

TEST(SphereMargin, TheCheckerSeesPlanesThatAreAMicrometreTooFarOut) {
  CorridorBuilder builder = sphere_builder();
  Random random(32);
  int seen = 0;
  for (int k = 0; k < 10; ++k) {
    const VoxelGrid scene = random_scene(1 + k % 2, random);
    const auto path = test_support::random_free_path(scene, 2, 3.0, random);
    if (path.empty()) continue;
    auto corridor = builder.build(scene, path);
    ASSERT_TRUE(corridor.ok());
    Polytope& polytope = corridor->polytopes[0];
    for (HalfSpace& face : polytope.half_spaces) face.offset_m += 1e-6;
    seen += !test_support::sphere_faults(polytope, scene.raw, scene.geometry, scene.inflation_m)
                 .empty();
  }
  EXPECT_GT(seen, 5);
}

TEST(SphereMargin, KeepsTheCentreOutOfUnknownSpaceAndTheSphereIfThatWasInflated) {
  const std::vector<Vec3> path{{0.5, 0.5, 0.5}, {1.5, 3.5, 1.5}};
  for (const bool grows : {false, true}) {
    VoxelGrid scene = test_support::empty_world({20, 20, 10}, 0.2);
    scene.raw = scene.grown;
    scene.inflation_m = 0.2;
    forget(scene, {10, 0, 0}, {20, 20, 10}, grows);
    const auto corridor = sphere_builder().build(scene, path);
    ASSERT_TRUE(corridor.ok()) << corridor.error().message;
    EXPECT_EQ(test_support::faults_of(*corridor, scene, path), "");
    const double width_m = grows ? 1.8 : 2.0;
    EXPECT_NEAR(test_support::volume_of(corridor->polytopes[0]), width_m * 4.0 * 2.0, 1e-3);
  }
}

TEST(SphereMargin, SeesAnUpdateOfTheMap) {
  VoxelGrid scene = test_support::empty_world({20, 20, 10}, 0.2);
  scene.raw = scene.grown;
  scene.known = BitGrid(scene.geometry.size, false, true);
  scene.inflation_m = 0.2;
  GridUpdate wall{0, 1, {}, {brick_of(scene, {0, 0, 0}), brick_of(scene, {0, 1, 0})}};
  for (Brick& brick : wall.bricks) {
    brick.grown.fill(0b111U << 11);
    brick.raw->fill(0b1U << 12);
  }
  ASSERT_TRUE(apply(scene, wall));
  const std::vector<Vec3> path{{0.5, 0.5, 0.5}, {1.5, 2.5, 0.5}};
  const auto corridor = sphere_builder().build(scene, path);
  ASSERT_TRUE(corridor.ok()) << corridor.error().message;
  EXPECT_EQ(test_support::sphere_faults(corridor->polytopes[0], scene.raw, scene.geometry, 0.2),
            "");
  EXPECT_LT(test_support::volume_of(corridor->polytopes[0]), 2.6 * 4.0 * 2.0);
}

TEST(SphereMargin, RefusesAMapWithoutRawVoxelsOrARadiusThatCannotBe) {
  Random random(33);
  VoxelGrid scene = random_scene(1, random);
  const std::vector<Vec3> path = test_support::random_free_path(scene, 1, 1.0, random);
  ASSERT_FALSE(path.empty());
  CorridorBuilder builder = sphere_builder();
  for (const double radius_m : {-0.2, 1e9, std::nan("")}) {
    scene.inflation_m = radius_m;
    EXPECT_EQ(builder.build(scene, path).code(), ErrorCode::invalid_input);
  }
  scene.inflation_m = 30.0 * scene.geometry.resolution_m;
  EXPECT_EQ(builder.build(scene, path).code(), ErrorCode::segment_blocked);
  scene.raw = {};
  EXPECT_EQ(builder.build(scene, path).code(), ErrorCode::invalid_input);
  EXPECT_THAT(builder.build(scene, path).error().message, HasSubstr("publish_raw"));
}

}  // namespace
}  // namespace goshawk::corridor_builder
