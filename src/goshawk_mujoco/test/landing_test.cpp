// Who is lost by his pilot lands where the map says so: tracker and autopilot as installed, over
// DDS, in lock step with this test, which falls silent and then serves the map.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>

#include "goshawk/conversions/grid.hpp"
#include "goshawk/conversions/vehicle.hpp"
#include "goshawk/runtime/node.hpp"
#include "goshawk/runtime/private_domain.hpp"
#include "goshawk_msgs.h"
#include "nav_msgs.h"
#include "stage_process.hpp"

namespace goshawk {
namespace {

using goshawk_msgs::msg::NavigatorState;
using goshawk_msgs::msg::StageReport;
using goshawk_msgs::msg::VehicleStatus;
namespace VehicleStatus_Constants = goshawk_msgs::msg::VehicleStatus_Constants;
using runtime::MessageInfo;
using runtime::Qos;

constexpr std::int64_t kSilentAfter_ns = 1'500'000'000;
constexpr double kMost_s = 60.0;  // of the machine's time, for what hangs

// The room of the default world, with something below the vehicle or without.
VoxelGrid room(std::uint64_t version, bool with_table) {
  VoxelGrid grid;
  grid.geometry = {.origin_map = {0.0, -2.0, 0.0}, .resolution_m = 0.2, .size = {30, 44, 20}};
  grid.grown = BitGrid(grid.geometry.size, true);
  for (int y = 8; with_table && y < 13; ++y) grid.grown.set_run(12, 18, y, 2, true);
  grid.version = version;
  return grid;
}

/// Commands the vehicle to hover, or lives as its navigator, until it is silent.
class SilentPilot {
 public:
  enum class Role { tracker, navigator };

  SilentPilot(runtime::Context& context, Role role) : node_(context, "pilot"), role_(role) {
    node_.run_in_lock_step();
    alive_ = node_.advertise<NavigatorState>("navigator_alive", Qos::best_effort());
    commands_ = node_.advertise<goshawk_msgs::msg::AttitudeSetpoint>("command", Qos::best_effort());
    maps_ = node_.advertise<goshawk_msgs::msg::VoxelGrid>("map/voxels", Qos::latched());
    node_.subscribe<nav_msgs::msg::Odometry>(
        "odom", Qos::best_effort(), [this](const nav_msgs::msg::Odometry& m, const MessageInfo&) {
          height_m_ = m.pose().pose().position().z();
        });
    node_.subscribe<StageReport>(
        "stage_report", Qos::latched(100),
        [this](const StageReport& m, const MessageInfo&) { said_ += m.code() + "; "; });
    node_.subscribe<VehicleStatus>("vehicle_status", Qos::best_effort(),
                                   [this](const VehicleStatus& m, const MessageInfo&) { take(m); });
    node_.every(0.02, [this] { show_life(); });
  }

  void serve(const VoxelGrid& grid) {
    goshawk_msgs::msg::VoxelGrid m;
    m.header(conversions::make_header(node_.now_ns()));
    conversions::fill_msg(grid, m);
    EXPECT_TRUE(maps_.publish(m));
  }

  /// Lets simulated time pass until then. @return whether it came to that
  bool wait_for(const std::function<bool()>& then) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(kMost_s);
    while (!then() && std::chrono::steady_clock::now() < end) node_.spin_some(0.1);
    return then();
  }

  double height_m() const { return height_m_; }
  bool heard(const std::string& code) const { return said_.find(code) != std::string::npos; }
  const std::string& said() const { return said_; }
  /// Who flew, in the order of vehicle_status: "autopilot, goshawk, autopilot in failsafe".
  const std::string& control() const { return control_; }

