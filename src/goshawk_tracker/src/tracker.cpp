#include "goshawk/tracker/tracker.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "clock_time.hpp"
#include "goshawk/core/flatness.hpp"
#include "goshawk/tracker/admission.hpp"

namespace goshawk::tracker {
namespace {

const Error kNoFault{ErrorCode::ok, ""};
constexpr double kSayStall_s = 1.0;
constexpr double kLongestWait_s = 5.0;  // for a vehicle to come to rest by itself
constexpr double kSlow_m_s = 0.4;       // a landing, or nearly at rest: it is stopped within 0.2 m
// Beyond these no odometry is true, and squares of it would not be finite.
constexpr double kFarthest_m = 1e6;
constexpr double kFastest_m_s = 1e3;
constexpr double kFastest_rad_s = 1e3;
// What waits is checked with every map: its number and its wait are bounded.
constexpr std::size_t kMostQueued = 8;
constexpr double kFarthestStart_s = 60.0;

}  // namespace

std::string_view to_string(Mode mode) {
  switch (mode) {
    case Mode::idle:
      return "idle";
    case Mode::hold:
      return "hold";
    case Mode::follow:
      return "follow";
    case Mode::brake:
      return "brake";
    case Mode::land:
      return "land";
  }
  throw std::logic_error("to_string() of no Mode");
}

Result<Tracker> Tracker::create(const Config& config) {
  if (auto status = check(config); !status) return status.error();
  return Tracker(config);
}

Tracker::Tracker(const Config& config)
    : config_(config),
      controller_(config),
      guard_(config.landing, config.land_height_m),
      map_(config.require_map, config.fly_unknown) {}

Status Tracker::reconfigure(const Config& config) {
  if (auto status = check(config); !status) return status;
  if (auto status = check_change(config_, config); !status) return status;
  config_ = config;
  return success();
}

Status Tracker::accept(CommittedTrajectory committed, std::int64_t start_ns, std::int64_t now_ns) {
  if (auto status = admit(committed, config_); !status) return status;
  if (const Status status = check_control(now_ns); !status) {
    return fail(status.code(),
                fmt::format("trajectory {} refused: {}", committed.id(), status.error().message));
  }
  auto candidate = Reference::follow(
      std::make_shared<const CommittedTrajectory>(std::move(committed)), start_ns);
  if (auto status = check_start(candidate, now_ns); !status) return status;
  const double from_s = std::max(0.0, seconds(start_ns, now_ns));
  if (auto status = map_.check(candidate.committed(), from_s); !status) return status;
  const auto first_later = std::ranges::find_if(
      queue_, [&](const Reference& queued) { return queued.start_ns() >= start_ns; });
  if (first_later - queue_.begin() >= std::ptrdiff_t(kMostQueued)) {
    return fail(ErrorCode::not_at_start,
                fmt::format("trajectory {} refused: {} trajectories wait for their start before it",
                            candidate.committed().id(), kMostQueued));
  }
  queue_.erase(first_later, queue_.end());
  queue_.push_back(std::move(candidate));
  return success();
}

Status Tracker::check_start(const Reference& candidate, std::int64_t now_ns) const {
  const auto refuse = [&](ErrorCode code, const std::string& why) {
    return fail(code, fmt::format("trajectory {} refused: {}", candidate.committed().id(), why));
  };
  if (!within_bound(now_ns) || !within_bound(candidate.start_ns())) {
    return refuse(ErrorCode::invalid_input,
                  "its start or the current time is outside the supported range");
  }
  if (seconds(now_ns, candidate.start_ns()) > kFarthestStart_s) {
    return refuse(ErrorCode::not_at_start,
                  fmt::format("it begins {:.3g} s from now: commit it {:g} s ahead at the most",
                              seconds(now_ns, candidate.start_ns()), kFarthestStart_s));
  }
  if (!has_state_) {
    return refuse(ErrorCode::not_at_start, "there is no odometry yet to tell where the vehicle is");
  }
  if (whereabouts_lost_ || seconds(stamp_ns_, now_ns) > config_.odometry_timeout_s) {
    return refuse(ErrorCode::not_at_start,
                  "the newest odometry is " + number(seconds(stamp_ns_, now_ns)) +
                      " s old and does not tell where the vehicle is; plan again once it does");
  }
  const std::int64_t joins_ns = std::max(candidate.start_ns(), now_ns);
  if (seconds(candidate.start_ns(), joins_ns) >= candidate.duration_s()) {
    return refuse(ErrorCode::deadline_exceeded,
                  "it ended " +
                      number(seconds(candidate.start_ns(), now_ns) - candidate.duration_s()) +
                      " s ago; commit it with a later start");
  }
  const FlatState joint = candidate.at(joins_ns);
  const auto is_near = [&](const Vec3& position, const Vec3& velocity) {
    return (joint.position - position).norm() <= config_.start_tolerance_m &&
           (joint.velocity - velocity).norm() <= config_.start_velocity_tolerance_m_s;
  };
  const FlatState present = reference_at(joins_ns);
  if (is_near(present.position, present.velocity)) return success();
  // Where the vehicle is now tells where it will be only when it joins now, or hovers.
  const bool joins_now = candidate.start_ns() <= now_ns;
  const Vec3 vehicle =
      state_.position_map +
      (joins_now ? std::clamp(seconds(stamp_ns_, now_ns), 0.0, config_.odometry_timeout_s) : 0.0) *
          state_.velocity_map;
  if ((joins_now || (reference_.at_rest(now_ns) && queue_.empty())) &&
      is_near(vehicle, state_.velocity_map)) {
    return success();
  }
  return refuse(ErrorCode::not_at_start,
                "it begins at " + to_text(joint.position) + " m with " + to_text(joint.velocity) +
                    " m/s, while the vehicle is to be at " + to_text(present.position) +
                    " m with " + to_text(present.velocity) + " m/s then and is now at " +
                    to_text(state_.position_map) + " m; plan from there");
}

void Tracker::brake(std::int64_t now_ns) {
  queue_.clear();
  reference_.brake(now_ns, config_.brake_acceleration_m_s2);
}

Result<AttitudeSetpoint> Tracker::step(const RigidBodyState& state, std::int64_t stamp_ns,
                                       std::int64_t now_ns) {
  if (within_bound(now_ns)) notice_stall(now_ns);
  if (auto status = check_odometry(state, stamp_ns, now_ns); !status) {
    refused_ = status.error();
    return status.error();
  }
  if (auto status = check_rest(state, stamp_ns, now_ns); !status) return status.error();
  if (seconds(stalled_ns_, now_ns) > kSayStall_s) stalled_ = kNoFault;
  take_in(state, stamp_ns, now_ns);
  if (auto status = check_agreement(now_ns); !status) {
    whereabouts_lost_ = true;
    refused_ = status.error();
    return status.error();
  }
  switch_trajectories(now_ns);
  watch_error(now_ns);
  watch_navigator(now_ns);

  const double yaw_rate = turn(now_ns);
  now_ns_ = now_ns;
  const std::int64_t ahead_ns = now_ns + std::llround(config_.actuation_delay_s * 1e9);
  return controller_.step(state_,
                          {.now = reference_.at(stamp_ns_),
                           .ahead = reference_at(ahead_ns),
                           .yaw_rad = yaw_rad_,
                           .yaw_rate_rad_s = yaw_rate},
                          since_last_s_);
}

Status Tracker::check_odometry(const RigidBodyState& state, std::int64_t stamp_ns,
                               std::int64_t now_ns) const {
  const auto invalid = [](const std::string& why) {
    return fail(ErrorCode::invalid_input, "odometry refused: " + why);
  };
  if (!within_bound(stamp_ns) || !within_bound(now_ns))
    return invalid("its timestamp is outside the supported range");
  if (!state.is_finite()) return invalid("a number in it is not finite");
  if (state.position_map.cwiseAbs().maxCoeff() > kFarthest_m ||
      state.velocity_map.cwiseAbs().maxCoeff() > kFastest_m_s ||
      state.angular_velocity_base.cwiseAbs().maxCoeff() > kFastest_rad_s) {
    return invalid("no vehicle is at " + to_text(state.position_map) + " m with " +
                   to_text(state.velocity_map) + " m/s and " +
                   to_text(state.angular_velocity_base) + " rad/s");
  }
  if (!(std::abs(state.q_map_base.norm() - 1.0) <= 1e-3)) {
    return invalid("its quaternion has length " + number(state.q_map_base.norm()) + ", not one");
  }
  const double age_s = seconds(stamp_ns, now_ns);
  if (age_s < -config_.odometry_timeout_s) {
    return invalid("it is stamped " + number(-age_s) +
                   " s in the future; are the clocks the same?");
  }
  if (age_s > config_.odometry_timeout_s) {
    return fail(ErrorCode::tracking_lost, "odometry is " + number(age_s) + " s old, more than " +
                                              number(config_.odometry_timeout_s) +
                                              " s; is its source alive?");
  }
  const double back_s = has_state_ ? seconds(stamp_ns, stamp_ns_) : 0.0;
  if (back_s > 0.0 && back_s <= config_.odometry_timeout_s) {
    return invalid("it is " + number(back_s) + " s older than the last");
  }
  return success();
}

// A first odometry of a vehicle that moves: this tracker does not know on which path. The vehicle
// does, if another tracker gave it a fallback stop.
Status Tracker::check_rest(const RigidBodyState& state, std::int64_t stamp_ns,
                           std::int64_t now_ns) {
  const bool first = !has_state_ || stamp_ns < stamp_ns_;
  const double speed = state.velocity_map.norm();
  if (!first || speed <= kSlow_m_s) {
    moves_since_ns_.reset();
    return success();
  }
  if (!moves_since_ns_) moves_since_ns_ = now_ns;
  if (seconds(*moves_since_ns_, now_ns) > kLongestWait_s) return success();
  has_state_ = false;
  return fail(ErrorCode::tracking_lost,
              fmt::format("the vehicle flies at {:.2g} m/s and this tracker has only just started: "
                          "no command goes out until the vehicle has come to rest by itself",
                          speed));
}

// The state, and what a first one, a restarted clock, a gap or a jump mean for the reference.
void Tracker::take_in(const RigidBodyState& state, std::int64_t stamp_ns, std::int64_t now_ns) {
  const bool restarted = has_state_ && stamp_ns < stamp_ns_;
  const bool first = !has_state_ || restarted;
  if (first) {
    hold_here(state);
    controller_.reset();
    first_yaw_rad_ = yaw_rad_ = yaw_of(state.q_map_base);
    now_ns_ = stamp_ns_ = stamp_ns;
    lost_ = refused_ = stalled_ = deserted_ = kNoFault;
    heard_ns_.reset();
    jumped_ns_.reset();
    disputed_ns_.reset();
  } else {
    watch_odometry(stamp_ns);  // a gap behind us
    refused_ = kNoFault;
  }
  const double jump = first ? 0.0 : jump_m(state, stamp_ns);
  since_last_s_ = seconds(stamp_ns_, stamp_ns);
  const std::int64_t last_stamp_ns = std::exchange(stamp_ns_, stamp_ns);
  has_state_ = true;
  state_ = state;
  state_.q_map_base.normalize();
  if (first && state.velocity_map.norm() > config_.start_velocity_tolerance_m_s) {
    stop_where_it_is(Vec3::Zero(), stamp_ns, now_ns);
  } else if (jump > config_.max_jump_m) {
    stop_after_jump(jump, now_ns);
  } else if (whereabouts_lost_ && check_agreement(now_ns)) {
    find_again(last_stamp_ns, now_ns);
  }
}

void Tracker::hold_here(const RigidBodyState& state) {
  reference_ = Reference::hold(state.position_map);
  queue_.clear();
  landing_ = whereabouts_lost_ = false;
  forget_errors();
}

void Tracker::forget_errors() {
  squared_error_m2_ = max_error_m_ = 0.0;
  samples_ = 0;
}

void Tracker::switch_trajectories(std::int64_t now_ns) {
  while (!queue_.empty() && queue_.front().start_ns() <= now_ns) {
    reference_ = std::move(queue_.front());
    queue_.erase(queue_.begin());
    lost_ = kNoFault;
    landing_ = false;
    forget_errors();
  }
}

std::uint64_t Tracker::followed_id() const {
  return reference_.has_trajectory() ? reference_.committed().id() : 0;
}

std::uint64_t Tracker::newest_id() const {
  return queue_.empty() ? followed_id() : queue_.back().committed().id();
}

std::optional<std::uint64_t> Tracker::map_version() const {
  return map_.grid() != nullptr ? std::optional(map_.grid()->version) : std::nullopt;
}

double Tracker::wanted_yaw(std::int64_t now_ns) const {
  if (config_.yaw == "keep" || !reference_.has_trajectory()) return first_yaw_rad_;
  return reference_.committed().yaw_at(reference_.progress_s(now_ns));
}

// The heading moves towards the wanted one at a bounded rate. @return [rad/s] that rate
double Tracker::turn(std::int64_t now_ns) {
  const double dt = seconds(now_ns_, now_ns);
  if (!(dt > 0.0)) return 0.0;
  const double most = config_.max_yaw_rate_rad_s * std::min(dt, config_.odometry_timeout_s);
  const double change = std::clamp(wrapped(wanted_yaw(now_ns) - yaw_rad_), -most, most);
  yaw_rad_ = wrapped(yaw_rad_ + change);
  return change / dt;
}

const Reference& Tracker::flown_at(std::int64_t time_ns) const {
  const auto next = std::find_if(queue_.rbegin(), queue_.rend(),
                                 [&](const auto& queued) { return queued.start_ns() <= time_ns; });
  return next == queue_.rend() ? reference_ : *next;
}

TrackingStatus Tracker::status() const {
  TrackingStatus s;
  if (!has_state_) return s;
  s.mode = landing_                      ? Mode::land
           : reference_.at_rest(now_ns_) ? Mode::hold
           : reference_.follows()        ? Mode::follow
                                         : Mode::brake;
  for (const Error* fault : {&deserted_, &refused_, &stalled_, &lost_}) {
    if (fault->code != ErrorCode::ok) s.fault = *fault;
  }
  if (landing_) s.fault = deserted_;
  if (lost_.code != ErrorCode::ok) s.lost_trajectory_id = lost_id_;
  s.trajectory_id = followed_id();
  s.progress_s = reference_.progress_s(now_ns_);
  s.duration_s = reference_.duration_s();
  s.queued = int(queue_.size());
  s.reference = reference_.at(now_ns_);
  s.error_m = error_m_;
  s.rms_error_m = samples_ > 0 ? std::sqrt(squared_error_m2_ / double(samples_)) : 0.0;
  s.max_error_m = max_error_m_;
  s.disturbance_map = controller_.disturbance_map();
  return s;
}

}  // namespace goshawk::tracker
