#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "goshawk/core/fallback_stop.hpp"
#include "goshawk/core/landing.hpp"
#include "goshawk/tracker/map_guard.hpp"
#include "goshawk/tracker/position_controller.hpp"
#include "goshawk/tracker/reference.hpp"
#include "goshawk/tracker/stop.hpp"

namespace goshawk::tracker {

enum class Mode {
  idle,    // no odometry yet
  hold,    // at a point: where the first odometry was, or where a trajectory or a stop ended
  follow,  // on a trajectory
  brake,   // slowing down: along the trajectory's path, or from where the vehicle was lost
  land,    // straight down from where it held, the navigator being lost; and on the ground
};
std::string_view to_string(Mode mode);

/// Who flies the vehicle, by its own word.
enum class Control { goshawk, autopilot, pilot, nobody };  // goshawk: the setpoints are flown

struct TrackingStatus {
  Mode mode = Mode::idle;
  Error fault{ErrorCode::ok, ""};        // ok, or why the trajectory is not followed as planned
  std::uint64_t trajectory_id = 0;       // the one followed or come to rest on; 0: none yet
  std::uint64_t lost_trajectory_id = 0;  // the newest that will not be flown to its end
  double progress_s = 0.0;               // along it
  double duration_s = 0.0;
  int queued = 0;            // trajectories accepted whose time has not come
  FlatState reference;       // where the vehicle should be
  double error_m = 0.0;      // latest distance from there
  double rms_error_m = 0.0;  // since the trajectory was switched to, rest after it included
  double max_error_m = 0.0;
  Vec3 disturbance_map = Vec3::Zero();  // [m/s^2] learnt
};

/// Flies certified trajectories; hovers before and after. Time is an argument everywhere, on one
/// monotonic clock [ns]; the same calls give the same bits; step() allocates nothing while nothing
/// is lost.
///
/// What is lost is not flown on: a vehicle farther from its reference than the allowance, odometry
/// that stops or jumps, a process that did not run. The reference then starts again from where the
/// vehicle is, and comes to rest there (plan_stop); it never chases what went on without it. What
/// the map shows blocked is not flown either: each trajectory is checked before it is accepted, and
/// what is left of it with every map; the vehicle brakes before what is in the way. The position
/// error that is corrected is bounded (max_position_error_m), so that no fault makes the vehicle
/// faster than the trajectory, plus what that error is worth.
///
///     auto tracker = Tracker::create(config);
///     tracker->set_map(grid, now_ns);                                // whenever one comes
///     auto command = tracker->step(odometry, stamp_ns, now_ns);      // at odometry's rate
///     if (command) publish(*command); else report(command.error());  // silence is what makes
///                                                                    // the vehicle brake
///     Status answer = tracker->accept(committed, now_ns);            // whenever one comes
///     tracker->heard_navigator(now_ns);                              // at each sign of its life
///     tracker->watch(now_ns);                                        // regularly, odometry or not
///     if (tracker->make_fallback(stop, now_ns)) publish(stop);       // 20 times a second
class Tracker {
 public:
  /// @return invalid_parameter with every fault of the configuration
  static Result<Tracker> create(const Config& config);

  /// Takes on a trajectory. With its start still to come it waits in a queue, and the present
  /// reference is followed until exactly then; those queued for the same time or later are
  /// replaced. With its start past it is followed at once, from where it should be by now.
  /// A refused trajectory changes nothing. Sentences name the trajectory and the reason.
  /// @return all of admit(); tracking_lost: the vehicle says that it does not fly the setpoints;
  ///         not_at_start: no odometry yet, or it does not pass the vehicle, nor
  ///         the present reference, within the start tolerances; deadline_exceeded: it has ended;
  ///         no_map: there is none, or not yet the version that it names; trajectory_blocked: the
  ///         map has something in its way
  /// @param start_ns when it begins, on this clock
  Status accept(CommittedTrajectory committed, std::int64_t start_ns, std::int64_t now_ns);
  Status accept(CommittedTrajectory committed, std::int64_t now_ns) {
    const std::int64_t start_ns = committed.start_time_ns();
    return accept(std::move(committed), start_ns, now_ns);
  }

