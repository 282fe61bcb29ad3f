#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "goshawk/core/free_space.hpp"
#include "goshawk/core/plan_request.hpp"
#include "goshawk/core/stage_role.hpp"
#include "goshawk/core/vehicle.hpp"
#include "goshawk/navigator/answer_check.hpp"
#include "goshawk/navigator/config.hpp"
#include "goshawk/navigator/remedy.hpp"
#include "goshawk/navigator/schedule.hpp"

namespace goshawk::navigator {

enum class State { idle, planning, flying, arrived, failed, held };
std::string_view to_string(State state);

struct Goal {
  Vec3 position_map = Vec3::Zero();
  double yaw_rad = 0.0;
  double v_max_m_s = 0.0;  // on the way there, if lower than the parameter; 0: the parameter
};

/// What the navigator tells everyone.
struct StateOrder {
  State state = State::idle;
  std::uint64_t id = 0;        // of the newest request, 0 before any
  std::uint64_t flown_id = 0;  // of the trajectory that is flown or held at its end; 0: none
  Vec3 goal_map = Vec3::Zero();
  Error reason{ErrorCode::ok, ""};
};
/// A trajectory to fly.
struct Commit {
  CommittedTrajectory trajectory;
  std::uint64_t answer = 0;     // number of the answer that it is; 0: the navigator's own
  std::uint64_t continues = 0;  // the commit whose nominal part it has, with a later stop; 0: none
};
/// An answer that is not flown. The request goes on.
struct Complaint {
  std::uint64_t id = 0;  // of the request
  Error reason;
};
/// What the navigator wants sent; the component turns it into messages.
using Order = std::variant<PlanRequest, Commit, StateOrder, Complaint>;

/// How far down the vehicle may go.
struct Descent {
  enum class Below { obstacle, unknown, map_floor };
  Vec3 end_map = Vec3::Zero();
  Below below = Below::obstacle;  // why not farther
};

/// What a navigator needs of the one that ran before it.
struct Memory {
  State state = State::idle;
  std::uint64_t newest_id = 0;
  Goal goal;
  bool open = false;  // no committed trajectory leads to the goal yet
  Error reason = {ErrorCode::ok, ""};
  std::vector<Leg> legs = {};  // by start
};

/// From goals to committed trajectories. Knows no middleware and no clock: every event brings the
/// time, and leaves orders to take.
///
/// At rest it plans from where the vehicle hovers. In flight it plans from the state that the
/// vehicle will have replan_lead_s from now, and commits only what comes before that moment. If
/// nothing can be planned from there, it asks for a later start, then commits a way to rest along
/// the path that is flown and plans from there: the newest goal is pursued until a stage says that
/// no start can help, and what is flown always ends at rest. Answers are checked against the
/// request and the map; a bad one is refused, and a good one is waited for. A request without an
/// answer is asked again, then given up with the name of the stage that was silent.
///
/// In a map that leaves unknown space free for planning, what is committed gets a stop part that
/// begins as late as known free space allows. While one is flown, each map moves the stop as far
/// back as what was seen by then allows, and better plans are asked for: one replaces what is flown
/// only if it is better by a margin. If nothing newer comes, the stop part is flown, and the goal
/// is planned for again from rest.
class Navigator {
 public:
  /// @param first_id number of the first request, above 0: unique over restarts
  Navigator(const Config& config, std::uint64_t first_id);

  /// What is open or flown goes on; limits and leads hold from the next request on.
  /// @return invalid_parameter: out of range, or what cannot change at run time; then as before
  Status reconfigure(const Config& config);

  /// Goes on where another navigator ended, before any other event: what is not yet flown to its
  /// end is committed again, for a tracker that has not had it.
  void resume(Memory memory, std::int64_t now_ns);
  Memory memory() const;

  /// @param yaw_rad heading at the goal, map x to y @return invalid_input if not finite
  Status on_goal(const Vec3& goal_map, double yaw_rad, std::int64_t now_ns) {
    return on_goal(Goal{goal_map, yaw_rad}, now_ns);
  }
  /// @return invalid_input if not finite, or the speed limit is below 0
  Status on_goal(const Goal& goal, std::int64_t now_ns);
  // What an operator commands (operator.cpp).
  /// Gives the goal up and brakes on what is flown, as gently as its limits allow. If no way to
  /// brake is found, it is tried again; what is flown ends at rest in any case. Without a goal
  /// nothing changes.
  void hold(std::int64_t now_ns);
  /// Pursues the held goal again. @return invalid_input if nothing is held
  Status resume_held(std::int64_t now_ns);
  /// Brakes, and makes the lowest place below a goal that the map shows free all the way down. A
  /// refused landing changes nothing.
  /// @return the place; tracking_lost: no odometry; no_map; start_occupied, start_unknown or
  ///   start_outside: the map does not show the vehicle's own place free
  Result<Descent> land(std::int64_t now_ns);
  /// Makes a place straight above a goal.
  /// @return the place; invalid_input: not a height above 0; tracking_lost: no odometry
  Result<Vec3> take_off(double height_m, std::int64_t now_ns);

