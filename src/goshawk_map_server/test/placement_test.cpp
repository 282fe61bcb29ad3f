#include "goshawk/map_server/placement.hpp"

#include <gmock/gmock.h>

#include "goshawk/core/random.hpp"

namespace goshawk::map_server {
namespace {

using ::testing::HasSubstr;

constexpr std::int64_t kStart = 1'000'000'000'000;

Quaternion yaw(double rad) {
  return Quaternion(Eigen::AngleAxisd(rad, Vec3::UnitZ()));
}

// A vehicle that flies along x and turns.
constexpr double kSpeed_m_s = 3.0, kTurn_rad_s = 2.0;
Pose truth(double time_s) {
  return {Vec3(kSpeed_m_s * time_s, 1.0, 2.0), yaw(kTurn_rad_s * time_s)};
}
std::int64_t stamp(double time_s) {
  return kStart + std::int64_t(1e9 * time_s);
}
PoseBuffer flown(double until_s) {
  PoseBuffer odometry("odometry", 5.0, 0.5);
  for (int k = 0; 0.01 * k <= until_s; ++k) {
    EXPECT_TRUE(odometry.add(stamp(0.01 * k), truth(0.01 * k)));
  }
  return odometry;
}

TEST(Placement, ACloudStandsWhereItWasMeasuredHoweverLateItComes) {
  const PoseBuffer odometry = flown(2.0);
  const FrameTree tree(5.0, 0.5);
  const auto chain = tree.chain("base_link", "base_link").value();
  const Vec3 wall_map(8.0, 3.0, 2.0);
  const Pose then = truth(1.234);
  SensorCloud cloud{stamp(1.234), {then.q.conjugate() * (wall_map - then.position)}, {}};
  PlacedCloud placed;
  ASSERT_TRUE(place(cloud, chain, odometry, placed));
  ASSERT_EQ(placed.origins_map.size(), 1U);
  EXPECT_LT((placed.points_map[0] - wall_map).norm(), 1e-3);
  EXPECT_LT((placed.origins_map[0] - then.position).norm(), 1e-6);
}

TEST(Placement, EveryPointHasItsOwnTime) {
  const PoseBuffer odometry = flown(2.0);
  FrameTree tree(5.0, 0.5);
  const Pose mount{Vec3(0.1, 0.0, -0.05), yaw(0.5)};
  tree.set_static("base_link", "lidar", mount);
  const auto chain = tree.chain("lidar", "base_link").value();
  Random random(3);
  SensorCloud cloud{stamp(1.0), {}, {}};
  std::vector<Vec3> walls;
  for (int i = 0; i < 500; ++i) {
    const double after_s = random.uniform(-0.05, 0.1);
    const Pose sensor = truth(1.0 + after_s) * mount;
    walls.push_back(Vec3(random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(0, 4)));
    cloud.points.push_back(sensor.q.conjugate() * (walls.back() - sensor.position));
    cloud.offsets_ns.push_back(std::int64_t(1e9 * after_s));
  }
  PlacedCloud placed;
  ASSERT_TRUE(place(cloud, chain, odometry, placed));
  ASSERT_EQ(placed.origins_map.size(), 500U);
  for (std::size_t i = 0; i < walls.size(); ++i) {
    // 0.25 ms at 3 m/s and, 15 m away, at 2 rad/s
    EXPECT_LT((placed.points_map[i] - walls[i]).norm(), 0.01);
  }
}

TEST(Placement, AMomentWithoutAPoseIsNotGuessed) {
  const PoseBuffer odometry = flown(1.0);
  const FrameTree tree(5.0, 0.5);
  const auto chain = tree.chain("base_link", "base_link").value();
  PlacedCloud placed;
  const std::vector<Vec3> points{Vec3(1, 0, 0), Vec3(2, 0, 0)};
  EXPECT_EQ(place({stamp(1.2), points, {}}, chain, odometry, placed).code(),
            ErrorCode::tracking_lost);
  EXPECT_EQ(place({stamp(0.95), points, {0, 100'000'000}}, chain, odometry, placed).code(),
            ErrorCode::tracking_lost);
  EXPECT_EQ(place({0, points, {}}, chain, odometry, placed).code(), ErrorCode::invalid_input);
}

TEST(FrameTree, JoinsFixedAndMovingFrames) {
  FrameTree tree(5.0, 0.5);
  tree.set_static("gimbal", "camera", {Vec3(0, 0, 0.1), Quaternion::Identity()});
  ASSERT_TRUE(tree.add("base_link", "gimbal", stamp(0.0), {Vec3(1, 0, 0), yaw(0.0)}));
  ASSERT_TRUE(tree.add("base_link", "gimbal", stamp(0.1), {Vec3(1, 0, 0), yaw(1.0)}));
  tree.set_static("camera", "optical", {Vec3(0.2, 0, 0), Quaternion::Identity()});
  const auto chain = tree.chain("optical", "base_link").value();
  const Pose pose = chain.at(stamp(0.05)).value();
  EXPECT_LT((pose.position - Vec3(1 + 0.2 * std::cos(0.5), 0.2 * std::sin(0.5), 0.1)).norm(),
            1e-6);
  EXPECT_EQ(chain.at(stamp(0.2)).code(), ErrorCode::tracking_lost);
  EXPECT_THAT(chain.at(stamp(0.2)).error().message, HasSubstr("'gimbal'"));
}

TEST(FrameTree, UnknownFramesAndCirclesAreRefused) {
  FrameTree tree(5.0, 0.5);
  tree.set_static("a", "b", {});
  tree.set_static("b", "a", {});
  EXPECT_EQ(tree.chain("a", "base_link").code(), ErrorCode::wrong_frame);
  EXPECT_EQ(tree.chain("nowhere", "base_link").code(), ErrorCode::wrong_frame);
  EXPECT_THAT(tree.chain("nowhere", "base_link").error().message, HasSubstr("'nowhere'"));
}

}  // namespace
}  // namespace goshawk::map_server