  /// Stop on the path and hold there; what is queued is dropped. On a held point: nothing new.
  void brake(std::int64_t now_ns);

  /// @param stamp_ns [ns] when `state` was true @param now_ns [ns]
  /// @return the command; or invalid_input (not finite, no unit quaternion, farther or faster
  ///         than any vehicle, older than the last, from the future), tracking_lost (older than
  ///         odometry_timeout_s). A stamp that falls back by more than odometry_timeout_s is a
  ///         simulation that began anew: everything is forgotten, and the vehicle holds where it
  ///         is. A vehicle that is faster than 0.4 m/s when it is first heard flies what another
  ///         tracker gave it: it is left alone (tracking_lost) until it is slower, but for 5 s at
  ///         the most.
  Result<AttitudeSetpoint> step(const RigidBodyState& state, std::int64_t stamp_ns,
                                std::int64_t now_ns);
  Result<AttitudeSetpoint> step(const RigidBodyState& state, std::int64_t now_ns) {
    return step(state, now_ns, now_ns);
  }

  /// The newest map: what is left of what is flown and of what waits is checked against it. The
  /// stop part of what is blocked begins sooner, if it has one and a stop fits: then nothing is
  /// lost. Else it is braked for (trajectory_blocked): along its path, else on another way that is
  /// free, else on the one that stays free for the longest time. A landing whose way down it shows
  /// blocked stops and holds where it is.
  /// @pre grid->check() ok
  void set_map(std::shared_ptr<const VoxelGrid> grid, std::int64_t now_ns);
  /// Version of the newest map, if one has come.
  std::optional<std::uint64_t> map_version() const;

  /// The second opinion finds a trajectory touching: it is dropped, or braked for as hard as may
  /// be (collision). Others: nothing.
  void veto(std::uint64_t id, const std::string& why, std::int64_t now_ns);

  /// What may change in flight: nothing that the force on the vehicle, what is admitted, or when
  /// it brakes depend on. A new yaw is turned to at the old rate.
  /// @return invalid_parameter: as create(), or what cannot change at run time; then as before
  Status reconfigure(const Config& config);

  /// The navigator lives. Only one that was heard can be missed; a landing ends when it is back.
  void heard_navigator(std::int64_t now_ns);

  /// What the vehicle says, believed for a second: until it says otherwise its setpoints are flown.
  /// Nothing is accepted while they are not. One that comes back from where others flew it to is
  /// stopped where it is: it does not chase the place that it held before.
  void heard_vehicle(Control control, std::int64_t now_ns);

  /// What must be noticed when nothing comes in. Odometry older than its timeout is lost: the
  /// vehicle, which gets no command, brakes by itself, and is stopped from where it is when
  /// odometry is back. So is one whose tracker was not called for that long (process_stalled). A
  /// silent navigator is lost: what is committed is flown to its end and held there; after
  /// land_after_s at rest the vehicle lands where the map shows the way down free, else it holds
  /// until a map does. Each is a fault with a code. Included in step().
  void watch(std::int64_t now_ns);

  /// What the vehicle is to fly if this tracker falls silent: what is flown now, braked along its
  /// path fallback_after_s from now. For the vehicle, in advance: twenty times a second, and
  /// whenever what is flown has changed. Allocates only if `stop` never held as many states.
  /// @return false, and `stop` as it was: where the vehicle is, is not known
  bool make_fallback(FallbackStop& stop, std::int64_t now_ns) const;

  /// As of the last step() or watch().
  TrackingStatus status() const;

