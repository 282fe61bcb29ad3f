// The component as it is installed, a process of its own, in lock step with this test: the test
// gives the turns, sends odometry and keeps what the sensor publishes.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>

#include "goshawk/conversions/status.hpp"
#include "goshawk/conversions/vehicle.hpp"
#include "goshawk/map_server/octree.hpp"
#include "goshawk/runtime/node.hpp"
#include "goshawk/runtime/private_domain.hpp"
#include "goshawk/worlds/world.hpp"
#include "sensor_msgs.h"
#include "stage_process.hpp"
#include "tf2_msgs.h"

namespace goshawk::sensors {
namespace {

using runtime::MessageInfo;
using runtime::Qos;
using testing::HasSubstr;

constexpr double kMost_s = 120.0;  // of the machine's time, for everything

int private_domain() {
  static const int domain = runtime::hold_private_domain().value();
  setenv("ROS_DOMAIN_ID", std::to_string(domain).c_str(), 1);
  return domain;
}

/// Leads the lock step and moves the vehicle along y at 1 m/s.
class Vehicle {
 public:
  explicit Vehicle(runtime::Context& context) : node_(context, "vehicle") {
    node_.lead_lock_step({.followers = {"sensors"}, .step_s = 0.01, .speed = 0.0});
    odometry_ = node_.advertise<nav_msgs::msg::Odometry>("odom", Qos::best_effort());
    keep<sensor_msgs::msg::PointCloud2>("points", clouds);
    keep<sensor_msgs::msg::Image>("depth/image_rect_raw", images);
    keep<sensor_msgs::msg::CameraInfo>("depth/camera_info", infos);
    node_.subscribe<tf2_msgs::msg::TFMessage>(
        "/tf_static", Qos::latched(), [this](const auto& m, const MessageInfo&) { tf = m; });
    node_.subscribe<goshawk_msgs::msg::StageReport>(
        "stage_report", Qos::latched(20),
        [this](const auto& m, const MessageInfo&) { reports.push_back(m); });
    node_.every(0.01, [this] { send_odometry(); });
  }

  /// @return whether the condition came true in time
  bool run_until(const std::function<bool()>& condition) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(kMost_s);
    while (!condition() && std::chrono::steady_clock::now() < end) node_.spin_some(0.1);
    return condition();
  }

  /// [s] of simulated time since it began
  double time_s() const { return 1e-9 * double(node_.now_ns() - runtime::kFirst_ns); }

  bool said(const std::string& words) const {
    return std::any_of(reports.begin(), reports.end(),
                       [&](const auto& r) { return r.message().find(words) != std::string::npos; });
  }

  Vec3 start_map = Vec3(3.0, 0.0, 1.0);
  std::vector<sensor_msgs::msg::PointCloud2> clouds;
  std::vector<double> heard_s;  // when each cloud came
  std::vector<sensor_msgs::msg::Image> images;
  std::vector<sensor_msgs::msg::CameraInfo> infos;
  std::vector<goshawk_msgs::msg::StageReport> reports;
  std::optional<tf2_msgs::msg::TFMessage> tf;

 private:
  template <typename Message>
  void keep(const char* topic, std::vector<Message>& list) {
    node_.subscribe<Message>(topic, Qos::best_effort(10),
                             [this, &list](const Message& m, const MessageInfo&) {
                               list.push_back(m);
                               if (std::is_same_v<Message, sensor_msgs::msg::PointCloud2>) {
                                 heard_s.push_back(time_s());
                               }
                             });
  }

  void send_odometry() {
    RigidBodyState state;
    state.position_map = start_map + Vec3(0.0, std::min(time_s(), 1.0), 0.0);
    nav_msgs::msg::Odometry m;
    m.header(conversions::make_header(node_.now_ns()));
    conversions::fill_msg(state, m);
    EXPECT_TRUE(odometry_.publish(m));
  }