  void on_odometry(const RigidBodyState& vehicle, std::int64_t now_ns);
  /// What is flown is checked against it at once. @pre grid->check() ok
  void on_map(std::shared_ptr<const VoxelGrid> grid, std::int64_t now_ns);
  /// An answer to a request; others than the open one's are ignored.
  /// @param candidate without start time and yaw, which are set here
  /// @param number of this answer, above 0: the commit that it becomes names it
  void on_trajectory(Commitment candidate, std::uint64_t number, std::int64_t now_ns);
  /// An answer to a request that is no certified trajectory: counted. The caller has said so.
  void on_bad_answer(std::uint64_t id, const Error& why);
  /// A stage has answered a request: with ok, or with why not.
  void on_report(std::uint64_t id, StageRole stage, const Error& outcome, std::int64_t now_ns,
                 const Shortfall& shortfall = {});
  /// What the tracker says that it follows or holds the end of; 0: nothing.
  /// @param follows it is on it, as planned
  void on_tracking(std::uint64_t id, bool follows, std::int64_t now_ns);
  /// Regularly, some 50 times a second: timeouts and arrival.
  void tick(std::int64_t now_ns);

  std::vector<Order> take_orders() { return std::exchange(orders_, {}); }
  State state() const { return state_; }

 private:
  struct Failure {
    Error reason;
    std::int64_t act_ns;  // until then a good answer still counts
  };
  struct Open {  // the request that waits for its answer
    PlanRequest request;
    std::int64_t asked_ns = 0;
    StageRole last_stage = StageRole::other;  // that answered ok
    Shortfall shortfall = {};
    int refused = 0;  // answers
    std::string why_refused = {};
    std::optional<Failure> failure = {};
    bool improves = false;  // what is flown leads to the goal already

    bool from_motion() const { return request.start.velocity.norm() > 1e-3; }
    std::optional<std::int64_t> too_late_ns() const;
  };
  struct Pending {  // an answer that waits for its map
    Commitment candidate;
    std::uint64_t number;
    std::int64_t until_ns;
  };
  struct MapRetry {  // a goal that was given up, but another map may help
    std::int64_t until_ns;
    std::int64_t changed_after_ns;
  };
  struct Pursuit {  // of the newest goal
    Goal goal;
    bool open = false;         // no committed trajectory leads to it yet
    int failures = 0;          // that only time can mend
    std::int64_t lost_ns = 0;  // when the tracker last said that it does not fly one
    int starts = 0;            // that did not do
    double lead_s = 0.0;
    std::int64_t not_before_ns = 0;  // the next start
    std::int64_t retry_ns = 0;
    std::int64_t wait_begin_ns = 0;    // since when a plan waits for the vehicle to come to rest
    std::int64_t settle_begin_ns = 0;  // since when there is a tracker that lets it
    std::optional<std::int64_t> revoked_ns = {};  // since when another goal is flown to
    std::optional<MapRetry> map_retry = {};       // it failed because of the map
  };
  static constexpr double kTracking_s = 0.5;  // what the tracker said is believed for so long
  struct Tracked {
    std::uint64_t id;
    std::int64_t ns;
  };
  struct Left {  // what the tracker said that it does not fly
    Leg leg;
    std::int64_t since_ns;
    bool answers;  // it leads to the newest goal
  };
  struct Start {  // what a plan begins with
    FlatState state;
    double yaw_rad = 0.0;
    double yaw_rate_rad_s = 0.0;
    std::optional<std::int64_t> time_ns = {};  // none: at rest, whenever
  };

