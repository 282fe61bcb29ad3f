// The margin `sphere`: polytopes keep a radius from the map before it was grown.

#include <gmock/gmock.h>

#include <cmath>

#include "goshawk/core/inflation.hpp"
#include "goshawk/corridor_builder/corridor_builder.hpp"
#include "support/corridor_checker.hpp"
#include "support/worlds.hpp"

namespace goshawk::corridor_builder {
namespace {

using ::testing::HasSubstr;

struct Scene {
  BitGrid raw;
  VoxelGrid grown;
  double radius_m = 0.2;

  RawObstacles obstacles() const { return {&raw, radius_m, nullptr}; }
};

Scene random_scene(int kind, Random& random) {
  const double resolution_m = random.chance(0.5) ? 0.2 : random.uniform(0.05, 0.5);
  const Index3 size{16 + random.below(40), 16 + random.below(30), 6 + random.below(16)};
  Scene scene;
  scene.radius_m = resolution_m * (random.chance(0.5) ? 1.0 : random.uniform(0.2, 2.5));
  scene.grown = test_support::empty_world(
      size, resolution_m, Vec3(random.uniform(-50, 50), random.uniform(-50, 50), 0));
  if (kind == 0) test_support::add_noise(scene.grown, random.uniform(0.0, 0.02), random);
  for (int k = 0; kind > 0 && k < 12; ++k) {
    const Index3 lo{random.below(size.x), random.below(size.y),
                    kind == 1 ? random.below(size.z) : 0};
    test_support::fill(scene.grown, lo,
                       {lo.x + 1 + random.below(3), lo.y + 1 + random.below(3),
                        kind == 1 ? lo.z + 1 + random.below(6) : size.z});
  }
  scene.raw = scene.grown.occupied;
  scene.grown.occupied = inflate(scene.raw, scene.radius_m, resolution_m).value();
  scene.grown.inflation_m = scene.radius_m;
  return scene;
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
    const Scene scene = random_scene(w % 3, random);
    const RawObstacles raw = scene.obstacles();
    for (int k = 0; k < 12; ++k) {
      const auto path = test_support::random_free_path(scene.grown, 3, 5.0, random);
      if (path.empty()) continue;
      const auto corridor = builder.build(scene.grown, path, &raw);
      ASSERT_TRUE(corridor.ok()) << corridor.error().message;
      ASSERT_TRUE(corridor->check().ok()) << corridor->check().error().message;
      EXPECT_EQ(corridor->waypoints_map.front(), path.front());
      EXPECT_EQ(corridor->waypoints_map.back(), path.back());
      for (const Polytope& polytope : corridor->polytopes) {
        ASSERT_EQ(
            test_support::sphere_faults(polytope, scene.raw, scene.grown.geometry, scene.radius_m),
            "")
            << "world " << w << ", path " << k;
      }
      for (const Ball& ball : corridor->overlaps) {
        narrow += ball.radius_m < (0.5 - 1e-5) * scene.grown.geometry.resolution_m;
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
    const Scene scene = random_scene(1 + k % 2, random);
    const RawObstacles raw = scene.obstacles();
    const auto path = test_support::random_free_path(scene.grown, 2, 3.0, random);
    if (path.empty()) continue;
    auto corridor = builder.build(scene.grown, path, &raw);
    ASSERT_TRUE(corridor.ok());
    Polytope& polytope = corridor->polytopes[0];
    for (HalfSpace& face : polytope.half_spaces) face.offset_m += 1e-6;
    seen += !test_support::sphere_faults(polytope, scene.raw, scene.grown.geometry, scene.radius_m)
                 .empty();
  }
  EXPECT_GT(seen, 5);
}

TEST(SphereMargin, KeepsTheCentreOutOfForbiddenVoxelsWithoutARadius) {
  Scene scene;
  scene.grown = test_support::empty_world({20, 20, 10}, 0.2);
  scene.raw = scene.grown.occupied;
  VoxelGrid unknown = scene.grown;
  test_support::fill(unknown, {10, 0, 0}, {20, 20, 10});
  scene.grown.occupied = unknown.occupied;
  const RawObstacles raw{&scene.raw, 0.2, &unknown.occupied};
  const std::vector<Vec3> path{{0.5, 0.5, 0.5}, {1.5, 3.5, 1.5}};
  const auto corridor = sphere_builder().build(scene.grown, path, &raw);
  ASSERT_TRUE(corridor.ok()) << corridor.error().message;
  EXPECT_EQ(test_support::faults_of(*corridor, scene.grown, path), "");
  EXPECT_NEAR(test_support::volume_of(corridor->polytopes[0]), 2.0 * 4.0 * 2.0, 1e-3);
}

TEST(SphereMargin, RefusesAMapThatIsNotThereOrDoesNotFit) {
  Random random(33);
  const Scene scene = random_scene(1, random);
  const std::vector<Vec3> path = test_support::random_free_path(scene.grown, 1, 1.0, random);
  ASSERT_FALSE(path.empty());
  const BitGrid small({2, 2, 2}, true);
  const RawObstacles none, wrong{&small, 0.2, nullptr}, negative{&scene.raw, -0.2, nullptr},
      endless{&scene.raw, 1e9, nullptr}, nan{&scene.raw, std::nan(""), nullptr};
  CorridorBuilder builder = sphere_builder();
  EXPECT_THAT(builder.build(scene.grown, path).error().message, HasSubstr("before obstacles"));
  for (const RawObstacles* raw : {&none, &wrong, &negative, &endless, &nan}) {
    EXPECT_EQ(builder.build(scene.grown, path, raw).code(), ErrorCode::invalid_input);
  }
  const RawObstacles larger{&scene.raw, 30.0 * scene.grown.geometry.resolution_m, nullptr};
  EXPECT_EQ(builder.build(scene.grown, path, &larger).code(), ErrorCode::segment_blocked);
}

}  // namespace
}  // namespace goshawk::corridor_builder