  runtime::Node node_;
  runtime::Publisher<nav_msgs::msg::Odometry> odometry_;
};

std::vector<std::string> call(const std::vector<std::string>& parameters) {
  std::vector<std::string> words{"sensors", "--ros-args", "-p", "lock_step:=true"};
  for (const auto& p : parameters) words.insert(words.end(), {"-p", p});
  return words;
}

std::unique_ptr<runtime::Context> context() {
  runtime::ContextOptions options;
  options.domain = private_domain();
  return runtime::Context::create(options).value();
}

// A small scan: it goes through the socket buffers of every machine.
const std::vector<std::string> kSmall{"columns:=90", "boundary:=box", "missing_share:=0.02"};

std::vector<std::string> with(std::vector<std::string> list, std::vector<std::string> more) {
  list.insert(list.end(), more.begin(), more.end());
  return list;
}

TEST(SensorsComponent, TwoRunsInLockStepGiveTheSameCloudsToTheLastBit) {
  std::vector<std::vector<sensor_msgs::msg::PointCloud2>> runs;
  for (const char* seed : {"seed:=1", "seed:=1", "seed:=2"}) {
    const auto dds = context();
    Vehicle vehicle(*dds);
    const Stage sensor(call(with(kSmall, {seed})));
    ASSERT_TRUE(vehicle.run_until([&] { return vehicle.clouds.size() >= 8; }));
    runs.push_back(vehicle.clouds);
  }
  for (std::size_t i = 0; i < 8; ++i) {
    ASSERT_EQ(runtime::encode(runs[0][i]), runtime::encode(runs[1][i])) << "cloud " << i;
    ASSERT_NE(runs[0][i], runs[2][i]);
  }
}

TEST(SensorsComponent, CloudsComeAtTheirRateWithTheirLatencyInTheirFrame) {
  const auto dds = context();
  Vehicle vehicle(*dds);
  const Stage sensor(call(with(kSmall, {"rate_hz:=10", "latency_s:=0.05", "frame:=os_lidar"})));
  ASSERT_TRUE(vehicle.run_until([&] { return vehicle.clouds.size() >= 6 && vehicle.tf; }));
  for (std::size_t i = 0; i < 6; ++i) {
    const auto& stamp = vehicle.clouds[i].header().stamp();
    const double start_s = stamp.sec() + 1e-9 * stamp.nanosec() - 1e-9 * runtime::kFirst_ns;
    EXPECT_NEAR(start_s, 0.01 + 0.1 * double(i), 1e-6) << "from the first pose on";
    EXPECT_NEAR(vehicle.heard_s[i], start_s + 0.15, 0.0101) << "end of the scan, latency, a step";
    EXPECT_EQ(vehicle.clouds[i].header().frame_id(), "os_lidar");
    EXPECT_GT(vehicle.clouds[i].width(), 500U);
  }
  ASSERT_EQ(vehicle.tf->transforms().size(), 1U);
  EXPECT_EQ(vehicle.tf->transforms()[0].child_frame_id(), "os_lidar");
  EXPECT_EQ(vehicle.tf->transforms()[0].transform().translation().z(), 0.1);
  EXPECT_TRUE(vehicle.said("1440 rays a scan, 10 scans a second"));
}

TEST(SensorsComponent, ADepthCameraPublishesImageInfoAndCloudOfOneMoment) {
  const auto dds = context();
  Vehicle vehicle(*dds);
  const Stage sensor(call({"preset:=d435", "width:=40", "height:=30", "boundary:=box",
                           "mount_yaw_rad:=1.57", "image_encoding:=16UC1"}));
  ASSERT_TRUE(vehicle.run_until([&] {
    return vehicle.images.size() >= 3 && vehicle.infos.size() >= 3 && vehicle.clouds.size() >= 3;
  }));
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(vehicle.images[i].encoding(), "16UC1");
    EXPECT_EQ(vehicle.images[i].data().size(), 40U * 30U * 2U);
    EXPECT_EQ(vehicle.infos[i].header(), vehicle.images[i].header());
    EXPECT_EQ(vehicle.clouds[i].header(), vehicle.images[i].header());
    EXPECT_GT(vehicle.clouds[i].width(), 100U);
  }
}

TEST(SensorsComponent, InsideAnObstacleItReportsAndLivesOn) {
  const auto dds = context();
  Vehicle vehicle(*dds);
  vehicle.start_map = Vec3(-50.0, 0.0, 1.0);  // outside of the box
  const Stage sensor(call(kSmall));
  ASSERT_TRUE(vehicle.run_until([&] { return vehicle.said("inside of an obstacle"); }));
  EXPECT_TRUE(vehicle.clouds.empty());
  vehicle.start_map = Vec3(3.0, -1.0, 1.0);
  EXPECT_TRUE(vehicle.run_until([&] { return !vehicle.clouds.empty(); }));
}

TEST(SensorsComponent, AWorldThatIsMissingIsReportedAndTakenWhenItComes) {
  const std::string path = testing::TempDir() + "/goshawk_sensors_late_world.bt";
  std::filesystem::remove(path);
  const auto dds = context();
  Vehicle vehicle(*dds);
  const Stage sensor(call(with(kSmall, {"world_file:=" + path})));
  ASSERT_TRUE(vehicle.run_until([&] { return vehicle.said("nothing is measured until"); }));
  EXPECT_TRUE(vehicle.said(path));
  EXPECT_TRUE(vehicle.clouds.empty());
  const auto made = worlds::make_world(worlds::default_world());
  ASSERT_TRUE(made);
  ASSERT_TRUE(map_server::save_voxels(made->geometry, made->occupied, {}, path));
  EXPECT_TRUE(vehicle.run_until([&] { return vehicle.clouds.size() >= 2; }));
  std::filesystem::remove(path);
}

TEST(SensorsComponent, UnusableParametersEndTheStartWithStatus2) {
  private_domain();
  for (const char* bad : {"channels:=0", "rate_hz:=0", "rate_hz:=.nan", "range_min_m:=200",
                          "preset:=vlp17", "frame:=''", "missing_share:=2", "boundary:=wall"}) {
    EXPECT_EQ(Stage(call({bad})).status(kMost_s), 2) << bad;
  }
  EXPECT_EQ(Stage(call({"cloud_frame:=map", "missing:=zero"})).status(kMost_s), 2);
}

}  // namespace
}  // namespace goshawk::sensors
