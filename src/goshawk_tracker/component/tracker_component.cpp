#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "goshawk/conversions/plan.hpp"
#include "goshawk/conversions/status.hpp"
#include "goshawk/conversions/vehicle.hpp"
#include "goshawk/runtime/component.hpp"
#include "goshawk/stage/background_map.hpp"
#include "goshawk/stage/intake.hpp"
#include "goshawk/stage/sender_clock.hpp"
#include "goshawk/tracker/commit_gate.hpp"
#include "goshawk/tracker/odometry_clock.hpp"
#include "goshawk/tracker/tracker.hpp"

namespace goshawk::tracker {
namespace {

using namespace goshawk::runtime;
using namespace goshawk::stage;
namespace msg = goshawk_msgs::msg;

constexpr double kClockStep_s = 0.02;  // less is not worth a sentence
constexpr std::int64_t kFallbackPeriod_ns = 50'000'000;

Tracker make_tracker(const Config& config) {
  auto tracker = Tracker::create(config);
  if (!tracker) throw StartupFault(tracker.error());
  return *std::move(tracker);
}

std::uint8_t to_msg(Mode mode) {
  namespace constants = goshawk_msgs::msg::TrackingState_Constants;
  static_assert(std::uint8_t(Mode::idle) == constants::MODE_IDLE &&
                std::uint8_t(Mode::hold) == constants::MODE_HOLD &&
                std::uint8_t(Mode::follow) == constants::MODE_FOLLOW &&
                std::uint8_t(Mode::brake) == constants::MODE_BRAKE &&
                std::uint8_t(Mode::land) == constants::MODE_LAND);
  return std::uint8_t(mode);
}

Control control_of(const msg::VehicleStatus& m) {
  namespace constants = msg::VehicleStatus_Constants;
  if (!m.armed()) return Control::nobody;
  switch (m.control()) {
    case constants::CONTROL_GOSHAWK:
      return Control::goshawk;
    case constants::CONTROL_PILOT:
      return Control::pilot;
    case constants::CONTROL_AUTOPILOT:
      return Control::autopilot;
    default:
      return Control::nobody;
  }
}

// Only whose verdicts count must be one process.
std::uint8_t judging_stage(const msg::StageReport& m) {
  const bool judges = conversions::stage_role_of(m.stage()) == StageRole::flight_check;
  return judges ? m.stage() : std::uint8_t{0};
}

/// What a flight's control steps cost, and how evenly they came.
class StepStatistics {
 public:
  void begin(std::uint64_t id) { *this = StepStatistics{}, id_ = id; }

  void add(std::int64_t compute_ns, std::int64_t now_ns) {
    ++steps_;
    compute_ns_ += compute_ns;
    longest_ns_ = std::max(longest_ns_, compute_ns);
    if (last_ns_ != 0) {
      const double gap_ms = double(now_ns - last_ns_) * 1e-6;
      gaps_ms_ += gap_ms;
      squared_gaps_ms2_ += gap_ms * gap_ms;
      longest_gap_ms_ = std::max(longest_gap_ms_, gap_ms);
    }
    last_ns_ = now_ns;
  }

  std::uint64_t id() const { return id_; }
  std::int64_t mean_compute_ns() const { return steps_ > 0 ? compute_ns_ / steps_ : 0; }
  double longest_compute_us() const { return double(longest_ns_) * 1e-3; }
  double longest_gap_ms() const { return longest_gap_ms_; }
  /// [ms] standard deviation of the time between steps
  double jitter_ms() const {
    const double gaps = double(std::max<std::int64_t>(1, steps_ - 1));
    const double mean = gaps_ms_ / gaps;
    return std::sqrt(std::max(0.0, squared_gaps_ms2_ / gaps - mean * mean));
  }

