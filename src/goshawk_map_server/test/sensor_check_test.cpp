#include "goshawk/map_server/sensor_check.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "goshawk/core/random.hpp"

namespace goshawk::map_server {
namespace {

constexpr double kHalfTurn_rad = std::numbers::pi;

// [m] from inside a room of 12 x 10 x 4 m to its walls
double to_wall(const Vec3& from, const Vec3& way) {
  const Vec3 lower(-6.07, -5.03, -2.11), upper(6.04, 5.08, 2.05);
  double range = 1e9;
  for (int a = 0; a < 3; ++a) {
    if (way[a] != 0.0) {
      range = std::min(range, ((way[a] > 0.0 ? upper[a] : lower[a]) - from[a]) / way[a]);
    }
  }
  return range;
}

struct Lidar {
  double from_rad = -kHalfTurn_rad, to_rad = kHalfTurn_rad;  // azimuths
  double missing_share = 0.0;
  bool sees_body = false;
  Pose mount = {};  // in base_link, as it really is
};

RecordedCloud cloud_of(const Lidar& lidar, const Pose& base, int number, Random& random) {
  RecordedCloud recorded;
  recorded.cloud.stamp_ns = 1'000'000'000 + number * 100'000'000LL;
  recorded.received_ns = recorded.cloud.stamp_ns + 30'000'000;
  const Pose sensor = base * lidar.mount;
  for (int row = 0; row < 24; ++row) {
    const double up = -0.4 + 0.8 * row / 23;
    for (int k = 0; k < 360; ++k) {
      const double angle = lidar.from_rad + (lidar.to_rad - lidar.from_rad) * (k + 0.5) / 360;
      ++recorded.claimed;
      if (random.chance(lidar.missing_share)) continue;
      const Vec3 way(std::cos(angle) * std::cos(up), std::sin(angle) * std::cos(up), std::sin(up));
      const bool arm = lidar.sees_body && row < 3 && std::abs(angle - 0.8) < 0.1;
      const double range = arm ? 0.25 : to_wall(sensor.position, sensor.q * way);
      recorded.cloud.points.push_back((range + random.uniform(-0.01, 0.01)) * way);
    }
  }
  return recorded;
}

struct Flight {
  std::vector<RecordedCloud> clouds;
  PoseBuffer odometry{"odometry", 100.0, 0.5};
};

// Along and across the room, turning about z and rolling.
Flight fly(const Lidar& lidar, bool turns = true) {
  Random random(71);
  Flight flight;
  for (int k = 0; k < 60; ++k) {
    const double yaw = turns ? 0.06 * k : 0.0, roll = turns ? 0.3 * std::sin(0.2 * k) : 0.0;
    const Pose base{
        Vec3(3.0 * std::sin(0.1 * k), 2.0 * std::cos(0.13 * k), 0.3 * std::sin(0.2 * k)),
        Quaternion(Eigen::AngleAxisd(yaw, Vec3::UnitZ()) * Eigen::AngleAxisd(roll, Vec3::UnitX()))};
    flight.clouds.push_back(cloud_of(lidar, base, k, random));
    EXPECT_TRUE(flight.odometry.add(flight.clouds.back().cloud.stamp_ns, base));
  }
  return flight;
}

TEST(SensorCheck, TellsRateLatencyViewAndMissingReturns) {
  const Flight flight = fly({.missing_share = 0.2});
  const SensorReport report = check_sensor(flight.clouds, {}).value();
  EXPECT_EQ(report.clouds, 60);
  EXPECT_NEAR(report.rate_hz, 10.0, 1e-6);
  EXPECT_NEAR(report.longest_gap_s, 0.1, 1e-9);
  EXPECT_NEAR(report.latency_mean_s, 0.03, 1e-9);
  EXPECT_NEAR(report.missing_share, 0.2, 0.01);
  EXPECT_NEAR(report.points, 0.8 * 24 * 360, 50.0);
  EXPECT_NEAR(report.elevation_lower_rad, -0.4, 1e-3);
  EXPECT_NEAR(report.elevation_upper_rad, 0.4, 1e-3);
  EXPECT_TRUE(report.blind.empty());
  EXPECT_EQ(report.body_share, 0.0);
  EXPECT_GT(report.range_most_m, report.range_median_m);
  EXPECT_LT(report.range_most_m, 12.5);
}

TEST(SensorCheck, TellsWhereTheSensorIsBlind) {
  const SensorReport ahead =
      check_sensor(fly({.from_rad = -1.0, .to_rad = 1.5}).clouds, {}).value();
  ASSERT_EQ(ahead.blind.size(), 1U);  // across the seam behind the sensor
  EXPECT_NEAR(ahead.blind[0].from_rad, 1.5 - 2.0 * kHalfTurn_rad, 0.06);
  EXPECT_NEAR(ahead.blind[0].to_rad, -1.0, 0.06);
  const SensorReport behind =
      check_sensor(fly({.from_rad = 0.5, .to_rad = 2.0 * kHalfTurn_rad - 0.5}).clouds, {}).value();
  ASSERT_EQ(behind.blind.size(), 1U);
  EXPECT_NEAR(behind.blind[0].from_rad, -0.5, 0.06);
  EXPECT_NEAR(behind.blind[0].to_rad, 0.5, 0.06);
}

TEST(SensorCheck, FindsTheVehiclesOwnBodyInView) {
  const SensorReport report = check_sensor(fly({.sees_body = true}).clouds, {}).value();
  const double arm_share = 3.0 * 0.2 / (2.0 * kHalfTurn_rad) / 24.0;
  EXPECT_NEAR(report.body_share, arm_share, 0.3 * arm_share);
  EXPECT_NEAR(report.body_reach_m, 0.26, 0.02);
}

TEST(SensorCheck, TheSpeedIsThatFromWhichTheVehicleStopsInTime) {
  const Flight flight = fly({});
  const SensorCheckOptions options{.a_max_m_s2 = 3.0, .reaction_s = 0.2, .margin_m = 1.0};
  const SensorReport report = check_sensor(flight.clouds, options).value();
  const double v = report.speed_m_s, before_s = 0.1 + 0.03 + 0.2;
  const double range_m = std::min(report.dense_range_m, report.range_most_m);
  EXPECT_GT(v, 1.0);
  EXPECT_NEAR(v * before_s + v * v / 6.0, range_m - 1.0, 1e-6);
  SensorCheckOptions narrow = options;
  narrow.margin_m = 50.0;
  EXPECT_EQ(check_sensor(flight.clouds, narrow)->speed_m_s, 0.0);
}

TEST(SensorCheck, NeedsCloudsWithReturns) {
  EXPECT_EQ(check_sensor({}, {}).code(), ErrorCode::invalid_input);
  EXPECT_EQ(check_sensor(std::vector<RecordedCloud>(3), {}).code(), ErrorCode::invalid_input);
}

TEST(MountCheck, FindsAMountThatIsTurnedAndNoneThatIsRight) {
  const Pose straight{Vec3(0.1, 0.0, 0.1), Quaternion::Identity()};
  const Flight right = fly({.mount = straight});
  const auto none = check_mount(right.clouds, straight, right.odometry, 0.2);
  ASSERT_TRUE(none) << none.error().message;
  EXPECT_FALSE(none->suspicious) << none->correction_rad.transpose() << ' ' << none->thinner_share;
  for (int axis = 0; axis < 3; ++axis) {
    Lidar turned{.mount = straight};
    Vec3 error = Vec3::Zero();
    error[axis] = 0.06;
    turned.mount.q = Quaternion(Eigen::AngleAxisd(0.06, Vec3::Unit(axis)));
    const Flight flight = fly(turned);
    const MountReport found = check_mount(flight.clouds, straight, flight.odometry, 0.2).value();
    EXPECT_TRUE(found.suspicious) << axis;
    EXPECT_LT((found.correction_rad - error).norm(), 0.02) << found.correction_rad.transpose();
  }
}

TEST(MountCheck, NeedsAVehicleThatTurnsAndOdometry) {
  const Flight straight = fly({}, false);
  EXPECT_EQ(check_mount(straight.clouds, {}, straight.odometry, 0.2).code(),
            ErrorCode::invalid_input);
  const PoseBuffer nothing("odometry", 100.0, 0.5);
  EXPECT_EQ(check_mount(straight.clouds, {}, nothing, 0.2).code(), ErrorCode::tracking_lost);
}

}  // namespace
}  // namespace goshawk::map_server
