#include "flight/flight_recorder.hpp"

#include <chrono>
#include <utility>

#include "goshawk/conversions/status.hpp"
#include "goshawk/conversions/vehicle.hpp"

namespace goshawk::cli {
namespace {

// Samples that may wait to be read: in lock step they come much faster than real time.
constexpr int kWholeTrack = 10'000;

using namespace goshawk::runtime;
namespace msg = goshawk_msgs::msg;
namespace mode = goshawk_msgs::msg::TrackingState_Constants;

constexpr double kListenStep_s = 0.05;

}  // namespace

FlightRecorder::FlightRecorder(Node& node, FlightEvents events)
    : node_(node),
      events_(std::move(events)),
      goals_(node.advertise<geometry_msgs::msg::PoseStamped>("goal_pose", Qos::reliable_last())) {
  node.subscribe<msg::StageReport>(
      "stage_report", Qos::latched(100), [this](const msg::StageReport& m, const MessageInfo&) {
        events_.report(node_.monotonic_ns(), m);
        const auto role = conversions::stage_role_of(m.stage());
        if (m.request_id() != 0) {
          requests_[m.request_id()].reports[role] = m;
        } else if (m.code() == "ok") {
          ready_.insert(role);
          ready_nodes_.insert(m.node().substr(m.node().rfind('/') + 1));
        }
      });
  node.subscribe<msg::NavigatorState>("navigator_state", Qos::latched(20),
                                      [this](const msg::NavigatorState& m, const MessageInfo&) {
                                        events_.navigator(node_.monotonic_ns(), m);
                                        navigator_ = m;
                                      });
  node.subscribe<msg::Path>(
      "path", Qos::reliable_last(),
      [this](const msg::Path& m, const MessageInfo&) { requests_[m.request().id()].path = m; });
  node.subscribe<msg::Corridor>("corridor", Qos::reliable_last(),
                                [this](const msg::Corridor& m, const MessageInfo&) {
                                  requests_[m.request().id()].corridor = m;
                                });
  node.subscribe<msg::CommittedTrajectory>(
      "committed_trajectory", Qos::latched(),
      [this](const msg::CommittedTrajectory& m, const MessageInfo&) { on_commit(m); });
  node.subscribe<nav_msgs::msg::Odometry>(
      "odom", Qos::best_effort(kWholeTrack),
      [this](const nav_msgs::msg::Odometry& m, const MessageInfo&) {
        if (!knows_truth_) on_odometry(m);
      });
  // A simulator with noisy sensors tells the truth beside them: that is what was flown.
  node.subscribe<nav_msgs::msg::Odometry>(
      "odom_true", Qos::best_effort(kWholeTrack),
      [this](const nav_msgs::msg::Odometry& m, const MessageInfo&) {
        if (!std::exchange(knows_truth_, true)) {
          flown_.clear();
          times_ = {};
        }
        on_odometry(m);
      });
  node.subscribe<msg::TrackingState>("tracking_state", Qos::best_effort(100),
                                     [this](const msg::TrackingState& m, const MessageInfo&) {
                                       events_.tracker(node_.monotonic_ns(), m);
                                       if (m.mode() != mode::MODE_FOLLOW) return;
                                       errors_.push_back({conversions::to_ns(m.header().stamp()),
                                                          m.request_id(), m.position_error()});
                                     });
}

void FlightRecorder::on_odometry(const nav_msgs::msg::Odometry& m) {
  const auto state = conversions::from_msg(m);
  if (!state) return;
  if (flown_.empty()) tell("track", Json::object());  // its times count from here
  const std::int64_t stamp_ns = conversions::to_ns(m.header().stamp());
  flown_.push_back({times_.time_ns(stamp_ns, node_.monotonic_ns()), *state});
}

void FlightRecorder::on_commit(const msg::CommittedTrajectory& m) {
  auto committed = conversions::from_msg(m);
  if (committed) committed_.push_back(*std::move(committed));  // else the tracker says why not
}

void FlightRecorder::send_goal(const Vec3& goal_map) {
  geometry_msgs::msg::PoseStamped goal;
  goal.header(conversions::make_header(node_.now_ns()));
  goal.pose().position(conversions::to_point(goal_map));
  goal.pose().orientation().w(1.0);
  // The answer to an earlier goal is not the answer to this one.
  navigator_.reset();
  if (auto status = goals_.publish(goal); !status) throw StartupFault(status.error());
}

bool FlightRecorder::listen(double timeout_s, const std::function<bool()>& done) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(timeout_s);
  while (!done()) {
    if (std::chrono::steady_clock::now() > end) return false;
    node_.spin_some(kListenStep_s);
  }
  return true;
}

}  // namespace goshawk::cli