 private:
  std::uint64_t id_ = 0;
  std::int64_t steps_ = 0;
  std::int64_t compute_ns_ = 0;
  std::int64_t longest_ns_ = 0;
  std::int64_t last_ns_ = 0;
  double gaps_ms_ = 0.0;
  double squared_gaps_ms2_ = 0.0;
  double longest_gap_ms_ = 0.0;
};

/// committed_trajectory, odom, vehicle_status, navigator_alive, map/voxels, stage_report of
/// flight_check -> command, fallback_stop, tracking_state. Counts on the monotonic clock: what
/// others stamp with their wall clocks is brought to it once, when it arrives. Maps come in another
/// thread.
class TrackerComponent : public Component {
 public:
  explicit TrackerComponent(Node& node)
      : node_(node),
        config_(
            node.parameters<Config>([this](const Config& c) { return tracker_.reconfigure(c); })),
        tracker_(make_tracker(config_)),
        odometry_clock_(config_.odometry_timeout_s),
        gate_(config_),
        reporter_(node, StageRole::tracker, config_.controller),
        map_(node),
        commands_(node.advertise<msg::AttitudeSetpoint>("command", Qos::best_effort())),
        fallbacks_(node.advertise<msg::FallbackStop>("fallback_stop", Qos::best_effort())),
        states_(node.advertise<msg::TrackingState>("tracking_state", Qos::state())) {
    // Before the commits of the same moment, which it dates.
    node.subscribe<msg::NavigatorState>(
        "navigator_alive", Qos::best_effort(),
        [this](const msg::NavigatorState& m, const MessageInfo&) {
          tracker_.heard_navigator(node_.monotonic_ns());
          navigator_clock_.hear(conversions::to_ns(m.header().stamp()), node_.monotonic_ns());
        },
        Writers::one("navigator"));
    node.subscribe<msg::CommittedTrajectory>(
        "committed_trajectory", Qos::latched(),
        [this](const msg::CommittedTrajectory& m, const MessageInfo& info) { on_commit(m, info); },
        Writers::one("navigator"));
    node.subscribe<nav_msgs::msg::Odometry>(
        "odom", Qos::best_effort(),
        [this](const nav_msgs::msg::Odometry& m, const MessageInfo&) { on_odometry(m); },
        Writers::one("odom"));
    node.subscribe<msg::VehicleStatus>(
        "vehicle_status", Qos::best_effort(),
        [this](const msg::VehicleStatus& m, const MessageInfo&) {
          tracker_.heard_vehicle(control_of(m), node_.monotonic_ns());
        },
        Writers::one("vehicle_status"));
    if (config_.second_opinion != SecondOpinion::off) {
      node.subscribe<msg::StageReport>(
          "stage_report", Qos::reliable_last(50),
          [this](const msg::StageReport& m, const MessageInfo&) { on_report(m); },
          Writers::one_each<msg::StageReport>("stage_report", &judging_stage));
    }
    node.every(0.05, [this] { watch(); });
    reporter_.ready("tracks with " + config_.controller);
  }

 private:
  void on_commit(const msg::CommittedTrajectory& m, const MessageInfo& info) {
    const Timing timing{.wire_ns = wire_time_ns(m.header(), info)};
    const std::int64_t now_ns = node_.monotonic_ns(), wall_ns = node_.now_ns();
    const std::int64_t skew_ns =
        navigator_clock_.skew_ns(wall_ns, now_ns, conversions::to_ns(m.header().stamp()));
    if (const Status clocks = SenderClock::check(skew_ns, "the navigator"); !clocks) {
      return reporter_.failed(m.nominal().request().id(), clocks.error(), timing);
    }
    auto received = conversions::from_msg(m);
    if (!received) {
      return reporter_.failed(m.nominal().request().id(), received.error(), timing);
    }
    const std::int64_t start_ns = received->start_time_ns() - skew_ns + (now_ns - wall_ns);
    const std::uint64_t id = received->id();
    const auto old = gate_.put({*std::move(received), start_ns, now_ns, timing.wire_ns});
    if (old && *old != id) {  // else the navigator repeats itself
      reporter_.failed(*old, fail(ErrorCode::cancelled,
                                  fmt::format("trajectory {} waited to be checked, and a newer one "
                                              "has come",
                                              *old)));
    }
    take_waiting();
  }

  // What flight_check says of a trajectory.
  void on_report(const msg::StageReport& m) {
    if (conversions::stage_role_of(m.stage()) != StageRole::flight_check) return;
    const ErrorCode code = conversions::error_code_of(m.code());
    gate_.hear(m.request_id(), {code, m.message()});
    if (code == ErrorCode::collision) {
      tracker_.veto(m.request_id(), m.message(), node_.monotonic_ns());
    }
    take_waiting();
  }

  // The newest map, and the commit that may have waited for it.
  void take_waiting() {
    const std::int64_t now_ns = node_.monotonic_ns();
    if (auto grid = map_.take()) tracker_.set_map(std::move(grid), now_ns);
    if (const auto fault = map_.take_fault()) reporter_.fault(*fault);
    if (!gate_.waits()) return;
    const bool has_odometry = tracker_.status().mode != Mode::idle;
    auto release = gate_.release(has_odometry, tracker_.map_version(), now_ns);
    if (!release) return;
    Commit& commit = release->commit;
    const std::uint64_t id = commit.trajectory.id();
    Timing timing{.wire_ns = commit.wire_ns};
    if (!release->verdict) return reporter_.failed(id, release->verdict.error(), timing);
    const auto [status, compute_ns] = timed(
        [&] { return tracker_.accept(std::move(commit.trajectory), commit.start_ns, now_ns); });
    timing.compute_ns = compute_ns;
    if (!status) return reporter_.failed(id, status.error(), timing);
    accepted_ = timing;
    reporter_.answered(id, timing);
  }

