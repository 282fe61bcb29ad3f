// The component as it is installed, spun beside a node that feeds it and listens.
#include <gmock/gmock.h>

#include <chrono>
#include <cmath>
#include <cstring>

#include "goshawk/conversions/geometry.hpp"
#include "goshawk/conversions/moving_boxes.hpp"
#include "goshawk/conversions/vehicle.hpp"
#include "goshawk/runtime/component.hpp"
#include "goshawk/runtime/private_domain.hpp"
#include "sensor_msgs.h"

namespace goshawk::obstacle_tracker {
namespace {

using namespace goshawk::runtime;
namespace msg = goshawk_msgs::msg;
using sensor_msgs::msg::PointCloud2;

constexpr double kMost_s = 120.0;  // of the machine's time

/// Points in frame map.
PointCloud2 cloud_of(const std::vector<Vec3>& points, std::int64_t stamp_ns,
                     const std::string& frame = "map") {
  PointCloud2 m;
  m.header(conversions::make_header(stamp_ns, frame));
  const char* names[] = {"x", "y", "z"};
  for (std::uint32_t i = 0; i < 3; ++i) {
    sensor_msgs::msg::PointField field;
    field.name(names[i]);
    field.offset(4 * i);
    field.datatype(7);  // float32
    field.count(1);
    m.fields().push_back(field);
  }
  m.height(1);
  m.width(std::uint32_t(points.size()));
  m.point_step(12);
  m.row_step(12 * m.width());
  m.data().resize(m.row_step());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3f p = points[i].cast<float>();
    std::memcpy(m.data().data() + 12 * i, p.data(), 12);
  }
  return m;
}

/// A person at y before a wall.
std::vector<Vec3> scene(double y) {
  std::vector<Vec3> points;
  for (int i = -40; i <= 40; ++i) {
    for (int k = -8; k <= 14; ++k) {
      const Vec3 direction(1.0, 0.018 * i, 0.018 * k);
      const bool person = std::abs(4.0 * direction.y() - y) < 0.25 && 4.0 * direction.z() < 0.8;
      points.push_back(Vec3(0, 0, 1) + (person ? 4.0 : 8.0) * direction);
    }
  }
  return points;
}

class TrackerComponent : public testing::Test {
 protected:
  TrackerComponent() {
    static const int domain = hold_private_domain().value();
    setenv("ROS_DOMAIN_ID", std::to_string(domain).c_str(), 1);
    ContextOptions options;
    options.domain = domain;
    context_ = Context::create(options).value();
  }

  void start(const std::string& source) {
    std::vector<std::string> words{"--ros-args", "-p", "source:=" + source};
    tracker_ =
        std::make_unique<Node>(*context_, "obstacle_tracker", RosArgs::extract(words).value());
    component_ = load_component("obstacle_tracker").value()->create(*tracker_);
    feeder_ = std::make_unique<Node>(*context_, "feeder");
    feeder_->subscribe<msg::PredictedObstacles>(
        "obstacles", Qos::reliable_last(10),
        [this](const msg::PredictedObstacles& m, const MessageInfo&) { obstacles.push_back(m); });
    feeder_->subscribe<msg::MovingBoxes>(
        "tracks", Qos::best_effort(10),
        [this](const msg::MovingBoxes& m, const MessageInfo&) { tracks.push_back(m); });
    feeder_->subscribe<msg::StageReport>(
        "stage_report", Qos::latched(20),
        [this](const msg::StageReport& m, const MessageInfo&) { said += m.message() + "\n"; });
  }

  /// Spins both, calling `feed` before each turn. @return whether the condition came true in time
  bool run_until(const std::function<bool()>& condition, const std::function<void()>& feed) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(kMost_s);
    while (!condition() && std::chrono::steady_clock::now() < end) {
      feed();
      tracker_->spin_some(0.01);
      feeder_->spin_some(0.01);
    }
    return condition();
  }

