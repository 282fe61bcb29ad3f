#include "goshawk/closed_loop/live_mapper.hpp"

#include <gtest/gtest.h>

#include "goshawk/sensors/solid_world.hpp"

namespace goshawk::closed_loop {
namespace {

using sensors::Solid;
using sensors::SolidWorld;

const Vec3 kEye(0.1, 0.1, 2.1);

LiveMapper::Config config() {
  LiveMapper::Config c;
  c.sensor.pattern.rate_hz = 10.0;
  c.sensor.pattern.channels = 64;
  c.sensor.pattern.columns = 512;
  c.sensor.pattern.elevation_lower_rad = -0.8;
  c.sensor.pattern.elevation_upper_rad = 0.8;
  c.sensor.returns.range_min_m = 0.05;
  c.sensor.returns.range_max_m = 6.0;
  c.sensor.returns.range_noise_m = 0.0;
  c.sensor.mount.z_m = 0.0;
  c.box = {Vec3(-8.0, -8.0, 0.0), Vec3(8.0, 8.0, 4.0)};
  return c;
}

std::shared_ptr<const sensors::World> pillar() {
  return std::make_shared<const SolidWorld>(
      SolidWorld::create({Solid::cylinder(Vec3(3.0, 0.1, 0.0), 0.5, 4.0)}).value());
}

/// Half a second at one place.
void look_around(LiveMapper& mapper, const Vec3& place = kEye) {
  for (int ms = 0; ms <= 500; ++ms) {
    ASSERT_TRUE(mapper.look(1'000'000LL * ms, {place, Quaternion::Identity()}));
  }
}

bool is_known(const VoxelGrid& map, const Vec3& p) {
  return map.is_known(*map.geometry.index_of(p));
}
bool is_raw(const VoxelGrid& map, const Vec3& p) {
  return map.raw.get(*map.geometry.index_of(p));
}

TEST(LiveMapper, BeginsKnowingNothing) {
  const auto mapper = LiveMapper::create(config(), pillar()).value();
  EXPECT_EQ(mapper.map()->known.count(), 0);
  EXPECT_FALSE(mapper.map()->unknown_is_occupied);
}

TEST(LiveMapper, SeesThePillarNotWhatLiesBehind) {
  auto mapper = LiveMapper::create(config(), pillar()).value();
  const auto before = mapper.map();
  look_around(mapper);
  EXPECT_GE(mapper.scans(), 4);
  const VoxelGrid& map = *mapper.map();
  EXPECT_TRUE(is_raw(map, Vec3(2.55, 0.1, 2.1)));
  EXPECT_TRUE(is_known(map, Vec3(1.5, 0.1, 2.1)));
  EXPECT_FALSE(is_raw(map, Vec3(1.5, 0.1, 2.1)));
  EXPECT_FALSE(is_known(map, Vec3(4.5, 0.1, 2.1)));
  EXPECT_EQ(before->known.count(), 0) << "a version that others hold has changed";
}

// By the definition of the map: every occupied voxel holds a point of the pillar's surface.
TEST(LiveMapper, WithoutNoiseWhatIsOccupiedTouchesTheWorld) {
  auto mapper = LiveMapper::create(config(), pillar()).value();
  look_around(mapper);
  const VoxelGrid& map = *mapper.map();
  int occupied = 0;
  for (int z = 0; z < map.geometry.size.z; ++z) {
    for (int y = 0; y < map.geometry.size.y; ++y) {
      for (int x = 0; x < map.geometry.size.x; ++x) {
        if (!map.raw.get({x, y, z})) continue;
        ++occupied;
        const Vec3 lower = map.geometry.lower_corner({x, y, z});
        const Eigen::Vector2d axis(3.0, 0.1), lo = lower.head<2>();
        const Eigen::Vector2d hi = lo + Eigen::Vector2d::Constant(0.2);
        const double near = (axis - axis.cwiseMax(lo).cwiseMin(hi)).norm();
        const double far = (axis - lo).cwiseAbs().cwiseMax((axis - hi).cwiseAbs()).norm();
        EXPECT_LE(near, 0.5 + 1e-6) << to_text(lower);
        EXPECT_GE(far, 0.5 - 1e-6) << to_text(lower);
      }
    }
  }
  EXPECT_GT(occupied, 50);
}

TEST(LiveMapper, ARayWithoutReturnFreesSpaceIfSaid) {
  auto mapper = LiveMapper::create(config(), pillar()).value();
  look_around(mapper);
  EXPECT_TRUE(is_known(*mapper.map(), Vec3(-5.0, 0.1, 2.1)));
  EXPECT_FALSE(is_known(*mapper.map(), Vec3(-7.0, 0.1, 2.1))) << "beyond the range";

  auto cautious = config();
  cautious.missing_is_free = false;
  auto other = LiveMapper::create(cautious, pillar()).value();
  look_around(other);
  EXPECT_FALSE(is_known(*other.map(), Vec3(-5.0, 0.1, 2.1)));
}

TEST(LiveMapper, WhereTheBodyIsIsFree) {
  auto mapper = LiveMapper::create(config(), pillar()).value();
  look_around(mapper);
  EXPECT_TRUE(is_known(*mapper.map(), kEye + Vec3(0.0, 0.0, 0.2)));
  EXPECT_TRUE(is_known(*mapper.map(), kEye - Vec3(0.0, 0.0, 0.2)));
}

TEST(LiveMapper, SaysWhatCannotBe) {
  auto mapper = LiveMapper::create(config(), pillar()).value();
  const auto inside = mapper.look(0, {Vec3(3.0, 0.1, 2.0), Quaternion::Identity()});
  ASSERT_FALSE(inside);
  EXPECT_EQ(inside.error().code, ErrorCode::collision);

  auto blind = config();
  blind.sensor.returns.range_min_m = 0.5;  // a surface that is too near gives no return either
  EXPECT_EQ(LiveMapper::create(blind, pillar()).error().code, ErrorCode::invalid_parameter);
  auto coarse = config();
  coarse.resolution_m = 0.0;
  EXPECT_FALSE(LiveMapper::create(coarse, pillar()));
}

}  // namespace
}  // namespace goshawk::closed_loop
