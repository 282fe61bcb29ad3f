#include "goshawk/sensors/solid_world.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support.hpp"

namespace goshawk::sensors {
namespace {

using testing::HasSubstr;

SolidWorld world_of(std::vector<Solid> solids) {
  auto world = SolidWorld::create(std::move(solids));
  EXPECT_TRUE(world) << world.error().message;
  return *std::move(world);
}

TEST(SolidWorld, CylindersAreMetOnTheMantleAndOnTheirEnds) {
  const auto world = world_of({Solid::cylinder(Vec3(5.0, 0.0, 0.0), 1.0, 2.0)});
  const Hit mantle = cast_one(world, {Vec3(0.0, 0.6, 1.0), Vec3::UnitX(), 10.0});
  EXPECT_NEAR(mantle.range_m, 5.0 - 0.8, 1e-12);
  EXPECT_NEAR(mantle.cosine, 0.8, 1e-12);
  const Hit end = cast_one(world, {Vec3(5.3, 0.2, 6.0), -Vec3::UnitZ(), 10.0});
  EXPECT_NEAR(end.range_m, 4.0, 1e-12);
  EXPECT_NEAR(end.cosine, 1.0, 1e-12);
  EXPECT_FALSE(cast_one(world, {Vec3(0.0, 1.01, 1.0), Vec3::UnitX(), 10.0}).any());
  EXPECT_FALSE(cast_one(world, {Vec3(0.0, 0.0, 1.0), Vec3::UnitX(), 3.9}).any()) << "range";
  EXPECT_FALSE(cast_one(world, {Vec3(0.0, 0.0, 1.0), -Vec3::UnitX(), 10.0}).any()) << "behind";
}

TEST(SolidWorld, FromInsideTheRangeIsZero) {
  const auto world = world_of({Solid::box(Vec3(-1.0, -1.0, -1.0), Vec3(1.0, 1.0, 1.0)),
                               Solid::cylinder(Vec3(4.0, 0.0, 0.0), 0.5, 1.0)});
  EXPECT_TRUE(world.contains(Vec3(0.5, 0.9, -0.9)));
  EXPECT_TRUE(world.contains(Vec3(4.3, 0.3, 0.5)));
  EXPECT_FALSE(world.contains(Vec3(4.4, 0.4, 0.5)));
  EXPECT_EQ(cast_one(world, {Vec3(0.5, 0.5, 0.5), Vec3::UnitX(), 10.0}).range_m, 0.0);
}

TEST(SolidWorld, TheTreeFindsTheFirstOfMany) {
  Random random(4);
  std::vector<Solid> solids;
  for (int i = 0; i < 800; ++i) {
    const Vec3 foot = random_point(random, Vec3(0.0, -20.0, 0.0), Vec3(100.0, 20.0, 0.1));
    solids.push_back(Solid::cylinder(foot, random.uniform(0.2, 1.0), random.uniform(1.0, 6.0)));
  }
  const auto all = world_of(solids);
  std::vector<SolidWorld> alone;
  for (const Solid& s : solids) alone.push_back(world_of({s}));
  for (int i = 0; i < 300; ++i) {
    const Vec3 origin = random_point(random, Vec3(0.0, -20.0, 0.5), Vec3(100.0, 20.0, 5.0));
    const Ray ray{origin, random_direction(random), 40.0};
    Hit best;
    for (const auto& one : alone) {
      const Hit hit = cast_one(one, ray);
      if (hit.range_m < best.range_m) best = hit;
    }
    const Hit hit = cast_one(all, ray);
    EXPECT_EQ(hit.range_m, best.range_m);
    EXPECT_EQ(hit.cosine, best.cosine);
  }
}

TEST(SolidWorld, ManySolidsInOnePlaceAreFine) {
  const auto world = world_of(std::vector<Solid>(5000, Solid::cylinder(Vec3(2, 0, 0), 0.5, 1.0)));
  EXPECT_NEAR(cast_one(world, {Vec3(0.0, 0.0, 0.5), Vec3::UnitX(), 9.0}).range_m, 1.5, 1e-12);
}

TEST(SolidWorld, AnUnusableSolidIsRefusedWithItsNumber) {
  const Solid good = Solid::box(Vec3::Zero(), Vec3::Ones());
  for (int fault = 0; fault < 4; ++fault) {
    Solid bad = good;
    if (fault == 0) bad.half.y() = 0.0;
    if (fault == 1) bad.center.x() = std::nan("");
    if (fault == 2) bad.half.z() = -1.0;
    if (fault == 3) bad.rotation.coeffs() *= 2.0;
    const auto world = SolidWorld::create({good, bad});
    ASSERT_FALSE(world) << fault;
    EXPECT_EQ(world.code(), ErrorCode::invalid_input);
    EXPECT_THAT(world.error().message, HasSubstr("solid 1 "));
  }
  EXPECT_TRUE(world_of({}).empty());
  EXPECT_FALSE(cast_one(world_of({}), {Vec3::Zero(), Vec3::UnitX(), 9.0}).any());
}

}  // namespace
}  // namespace goshawk::sensors