 private:
  void take(const VehicleStatus& m) {
    EXPECT_TRUE(m.armed());
    EXPECT_EQ(m.battery(), -1.0) << "a simulated one is not known";
    EXPECT_EQ(m.resets(), 0U);
    const std::string now =
        std::string(m.control() == VehicleStatus_Constants::CONTROL_GOSHAWK     ? "goshawk"
                    : m.control() == VehicleStatus_Constants::CONTROL_AUTOPILOT ? "autopilot"
                                                                                : "other") +
        (m.failsafe() ? " in failsafe" : "");
    if (control_.ends_with(now)) return;
    control_ += (control_.empty() ? "" : ", ") + now;
  }

  void show_life() {
    if (node_.now_ns() > kSilentAfter_ns) return;
    if (role_ == Role::navigator) {
      EXPECT_TRUE(alive_.publish(NavigatorState{}));
      return;
    }
    goshawk_msgs::msg::AttitudeSetpoint hover;
    conversions::fill_msg(AttitudeSetpoint{.thrust_n = kGravity_m_s2}, hover);
    hover.header(conversions::make_header(node_.now_ns()));
    EXPECT_TRUE(commands_.publish(hover));
  }

  runtime::Node node_;
  Role role_;
  runtime::Publisher<NavigatorState> alive_;
  runtime::Publisher<goshawk_msgs::msg::AttitudeSetpoint> commands_;
  runtime::Publisher<goshawk_msgs::msg::VoxelGrid> maps_;
  double height_m_ = 0.0;
  std::string said_;
  std::string control_;
};

// No map, a map with something below, and one without: it holds, holds, and lands.
void expect_to_land_only_where_the_map_allows(SilentPilot& pilot) {
  ASSERT_TRUE(pilot.wait_for([&] { return pilot.heard("no_map"); })) << pilot.said();
  EXPECT_NEAR(pilot.height_m(), 1.0, 0.02);
  pilot.serve(room(1, true));
  ASSERT_TRUE(pilot.wait_for([&] { return pilot.heard("goal_occupied"); })) << pilot.said();
  EXPECT_NEAR(pilot.height_m(), 1.0, 0.02);
  pilot.serve(room(2, false));
  EXPECT_TRUE(pilot.wait_for([&] { return pilot.height_m() < 0.11; })) << pilot.said();
}

std::unique_ptr<runtime::Context> make_context() {
  static const int domain = runtime::hold_private_domain().value();
  runtime::ContextOptions options;
  options.domain = domain;
  setenv("ROS_DOMAIN_ID", std::to_string(domain).c_str(), 1);
  return runtime::Context::create(options).value();
}

TEST(Landing, ATrackerWithoutItsNavigatorLandsWhereTheMapAllowsIt) {
  const auto context = make_context();
  SilentPilot pilot(*context, SilentPilot::Role::navigator);
  const Stage tracker({"tracker", "--ros-args", "-p", "lock_step:=true", "-p",
                       "navigator_timeout_s:=0.5", "-p", "land_after_s:=0.5"});
  const Stage simulator(
      {"simulator", "--ros-args", "-p", "lock_step_nodes:=tracker,pilot", "-p", "speed:=0"});
  expect_to_land_only_where_the_map_allows(pilot);
  EXPECT_TRUE(pilot.heard("stage_silent")) << pilot.said();
}

TEST(Landing, AnAutopilotWithoutCommandsLandsWhereTheMapAllowsIt) {
  const auto context = make_context();
  SilentPilot pilot(*context, SilentPilot::Role::tracker);
  const Stage simulator({"simulator", "--ros-args", "-p", "lock_step_nodes:=pilot", "-p",
                         "speed:=0", "-p", "failsafe_hold_s:=0.5"});
  expect_to_land_only_where_the_map_allows(pilot);
  EXPECT_TRUE(pilot.heard("tracking_lost")) << pilot.said();
  // The autopilot's first moments, before the first setpoint, may have passed unheard.
  EXPECT_THAT(pilot.control(), testing::EndsWith("goshawk, autopilot in failsafe"));
}

}  // namespace
}  // namespace goshawk
