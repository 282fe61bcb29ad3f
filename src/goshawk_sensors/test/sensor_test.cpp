#include "goshawk/sensors/sensor.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "goshawk/worlds/world.hpp"
#include "support.hpp"

namespace goshawk::sensors {
namespace {

using testing::HasSubstr;

constexpr std::int64_t kStart_ns = 1'000'000'000;

Sensor make(const SensorParameters& p) {
  auto sensor = Sensor::create(p);
  EXPECT_TRUE(sensor) << sensor.error().message;
  return *std::move(sensor);
}

VoxelWorld default_world() {
  const auto made = worlds::make_world(worlds::default_world());
  return {made->geometry, made->occupied, Boundary::box};
}

Pose hovering() {
  return {Vec3(3.0, 0.0, 1.0), Quaternion::Identity()};
}

int valid_in(const Scan& scan) {
  return int(std::count_if(scan.returns.begin(), scan.returns.end(),
                           [](const Return& r) { return r.valid; }));
}

class Presets : public testing::TestWithParam<Preset> {};

INSTANTIATE_TEST_SUITE_P(All, Presets,
                         testing::Values(Preset::vlp16, Preset::os0_128, Preset::os1_128,
                                         Preset::mid360, Preset::avia, Preset::d435),
                         [](const auto& test) { return std::string(to_word(test.param)); });

TEST_P(Presets, SeeASphereAroundThemAtItsRadius) {
  Sensor sensor = make(perfect(GetParam()));
  const auto scans = scans_at_rest(sensor, Sphere(Vec3::Zero(), 5.0), 0.25);
  ASSERT_GE(scans.size(), 2U);
  for (const Scan& scan : scans) {
    EXPECT_EQ(valid_in(scan), sensor.pattern().firings());
    for (int i = 0; i < sensor.pattern().firings(); ++i) {
      const Return& r = scan.returns[std::size_t(i)];
      const Firing f = sensor.pattern().at(scan.number, i);
      ASSERT_LT((r.point.cast<double>() - 5.0 * f.direction_sensor).norm(), 1e-5);
      ASSERT_EQ(r.ring, f.ring);
      ASSERT_EQ(r.offset_ns, f.offset_ns);
    }
  }
}

TEST_P(Presets, TheSameSeedGivesTheSameBytesAndAnotherSeedOthers) {
  SensorParameters p;
  apply_preset(GetParam(), p);
  p.returns.missing_share = 0.05;
  p.returns.false_share = 0.01;
  p.mount.body = Body::quadrotor;
  const VoxelWorld world = default_world();
  Sensor first = make(p), second = make(p);
  p.seed = 2;
  Sensor other = make(p);
  const auto a = scans_at_rest(first, world, 0.2, hovering());
  const auto b = scans_at_rest(second, world, 0.2, hovering());
  const auto c = scans_at_rest(other, world, 0.2, hovering());
  ASSERT_GE(a.size(), 2U);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_TRUE(same_bytes(a[i], b[i]));
    EXPECT_FALSE(same_bytes(a[i], c[i]));
  }
  EXPECT_FALSE(same_bytes(a[0], a[1])) << "each scan has noise of its own";
}

// Straight on at 4 m/s and turning at 1.2 rad/s: where each ray begins and what it sees of a wall
// has a closed form.
TEST(Sensor, MotionDistortsAScanAsTheClosedFormSays) {
  SensorParameters p = perfect(Preset::vlp16);
  p.mount = {.x_m = 0.1, .y_m = -0.05, .z_m = 0.2, .yaw_rad = 0.3};
  Sensor sensor = make(p);
  constexpr double kSpeed_m_s = 4.0, kTurn_rad_s = 1.2, kWall_m = 9.0;
  const auto pose = [&](double t) {
    return Pose{Vec3(kSpeed_m_s * t, 0.0, 1.0),
                Quaternion(Eigen::AngleAxisd(kTurn_rad_s * t, Vec3::UnitZ()))};
  };
  PoseTrack track;
  Scan scan;
  for (int i = 0; i <= 110; i += 5) {
    ASSERT_TRUE(track.add(kStart_ns + i * 1'000'000LL, pose(0.001 * i)));
    ASSERT_TRUE(sensor.advance(Wall(kWall_m), track, [&](const Scan& s) { scan = s; }));
  }
  ASSERT_EQ(scan.number, 0);
  EXPECT_EQ(scan.start_ns, kStart_ns);
  EXPECT_EQ(scan.end_ns, kStart_ns + 100'000'000);
  int checked = 0;
  double largest_shift_m = 0.0;
  for (int i = 0; i < sensor.pattern().firings(); ++i) {
    const Return& r = scan.returns[std::size_t(i)];
    const double t = 1e-9 * r.offset_ns;
    const double yaw = kTurn_rad_s * t;
    const Vec3 d = sensor.pattern().at(0, i).direction_sensor;
    const double slope = std::cos(yaw + 0.3) * d.x() - std::sin(yaw + 0.3) * d.y();
    const double x = kSpeed_m_s * t + 0.1 * std::cos(yaw) + 0.05 * std::sin(yaw);
    const double range_m = (kWall_m - x) / slope;
    const bool seen = range_m >= p.returns.range_min_m && range_m <= p.returns.range_max_m;
    ASSERT_EQ(r.valid, seen) << i;
    if (!seen) continue;
    ++checked;
    EXPECT_NEAR(double(r.point.norm()), range_m, 1e-4) << i;
    // A reader that ignores the motion puts the point here:
    const double undistorted = pose(0.0).position_map.x() + 0.1 +
                               std::cos(0.3) * double(r.point.x()) -
                               std::sin(0.3) * double(r.point.y());
    largest_shift_m = std::max(largest_shift_m, std::abs(undistorted - kWall_m));
  }
  EXPECT_GT(checked, 5000);
  EXPECT_GT(largest_shift_m, 0.3) << "motion must show";
}

TEST(Sensor, ADepthCameraMeasuresDepthNotRange) {
  SensorParameters p = perfect(Preset::d435);
  p.returns.range_max_m = 4.0;
  for (const double depth_m : {3.9, 4.1, 0.2}) {
    Sensor sensor = make(p);
    const auto scans = scans_at_rest(sensor, Wall(depth_m), 0.1);
    ASSERT_GE(scans.size(), 2U);
    const bool seen = depth_m == 3.9;
    EXPECT_EQ(valid_in(scans[0]), seen ? sensor.pattern().firings() : 0) << depth_m;
    for (const Return& r : scans[0].returns) {
      ASSERT_TRUE(!r.valid || std::abs(double(r.point.x()) - depth_m) < 1e-5);
    }
  }
}

TEST(Sensor, IntensityFollowsTheAngleOfIncidence) {
  SensorParameters p = perfect(Preset::avia);
  p.returns.reflectivity = 80.0;
  Sensor sensor = make(p);
  const auto scans = scans_at_rest(sensor, Wall(6.0), 0.1);
  ASSERT_FALSE(scans.empty());
  for (const Return& r : scans[0].returns) {
    ASSERT_TRUE(r.valid);
    ASSERT_NEAR(r.intensity, 80.0F * r.point.x() / r.point.norm(), 1e-3);
  }
}

TEST(Sensor, NearerThanTheMinimumRangeThereIsNoReturn) {
  SensorParameters p = perfect(Preset::avia);
  p.returns.range_min_m = 2.0;
  for (const double wall_m : {1.8, 2.5}) {
    Sensor sensor = make(p);
    const auto scans = scans_at_rest(sensor, Wall(wall_m), 0.1);
    ASSERT_FALSE(scans.empty());
    for (const Return& r : scans[0].returns) {
      EXPECT_TRUE(!r.valid || double(r.point.norm()) >= 2.0);
    }
    // The middle of the view sees the near wall too near, its rim far enough.
    EXPECT_GT(valid_in(scans[0]), 0);
    EXPECT_EQ(valid_in(scans[0]) < sensor.pattern().firings(), wall_m < 2.0);
  }
}

TEST(Sensor, TheVehiclesOwnBodyIsSeenWhereItIs) {
  SensorParameters p = perfect(Preset::os0_128);
  p.returns.range_min_m = 0.0;
  p.mount.z_m = 0.12;
  p.mount.rotor_share = 1.0;
  Sensor without = make(p);
  EXPECT_EQ(valid_in(scans_at_rest(without, Nothing(), 0.1)[0]), 0);
  p.mount.body = Body::quadrotor;
  Sensor with = make(p);
  const auto scans = scans_at_rest(with, Nothing(), 0.1);
  const int all = valid_in(scans[0]);
  EXPECT_GT(all, 1000);
  const double reach_m = p.mount.arm_length_m + p.mount.rotor_radius_m;
  for (const Return& r : scans[0].returns) {
    if (!r.valid) continue;
    const Vec3 p_base = with.mount().position_map + r.point.cast<double>();
    EXPECT_LE(p_base.head<2>().norm(), reach_m + 1e-3);
    EXPECT_LE(p_base.z(), 0.0451);  // the rotors' upper face
  }
  // Blades let most rays through, the arms none.
  p.mount.rotor_share = 0.0;
  Sensor still = make(p);
  const int frame = valid_in(scans_at_rest(still, Nothing(), 0.1)[0]);
  EXPECT_GT(frame, 100);
  EXPECT_LT(frame, all);
  // And the world shows behind them.
  p.returns.range_min_m = 0.6;
  Sensor blind = make(p);
  EXPECT_EQ(valid_in(scans_at_rest(blind, Nothing(), 0.1)[0]), 0) << "the minimum range hides it";
}

TEST(Sensor, TheDropShareOfTheScansIsNotHandedOut) {
  SensorParameters p = perfect(Preset::d435);
  p.pattern.width = p.pattern.height = 2;
  p.pattern.rate_hz = 1000.0;
  p.drop_share = 0.2;
  Sensor sensor = make(p);
  const auto scans = scans_at_rest(sensor, Wall(3.0), 4.0);
  const double n = 4001;
  EXPECT_NEAR(double(scans.size()) / n, 0.8, 5.0 * std::sqrt(0.16 / n));
  for (std::size_t i = 1; i < scans.size(); ++i) {
    EXPECT_EQ(scans[i].start_ns - scans[i - 1].start_ns,
              1'000'000 * (scans[i].number - scans[i - 1].number));
  }
}

TEST(Sensor, ADroppedScanDoesNotChangeTheOthers) {
  SensorParameters p;
  apply_preset(Preset::d435, p);
  p.pattern.width = p.pattern.height = 8;
  p.returns.range_noise_m = 0.1;
  Sensor all = make(p);
  p.drop_share = 0.5;
  Sensor some = make(p);
  const auto a = scans_at_rest(all, Wall(3.0), 1.0), b = scans_at_rest(some, Wall(3.0), 1.0);
  ASSERT_LT(b.size(), a.size());
  ASSERT_FALSE(b.empty());
  for (const Scan& scan : b) EXPECT_TRUE(same_bytes(scan, a[std::size_t(scan.number)]));
}

TEST(Sensor, HowOftenPosesComeDoesNotChangeWhatIsSeenAtRest) {
  SensorParameters p;
  apply_preset(Preset::vlp16, p);
  const VoxelWorld world = default_world();
  Sensor often = make(p), seldom = make(p);
  const auto a = scans_at_rest(often, world, 0.2, hovering());
  std::vector<Scan> b;
  PoseTrack track;
  ASSERT_TRUE(track.add(kStart_ns, hovering()));
  ASSERT_TRUE(track.add(kStart_ns + 200'000'000, hovering()));
  ASSERT_TRUE(seldom.advance(world, track, [&](const Scan& scan) { b.push_back(scan); }));
  ASSERT_EQ(a.size(), 2U);
  ASSERT_EQ(b.size(), 2U);
  EXPECT_TRUE(same_bytes(a[0], b[0]));
  EXPECT_TRUE(same_bytes(a[1], b[1]));
}

TEST(Sensor, InsideAnObstacleItSaysSoAndMeasuresAgainOutside) {
  Sensor sensor = make(perfect(Preset::vlp16));
  const Wall wall(2.0);
  PoseTrack track;
  int scans = 0;
  const auto done = [&](const Scan&) { ++scans; };
  Pose inside;
  inside.position_map.x() = 2.5;
  for (int i = 0; i <= 20; ++i) {
    ASSERT_TRUE(track.add(kStart_ns + i * 10'000'000LL, inside));
    const auto status = sensor.advance(wall, track, done);
    if (i == 0) continue;
    ASSERT_FALSE(status);
    EXPECT_EQ(status.code(), ErrorCode::collision);
    EXPECT_THAT(status.error().message, HasSubstr("inside of an obstacle at (2.500"));
  }
  EXPECT_EQ(scans, 0);
  // It is carried out within a step; from the scan after next all is well.
  int faults = 0;
  for (int i = 21; i <= 60; ++i) {
    ASSERT_TRUE(track.add(kStart_ns + i * 10'000'000LL, {}));
    if (!sensor.advance(wall, track, done)) ++faults;
  }
  EXPECT_LE(faults, 1);
  EXPECT_GE(scans, 2);
}

TEST(Sensor, AGapInThePosesCostsTheScanAndNoMore) {
  Sensor sensor = make(perfect(Preset::vlp16));
  const Sphere world(Vec3::Zero(), 5.0);
  PoseTrack track;
  std::vector<std::int64_t> starts;
  const auto done = [&](const Scan& scan) { starts.push_back(scan.start_ns - kStart_ns); };
  const auto feed = [&](int ms) {
    EXPECT_TRUE(track.add(kStart_ns + ms * 1'000'000LL, {}));
    return sensor.advance(world, track, done);
  };
  for (int ms = 0; ms <= 150; ms += 10) ASSERT_TRUE(feed(ms));
  const auto lost = feed(700);
  ASSERT_FALSE(lost);
  EXPECT_EQ(lost.code(), ErrorCode::tracking_lost);
  for (int ms = 710; ms <= 950; ms += 10) ASSERT_TRUE(feed(ms));
  EXPECT_EQ(starts, (std::vector<std::int64_t>{0, 700'000'000, 800'000'000}));
}

TEST(Sensor, TimeThatBeginsAnewBeginsANewScan) {
  Sensor sensor = make(perfect(Preset::vlp16));
  const Sphere world(Vec3::Zero(), 5.0);
  PoseTrack track;
  std::vector<std::int64_t> starts;
  const auto done = [&](const Scan& scan) { starts.push_back(scan.start_ns); };
  for (const std::int64_t begin : {5 * kStart_ns, kStart_ns}) {
    for (int i = 0; i <= 15; ++i) {
      ASSERT_TRUE(track.add(begin + i * 10'000'000LL, {}));
      EXPECT_TRUE(sensor.advance(world, track, done)) << i;
    }
  }
  ASSERT_EQ(starts.size(), 2U);
  EXPECT_EQ(starts[0], 5 * kStart_ns);
  EXPECT_EQ(starts[1], kStart_ns);
}

TEST(Sensor, TheMountTurnsAboutTheVehiclesAxesRollFirst) {
  const Pose down = mount_of({.x_m = 0.1, .pitch_rad = 0.5 * kPi});
  EXPECT_LT((down.q_map_base * Vec3::UnitX() + Vec3::UnitZ()).norm(), 1e-12) << "looks down";
  const Pose all = mount_of({.roll_rad = 0.1, .pitch_rad = 0.2, .yaw_rad = 0.3});
  const Eigen::Matrix3d expected =
      (Eigen::AngleAxisd(0.3, Vec3::UnitZ()) * Eigen::AngleAxisd(0.2, Vec3::UnitY()) *
       Eigen::AngleAxisd(0.1, Vec3::UnitX()))
          .toRotationMatrix();
  EXPECT_LT((all.q_map_base.toRotationMatrix() - expected).norm(), 1e-12);
}

}  // namespace
}  // namespace goshawk::sensors
