#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "goshawk/core/committed_trajectory.hpp"
#include "goshawk/core/plan_request.hpp"
#include "goshawk/core/stage_role.hpp"
#include "goshawk/core/vehicle.hpp"
#include "goshawk/navigator/config.hpp"

namespace goshawk::navigator {

enum class State { idle, planning, flying, arrived, failed };
std::string_view to_string(State state);

/// What the navigator tells everyone.
struct StateOrder {
  State state = State::idle;
  std::uint64_t id = 0;        // of the newest request, 0 before any
  std::uint64_t flown_id = 0;  // of the trajectory that is flown or held at its end; 0: none
  Vec3 goal_map = Vec3::Zero();
  Error reason{ErrorCode::ok, ""};
};
/// What the navigator wants sent; the component turns it into messages.
using Order = std::variant<PlanRequest, CommittedTrajectory, StateOrder>;

/// From goals to committed trajectories. Knows no middleware and no clock: every event brings the
/// time, and leaves orders to take.
///
/// At rest it plans from where the vehicle hovers. In flight it plans from the state that the
/// present trajectory will have replan_lead_s from now, and commits only what comes before that
/// moment; the present trajectory ends at rest in any case, so a plan that fails or comes late
/// never endangers the vehicle. A request without an answer is asked again, then given up with the
/// name of the stage that was silent.
class Navigator {
 public:
  /// @param first_id number of the first request, above 0: unique over restarts
  Navigator(const Config& config, std::uint64_t first_id);

  /// What is open or flown goes on; limits and leads hold from the next request on.
  /// @return invalid_parameter: out of range, or what cannot change at run time; then as before
  Status reconfigure(const Config& config);

  /// @param yaw_rad heading at the goal, map x to y @return invalid_input if not finite
  Status on_goal(const Vec3& goal_map, double yaw_rad, std::int64_t now_ns);
  void on_odometry(const RigidBodyState& vehicle, std::int64_t now_ns);
  /// An answer to a request; others than the open one's are ignored.
  /// @param candidate without start time and yaw, which are set here
  void on_trajectory(Commitment candidate, std::int64_t now_ns);
  /// A stage has answered a request: with ok, or with why not.
  void on_report(std::uint64_t id, StageRole stage, const Error& outcome, std::int64_t now_ns);
  /// Regularly, some 50 times a second: timeouts and arrival.
  void tick(std::int64_t now_ns);

  std::vector<Order> take_orders() { return std::exchange(orders_, {}); }
  State state() const { return state_; }

 private:
  struct Goal {
    Vec3 position_map = Vec3::Zero();
    double yaw_rad = 0.0;
  };
  struct Open {  // the request that waits for its answer
    std::uint64_t id = 0;
    std::int64_t asked_ns = 0;
    std::optional<std::int64_t> switch_ns;    // moving start: when the new trajectory must begin
    StageRole last_stage = StageRole::other;  // that answered ok
  };
  struct Flight {
    CommittedTrajectory committed;
    std::int64_t end_ns = 0;
    Goal goal;
  };
  struct Start {  // what a plan begins with
    FlatState state;
    double yaw_rad = 0.0;
    double yaw_rate_rad_s = 0.0;
    std::optional<std::int64_t> time_ns = {};  // none: at rest, whenever
  };

  void plan(std::int64_t now_ns);
  Start start_on(const Flight& flight, std::int64_t time_ns) const;
  Start start_at_rest() const;
  void ask(const Start& start, std::int64_t now_ns);
  void drop_open();
  void plan_again(const Error& reason, std::int64_t now_ns);
  void give_up(const Error& reason);
  void tracker_failed(const Error& reason, std::int64_t now_ns);
  void check_arrival(std::int64_t now_ns);
  void check_silence(std::int64_t now_ns);
  bool at_rest() const;
  bool odometry_is_fresh(std::int64_t now_ns) const;
  void enter(State state, Error reason = {ErrorCode::ok, ""});

  Config config_;
  std::uint64_t next_id_;
  std::uint64_t newest_id_ = 0;  // of the newest request
  State state_ = State::idle;
  Goal goal_;
  bool goal_open_ = false;  // a goal that no committed trajectory leads to yet
  int attempts_ = 0;
  std::int64_t retry_ns_ = 0;       // not before this
  std::int64_t wait_begin_ns_ = 0;  // since when a plan waits for the vehicle to come to rest
  double lead_s_;
  std::optional<Open> open_;
  std::uint64_t dropped_id_ = 0;  // a request that nobody needs an answer to any more
  std::optional<Flight> flight_;
  RigidBodyState vehicle_;
  std::optional<std::int64_t> odometry_ns_;
  std::vector<Order> orders_;
};

}  // namespace goshawk::navigator
