#pragma once

#include <functional>
#include <map>
#include <optional>
#include <set>

#include "flight/flight_events.hpp"
#include "flight/track_times.hpp"
#include "goshawk/conversions/plan.hpp"
#include "goshawk/core/stage_role.hpp"
#include "goshawk/core/vehicle.hpp"
#include "goshawk/runtime/node.hpp"
#include "goshawk_msgs.h"
#include "nav_msgs.h"

namespace goshawk::cli {

struct FlownState {
  std::int64_t stamp_ns = 0;  // by TrackTimes
  RigidBodyState state;
};

struct TrackedError {
  std::int64_t stamp_ns = 0;
  std::uint64_t request_id = 0;
  double position_error_m = 0.0;
};

/// What the stages reported about one request.
struct RequestRecord {
  goshawk_msgs::msg::Path path;
  goshawk_msgs::msg::Corridor corridor;
  std::map<StageRole, goshawk_msgs::msg::StageReport> reports;  // newest of each stage
};

/// Listens to a whole flight, sends goals, and keeps what came.
class FlightRecorder {
 public:
  FlightRecorder(runtime::Node& node, FlightEvents events);

  void send_goal(const Vec3& goal_map);

  /// Listens until done() or for timeout_s. @return whether done() came true
  bool listen(double timeout_s, const std::function<bool()>& done);

  bool is_ready(StageRole stage) const { return ready_.contains(stage); }
  /// @param node without its namespace
  bool is_ready(const std::string& node) const { return ready_nodes_.contains(node); }
  /// The navigator's answer to the newest goal, or nothing before it.
  const std::optional<goshawk_msgs::msg::NavigatorState>& navigator() const { return navigator_; }
  const std::vector<FlownState>& flown() const { return flown_; }
  const std::vector<TrackedError>& errors() const { return errors_; }
  const std::vector<CommittedTrajectory>& committed() const { return committed_; }
  const std::map<std::uint64_t, RequestRecord>& requests() const { return requests_; }
  /// A line of the flight's events.
  void tell(const std::string& event, Json what) {
    events_.add(node_.monotonic_ns(), event, std::move(what));
  }
  std::int64_t now_ns() const { return node_.now_ns(); }
  int goal_readers() const { return goals_.matched(); }

 private:
  void on_commit(const goshawk_msgs::msg::CommittedTrajectory& m);
  void on_odometry(const nav_msgs::msg::Odometry& m);

  runtime::Node& node_;
  FlightEvents events_;
  runtime::Publisher<geometry_msgs::msg::PoseStamped> goals_;
  std::set<StageRole> ready_;
  std::set<std::string> ready_nodes_;
  std::optional<goshawk_msgs::msg::NavigatorState> navigator_;
  std::vector<FlownState> flown_;
  bool knows_truth_ = false;
  TrackTimes times_;
  std::vector<TrackedError> errors_;
  std::vector<CommittedTrajectory> committed_;
  std::map<std::uint64_t, RequestRecord> requests_;
};

}  // namespace goshawk::cli