  void on_odometry(const nav_msgs::msg::Odometry& m) {
    const auto state = conversions::from_msg(m);
    if (!state) return reporter_.complain(state.error());
    const std::int64_t sent_stamp_ns = conversions::to_ns(m.header().stamp());
    const std::int64_t now_ns = node_.monotonic_ns();
    const auto made = odometry_clock_.read(sent_stamp_ns, node_.now_ns(), now_ns);
    if (std::abs(made.set_by_s) >= kClockStep_s) report_clock(made.set_by_s);
    const auto [command, compute_ns] =
        timed([&] { return tracker_.step(*state, made.time_ns, now_ns); });
    count_step(compute_ns, now_ns);
    if (!command) return reporter_.complain(command.error());
    conversions::fill_msg(*command, command_message_);
    command_message_.header(conversions::make_header(node_.now_ns()));
    reporter_.send(commands_, command_message_);
    take_waiting();
    publish_fallback(now_ns);
    publish_state(sent_stamp_ns);
  }

  // What the vehicle flies if this process falls silent: in advance, and anew when what is flown
  // has changed. The moments do not depend on when the tracker was started.
  void publish_fallback(std::int64_t now_ns) {
    const TrackingStatus status = tracker_.status();
    const Flown flown{status.mode, status.trajectory_id, status.lost_trajectory_id,
                      now_ns / kFallbackPeriod_ns};
    if (!flown_) flown_ = flown;
    if (flown == *flown_ || !tracker_.make_fallback(fallback_, now_ns)) return;
    flown_ = flown;
    conversions::fill_msg(fallback_, fallback_message_);
    fallback_message_.header(conversions::make_header(node_.now_ns()));
    reporter_.send(fallbacks_, fallback_message_);
  }

  void report_clock(double set_by_s) {
    reporter_.fault(fail(ErrorCode::clock_set,
                         fmt::format("the clock that stamps odometry was set by {:.3g} s: its age "
                                     "is taken to be as before",
                                     set_by_s)));
  }

  // A second answer to the request, once its trajectory is flown: how well, and at what cost.
  void count_step(std::int64_t compute_ns, std::int64_t now_ns) {
    const TrackingStatus status = tracker_.status();
    if (status.mode == Mode::follow && status.trajectory_id != steps_.id()) {
      steps_.begin(status.trajectory_id);
    }
    if (steps_.id() == 0) return;
    steps_.add(compute_ns, now_ns);
    if (status.mode != Mode::hold || status.lost_trajectory_id != 0) return;
    reporter_.answered(steps_.id(),
                       {.wire_ns = accepted_.wire_ns, .compute_ns = steps_.mean_compute_ns()},
                       {{"rms_error_m", status.rms_error_m},
                        {"max_error_m", status.max_error_m},
                        {"longest_step_us", steps_.longest_compute_us()},
                        {"jitter_ms", steps_.jitter_ms()},
                        {"longest_gap_ms", steps_.longest_gap_ms()}});
    steps_.begin(0);
  }

  // What must be said when odometry or the navigator are silent.
  void watch() {
    tracker_.watch(node_.monotonic_ns());
    take_waiting();
    report_fault(tracker_.status());
  }

  // Once each; what the moment alone is to blame for, once a second.
  void report_fault(const TrackingStatus& status) {
    if (status.fault.code != ErrorCode::ok && status.fault.message != reported_) {
      if (status.lost_trajectory_id != 0 || status.fault.code != ErrorCode::tracking_lost) {
        reporter_.failed(status.lost_trajectory_id, status.fault);
      } else {
        reporter_.complain(status.fault);
      }
    }
    reported_ = status.fault.message;
  }

  void publish_state(std::int64_t stamp_ns) {
    const TrackingStatus status = tracker_.status();
    report_fault(status);
    msg::TrackingState m;
    m.header(conversions::make_header(stamp_ns));
    m.mode(to_msg(status.mode));
    m.request_id(status.trajectory_id);
    m.time_in_trajectory(status.progress_s);
    m.reference(conversions::to_point(status.reference.position));
    m.position_error(status.error_m);
    reporter_.send(states_, m);
  }

  /// Changes with what is flown, and with time.
  struct Flown {
    Mode mode;
    std::uint64_t id;
    std::uint64_t lost_id;
    std::int64_t period;
    bool operator==(const Flown&) const = default;
  };

  Node& node_;
  Config config_;
  Tracker tracker_;
  OdometryClock odometry_clock_;
  SenderClock navigator_clock_;
  CommitGate gate_;
  StageReporter reporter_;
  BackgroundMap map_;
  Publisher<msg::AttitudeSetpoint> commands_;
  Publisher<msg::FallbackStop> fallbacks_;
  Publisher<msg::TrackingState> states_;
  msg::AttitudeSetpoint command_message_;
  msg::FallbackStop fallback_message_;
  FallbackStop fallback_;
  std::optional<Flown> flown_;  // when the last one was sent
  StepStatistics steps_;
  Timing accepted_;       // of the newest trajectory that was
  std::string reported_;  // the newest fault's sentence
};

}  // namespace
}  // namespace goshawk::tracker

GOSHAWK_REGISTER_COMPONENT(goshawk::tracker::TrackerComponent, goshawk::tracker::Config)