 private:
  explicit Tracker(const Config& config);
  Status check_odometry(const RigidBodyState& state, std::int64_t stamp_ns,
                        std::int64_t now_ns) const;
  Status check_rest(const RigidBodyState& state, std::int64_t stamp_ns, std::int64_t now_ns);
  Status check_start(const Reference& candidate, std::int64_t now_ns) const;
  const Reference& flown_at(std::int64_t time_ns) const;
  FlatState reference_at(std::int64_t time_ns) const { return flown_at(time_ns).at(time_ns); }
  void hold_here(const RigidBodyState& state);
  void take_in(const RigidBodyState& state, std::int64_t stamp_ns, std::int64_t now_ns);
  void switch_trajectories(std::int64_t now_ns);
  void notice_stall(std::int64_t now_ns);
  double jump_m(const RigidBodyState& state, std::int64_t stamp_ns) const;
  void stop_after_jump(double jump_m, std::int64_t now_ns);
  Status check_agreement(std::int64_t now_ns) const;
  Status check_control(std::int64_t now_ns) const;
  void find_again(std::int64_t last_stamp_ns, std::int64_t now_ns);
  void forget_errors();
  void watch_error(std::int64_t now_ns);
  void watch_odometry(std::int64_t now_ns);
  void watch_navigator(std::int64_t now_ns);
  void try_to_land(std::int64_t now_ns);
  void land(std::int64_t now_ns);
  void stay(const Error& why, const Vec3& position_map);
  void lose(const Error& why, std::int64_t since_ns);
  void stop_where_it_is(const Vec3& acceleration_map, std::int64_t last_stamp_ns,
                        std::int64_t now_ns);
  Stop plan_stop_from(const FlatState& vehicle, std::int64_t last_stamp_ns,
                      std::int64_t now_ns) const;
  void check_landing(std::int64_t now_ns);
  void check_flight(std::int64_t now_ns);
  void drop_queued(std::size_t first, const Error& why, std::uint64_t newest);
  bool stop_sooner(Reference& flown, std::int64_t from_ns);
  void stop_before(const Obstruction& found, std::uint64_t newest, std::int64_t now_ns);
  bool stop_on_free_way(std::int64_t now_ns);
  std::uint64_t followed_id() const;
  std::uint64_t newest_id() const;
  double turn(std::int64_t now_ns);
  double wanted_yaw(std::int64_t now_ns) const;

  Config config_;
  PositionController controller_;
  Reference reference_ = Reference::hold(Vec3::Zero());
  std::vector<Reference> queue_;  // by start time

  bool has_state_ = false;
  RigidBodyState state_;
  std::int64_t stamp_ns_ = 0;
  double since_last_s_ = 0.0;  // between the last two states
  std::int64_t now_ns_ = 0;
  std::int64_t called_ns_ = 0;                  // the last step() or watch()
  bool whereabouts_lost_ = false;               // until the next odometry
  std::optional<std::int64_t> moves_since_ns_;  // first odometry, of a vehicle that does not rest
  std::optional<std::int64_t> jumped_ns_;       // when odometry last jumped
  std::optional<std::int64_t> disputed_ns_;     // when it last jumped to and fro
  double first_yaw_rad_ = 0.0;
  double yaw_rad_ = 0.0;

  Error lost_{ErrorCode::ok, ""};  // why, until another trajectory is switched to
  std::uint64_t lost_id_ = 0;
  Error stalled_{ErrorCode::ok, ""};  // for a second, so that it can be reported
  std::int64_t stalled_ns_ = 0;
  Error refused_{ErrorCode::ok, ""};      // the newest odometry, or too far from where it holds
  Error deserted_{ErrorCode::ok, ""};     // by the navigator, until it is heard again
  std::optional<std::int64_t> heard_ns_;  // the navigator's last sign of life
  Control control_ = Control::goshawk;
  std::int64_t control_ns_ = 0;                // when the vehicle said so
  std::optional<std::int64_t> rest_since_ns_;  // the reference's, for good
  LandingGuard guard_;
  MapGuard map_;
  bool landing_ = false;
  bool stays_ = false;  // the newest map, or none, does not allow it to land
  double error_m_ = 0.0;
  double squared_error_m2_ = 0.0;
  double max_error_m_ = 0.0;
  std::int64_t samples_ = 0;
};

}  // namespace goshawk::tracker
