#pragma once

#include <optional>
#include <string_view>
#include <utility>

#include "goshawk/mission/config.hpp"
#include "goshawk/mission/mission.hpp"

namespace goshawk::mission {

/// In the order of the constants STATE_* of goshawk_msgs/msg/MissionState.
enum class State { none, flying, waiting, paused, done, failed, cancelled };
std::string_view to_string(State state);

/// What the navigator says of its newest goal.
struct NavigatorNews {
  enum class Does { idle, pursues, arrived, failed, held };
  Does does = Does::idle;
  Vec3 goal_map = Vec3::Zero();
  Error reason{ErrorCode::ok, ""};  // why it failed
  std::int64_t stamp_ns = 0;        // [ns] when it said so, by its own clock
};

/// A goal for the navigator.
struct Goal {
  Vec3 position_map = Vec3::Zero();
  double yaw_rad = 0.0;
  double v_max_m_s = 0.0;  // 0: the navigator's
};

/// How a mission stands.
struct Progress {
  State state = State::none;
  std::size_t waypoint = 0;  // that is flown to, from 1; 0 before any mission
  Vec3 position_map = Vec3::Zero();
  double left_m = 0.0;       // to the last waypoint, along straight lines
  double hold_left_s = 0.0;  // waiting: until the next leg
  Error reason{ErrorCode::ok, ""};
};

/// What an executor needs of the one that ran before it.
struct Memory {
  Mission mission = {};
  State state = State::none;
  std::size_t next = 0;            // waypoint, from 0
  bool taken = false;              // the navigator has the goal
  std::int64_t sent_after_ns = 0;  // [ns] the newest stamp of the navigator when it was sent
  Error reason{ErrorCode::ok, ""};
};

/// Flies a mission: sends the navigator one goal after another and hears how each ends. Knows no
/// middleware and no clock: every event brings the time, and leaves a goal to take.
///
/// A waypoint is reached when the navigator has arrived there or, if it is passed, as soon as the
/// vehicle is within its radius: the next goal is then sent in flight. A goal that the navigator
/// does not take is sent again. If the navigator holds, or pursues a goal of somebody else's, the
/// mission is paused and leaves the vehicle alone; a waypoint that cannot be reached ends it. Both
/// can be resumed. What the navigator does by itself counts as well: if it pursues the waypoint
/// after all, so does the mission.
class Executor {
 public:
  explicit Executor(const Config& config) : config_(config) {}
  void reconfigure(const Config& config) { config_ = config; }

  /// Goes on where another executor ended, before any other event. A hold begins anew.
  void restore(Memory memory, std::int64_t now_ns);
  Memory memory() const;

  /// Begins a mission, in place of the one that is under way.
  /// @return invalid_input: @see check()
  Status start(Mission mission, std::int64_t now_ns);
  /// Sends the waypoint's goal again. @return invalid_input if nothing is paused or has failed
  Status resume(std::int64_t now_ns);
  /// Ends the mission, also one that is paused or has failed; the goal that the navigator has stays
  /// its goal. @return invalid_input if there is none, or it is over
  Status cancel();

  void on_navigator(const NavigatorNews& news, std::int64_t now_ns);
  void on_vehicle(const Vec3& position_map, double yaw_rad, std::int64_t now_ns);
  /// Regularly: repeats, ends of holds.
  void tick(std::int64_t now_ns);

  /// @return what to send, once
  std::optional<Goal> take_goal() { return std::exchange(goal_, {}); }
  /// @return whether state, waypoint or reason have changed since the last call
  bool take_change() { return std::exchange(changed_, false); }
  Progress progress(std::int64_t now_ns) const;
  const Mission& mission() const { return mission_; }

 private:
  const Waypoint& waypoint() const { return mission_.waypoints[next_]; }
  bool is_under_way() const;
  void enter(State state, Error reason = {ErrorCode::ok, ""});
  void fly(std::int64_t now_ns);
  void send(std::int64_t now_ns);
  void reached(std::int64_t now_ns);
  void go_on(std::int64_t now_ns);
  void repeat(std::int64_t now_ns);
  void on_own_goal(const NavigatorNews& news, std::int64_t now_ns);
  std::string place() const;

  struct Vehicle {
    Vec3 position_map;
    double yaw_rad;
  };

  Config config_;
  Mission mission_;
  State state_ = State::none;
  std::size_t next_ = 0;
  Error reason_{ErrorCode::ok, ""};
  bool taken_ = false;
  std::int64_t newest_ns_ = 0;                 // stamp of the navigator's newest news
  std::int64_t sent_after_ns_ = 0;             // newest_ns_ when the goal was sent
  std::optional<std::int64_t> asked_ns_ = {};  // when the goal was sent for the first time
  std::int64_t sent_ns_ = 0;                   // and the last time
  std::optional<std::int64_t> wait_until_ns_ = {};
  std::optional<Vehicle> vehicle_ = {};
  std::optional<Goal> goal_ = {};
  bool changed_ = false;
};

}  // namespace goshawk::mission
