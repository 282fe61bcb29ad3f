#include <gmock/gmock.h>

#include <limits>

#include "goshawk/conversions/plan.hpp"
#include "goshawk/conversions/vehicle.hpp"
#include "goshawk/stage/map_subscription.hpp"
#include "goshawk/tracker/config.hpp"
#include "goshawk/tracker/tracker.hpp"
#include "support.hpp"

namespace goshawk::conformance_test {
namespace {

namespace msg = goshawk_msgs::msg;
using runtime::Qos;
using testing::Contains;
using testing::IsEmpty;
using testing::StartsWith;

enum class TrackerFault { none, believes_all, only_hovers, not_a_number, talks_on };

/// A tracker as somebody else might write it, with one fault.
class ForeignTracker {
 public:
  ForeignTracker(runtime::Node& node, TrackerFault fault)
      : node_(node),
        fault_(fault),
        tracker_(*tracker::Tracker::create({})),
        reporter_(node, StageRole::tracker, "foreign"),
        map_(node, reporter_, [this](const auto& grid) { tracker_.set_map(grid, node_.now_ns()); }),
        commands_(node.advertise<msg::AttitudeSetpoint>("command", Qos::best_effort())),
        states_(node.advertise<msg::TrackingState>("tracking_state", Qos::best_effort())) {
    node.subscribe<msg::CommittedTrajectory>(
        "committed_trajectory", Qos::latched(),
        [this](const msg::CommittedTrajectory& m, const auto&) { on_commit(m); });
    node.subscribe<nav_msgs::msg::Odometry>(
        "odom", Qos::best_effort(),
        [this](const nav_msgs::msg::Odometry& m, const auto&) { on_odometry(m); });
    if (fault == TrackerFault::talks_on) {
      node.every(0.02, [this] { (void)commands_.publish(command_); });
    }
    reporter_.ready("here");
  }

 private:
  void on_commit(const msg::CommittedTrajectory& m) {
    const std::uint64_t id = m.nominal().request().id();
    auto received = conversions::from_msg(m);
    Status status = received ? success() : received.error();
    if (received) {
      const std::int64_t start_ns = received->start_time_ns();
      status = tracker_.accept(*std::move(received), start_ns, node_.now_ns());
    }
    if (status || fault_ == TrackerFault::believes_all) return reporter_.answered(id, {});
    reporter_.failed(id, status.error());
  }

  void on_odometry(const nav_msgs::msg::Odometry& m) {
    const auto state = conversions::from_msg(m);
    if (!state) return;
    const auto command =
        tracker_.step(*state, conversions::to_ns(m.header().stamp()), node_.now_ns());
    if (!command) return;
    if (fault_ == TrackerFault::only_hovers) {
      conversions::fill_msg({.thrust_n = 9.81}, command_);
    } else {
      conversions::fill_msg(*command, command_);
    }
    if (fault_ == TrackerFault::not_a_number && ++steps_ % 50 == 0) {
      command_.thrust(std::numeric_limits<double>::quiet_NaN());
    }
    command_.header(conversions::make_header(node_.now_ns()));
    (void)commands_.publish(command_);
    const auto status = tracker_.status();
    msg::TrackingState s;
    s.mode(std::uint8_t(status.mode));  // in the same order, as the component asserts
    s.request_id(status.trajectory_id);
    (void)states_.publish(s);
  }

  runtime::Node& node_;
  TrackerFault fault_;
  int steps_ = 0;
  tracker::Tracker tracker_;
  stage::StageReporter reporter_;
  stage::MapSubscription map_;
  runtime::Publisher<msg::AttitudeSetpoint> commands_;
  runtime::Publisher<msg::TrackingState> states_;
  msg::AttitudeSetpoint command_;
};

TEST(ConformTracker, ForeignOnesPassOrFailAtTheRightItems) {
  const auto reports = examine_all<ForeignTracker, TrackerFault>(
      {.stage = "tracker"},
      {TrackerFault::none, TrackerFault::believes_all, TrackerFault::only_hovers,
       TrackerFault::not_a_number, TrackerFault::talks_on});
  EXPECT_THAT(failed(reports[0]), IsEmpty());
  EXPECT_EQ(reports[0].implementation, "foreign");
  EXPECT_GE(reports[0].items.size(), 20U);
  EXPECT_GT(reports[0].latency_p50_s, 0.0);

  int refusals = 0;
  for (const auto& item : reports[1].items) {
    const bool about_bad = item.name.starts_with("refuses");
    refusals += int(about_bad);
    EXPECT_EQ(item.passed, !about_bad) << item.name << ": " << item.detail;
  }
  EXPECT_GE(refusals, 10);

  EXPECT_THAT(failed(reports[2]), Contains("flies a trajectory: stays on it"));
  EXPECT_THAT(failed(reports[2]), Contains("flies a trajectory: arrives and holds"));
  EXPECT_THAT(failed(reports[2]), testing::Not(Contains(StartsWith("commands"))));
  EXPECT_THAT(failed(reports[3]), Contains(StartsWith("commands are finite")));
  EXPECT_THAT(failed(reports[4]), Contains("stops commanding without odometry"));
}

}  // namespace
}  // namespace goshawk::conformance_test