  std::unique_ptr<Context> context_;
  std::unique_ptr<Node> tracker_, feeder_;
  std::unique_ptr<Component> component_;
  std::vector<msg::PredictedObstacles> obstacles;
  std::vector<msg::MovingBoxes> tracks;
  std::string said;
};

TEST_F(TrackerComponent, BoxesOfAnotherBecomePredictions) {
  start("movers");
  const auto truth = feeder_->advertise<msg::MovingBoxes>("movers", Qos::best_effort(2));
  msg::MovingBoxes m;
  conversions::fill_msg({{.id = 3,
                          .kind = "person",
                          .position_map = Vec3(1, 2, 1),
                          .half_m = Vec3(0.3, 0.3, 0.9),
                          .velocity_map = Vec3(1, 0, 0)}},
                        m);
  const auto feed = [&] {
    m.header(conversions::make_header(feeder_->now_ns()));
    EXPECT_TRUE(truth.publish(m));
  };
  ASSERT_TRUE(run_until([&] { return obstacles.size() >= 3 && tracks.size() >= 3; }, feed));
  EXPECT_EQ(obstacles[2].obstacles().at(0).id(), 3u);
  EXPECT_EQ(obstacles[2].obstacles().at(0).kind(), "person");
  EXPECT_GT(obstacles[2].version(), obstacles[1].version());
  EXPECT_EQ(conversions::from_msg(tracks[0])->at(0).velocity_map, Vec3(1, 0, 0));
  m.boxes()[0].half_extents().x(-1.0);
  EXPECT_TRUE(run_until([&] { return said.find("half extents") != std::string::npos; }, feed));
}

TEST_F(TrackerComponent, CloudsBecomeTracksAndBadOnesAreNamed) {
  start("clouds");
  const auto clouds = feeder_->advertise<PointCloud2>("cloud_in", Qos::best_effort(2));
  const auto odometry = feeder_->advertise<nav_msgs::msg::Odometry>("odom", Qos::best_effort(50));
  // Time is the stamps': as fast as the test can. What is not answered yet is sent again, since
  // messages are lost before both have found each other.
  std::int64_t stamp_ns = 1'000'000'000'000;
  std::size_t answered = 0;
  int step = 0;
  PointCloud2 cloud;
  const auto feed = [&] {
    if (step == 0 || obstacles.size() > answered) {
      answered = obstacles.size();
      stamp_ns += 100'000'000;
      cloud = cloud_of(scene(-1.2 + 0.1 * std::max(0, step - 8)), stamp_ns);
      ++step;
    }
    nav_msgs::msg::Odometry odom;
    conversions::fill_msg(RigidBodyState{.position_map = Vec3(0, 0, 1)}, odom);
    odom.header().stamp(conversions::to_stamp(stamp_ns));
    EXPECT_TRUE(odometry.publish(odom));
    EXPECT_TRUE(clouds.publish(cloud));
  };
  const auto is_tracked = [&] {
    return !obstacles.empty() && !obstacles.back().obstacles().empty();
  };
  ASSERT_TRUE(run_until(is_tracked, feed)) << said;
  const auto& o = obstacles.back().obstacles()[0];
  EXPECT_GT(o.track().at(0).control_points().at(1).y(), o.track()[0].control_points()[0].y());
  const auto lost = [&] { EXPECT_TRUE(clouds.publish(cloud_of(scene(0), stamp_ns, "moon"))); };
  EXPECT_TRUE(run_until([&] { return said.find("moon") != std::string::npos; }, lost)) << said;
  const auto broken = [&] {
    PointCloud2 m = cloud_of(scene(0), stamp_ns);
    m.data().resize(7);
    EXPECT_TRUE(clouds.publish(m));
  };
  const std::size_t before = said.size();
  EXPECT_TRUE(run_until([&] { return said.find("bytes", before) != std::string::npos; }, broken))
      << said;
}

}  // namespace
}  // namespace goshawk::obstacle_tracker