  // operator.cpp
  void hold_on(std::int64_t now_ns);
  Vec3 rest_place(std::int64_t now_ns) const;
  Descent lowest_below(const Vec3& from_map, Index3 lowest) const;
  // planning.cpp
  void plan(std::int64_t now_ns);
  std::int64_t free_for_planning_from(std::int64_t time_ns) const;
  bool tracker_is_silent(std::int64_t now_ns) const;
  bool waits_for_tracker(std::int64_t now_ns);
  Error why_it_does_not_rest(std::int64_t now_ns) const;
  Start start_in_flight(std::int64_t now_ns) const;
  Start start_at(std::int64_t time_ns) const;
  Start start_at_rest(std::int64_t now_ns) const;
  Limits limits_from(const Start& start) const;
  void ask(const Start& start, std::int64_t now_ns);
  void open(const Start& start, std::uint64_t id, std::int64_t now_ns);
  void drop_open();
  void check_open(std::int64_t now_ns);
  void act_on(const Error& reason, std::int64_t now_ns);
  void wait_for_other_map(std::int64_t asked_ns, std::int64_t now_ns);
  void try_other_start(const Error& reason, std::int64_t now_ns);
  void plan_again(const Error& reason, double delay_s, std::int64_t now_ns);
  void reopen(std::int64_t not_before_ns, std::int64_t now_ns);
  void give_up(const Error& reason, std::int64_t now_ns);
  std::optional<CommittedTrajectory> way_to_rest(std::int64_t now_ns);
  void brake_by(CommittedTrajectory way);
  bool brake(std::int64_t now_ns);
  bool brakes() const { return schedule_.last() != nullptr && schedule_.last()->brakes; }
  void check_revoked(std::int64_t now_ns);
  // from_rest.cpp
  Commitment from_rest(CertifiedTrajectory way, std::int64_t now_ns);
  void commit_own(CommittedTrajectory committed);
  bool leave_blocked_place(std::int64_t now_ns);
  bool look_along(const Trajectory& way, std::int64_t now_ns);
  // answers.cpp
  void take_answer(Commitment candidate, std::uint64_t number, std::int64_t now_ns);
  void refuse_answer(const Error& why);
  bool wait_for_map(const Commitment& candidate, std::uint64_t number, std::int64_t now_ns);
  void commit(CommittedTrajectory committed, double beyond_m, std::uint64_t number,
              std::int64_t now_ns);
  void check_pending(std::int64_t now_ns);
  void on_tracker_report(std::uint64_t id, const Error& outcome, std::int64_t now_ns);
  void check_map_retry(std::int64_t now_ns);
  void check_legs(std::int64_t now_ns);
  void blocked(const Error& why, std::int64_t now_ns);
  void pursue_again(const Error& why, std::int64_t now_ns);
  void take_up_again(std::uint64_t followed_id, std::int64_t now_ns);
  // replanning.cpp
  bool approaches() const;
  Status add_stop(Commitment& candidate, bool from_rest) const;
  void move_stop(std::int64_t now_ns);
  bool stop_sooner(std::int64_t now_ns);
  void commit_stop(std::optional<StopPart> stop);
  void improve(std::int64_t now_ns);
  void improve_by_new_map(std::int64_t now_ns);
  double improvement_lead_s() const;
  void take_improvement(Commitment candidate, std::uint64_t number, std::int64_t now_ns);
  bool is_better(const Leg& other, std::int64_t now_ns) const;
  void rest_before_goal(std::int64_t now_ns);
  // navigator.cpp
  double left_m(const Leg& leg) const;
  void check_arrival(std::int64_t now_ns);
  bool at_rest() const;
  bool has_given_up() const { return state_ == State::failed || state_ == State::held; }
  const VoxelGrid* map() const { return space_.grid(); }
  bool odometry_is_fresh(std::int64_t now_ns) const;
  std::uint64_t flown_id(std::int64_t now_ns) const;
  void say_what_is_flown(std::int64_t now_ns);
  void enter(State state, std::int64_t now_ns, Error reason = {ErrorCode::ok, ""});

  Config config_;
  std::uint64_t next_id_;
  std::uint64_t newest_id_ = 0;  // of the newest request
  State state_ = State::idle;
  Pursuit pursuit_;
  std::optional<Open> open_;
  std::optional<Pending> pending_;
  std::uint64_t dropped_id_ = 0;  // a request that nobody needs an answer to any more
  Schedule schedule_;
  FreeSpace space_;
  std::int64_t brake_again_ns_ = 0;  // of a hold
  std::int64_t improve_ns_ = 0;      // then the next improvement is asked for
  bool superseded_by_map_ = false;   // the improvement before the one that is open
  double latency_s_ = 0.0;           // from request to answer, of late
  std::optional<std::int64_t> map_changed_ns_;
  std::optional<Tracked> tracked_;
  std::optional<Left> left_;
  std::uint64_t lost_id_ = 0;  // the tracker has left it
  std::uint64_t said_flown_id_ = 0;
  Error said_reason_{ErrorCode::ok, ""};
  RigidBodyState vehicle_;
  std::optional<std::int64_t> odometry_ns_;
  std::vector<Order> orders_;
};

}  // namespace goshawk::navigator
