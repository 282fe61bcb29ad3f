#include <algorithm>
#include <cmath>
#include <utility>

#include "clock_time.hpp"
#include "goshawk/tracker/tracker.hpp"

// What the tracker does when the vehicle may not be where it should be: it stops it where it is.

namespace goshawk::tracker {
namespace {

// Around the part of the path that was to be flown meanwhile: [s] before and after it.
constexpr double kSearchBefore_s = 0.2;
constexpr double kSearchAfter_s = 1.0;
constexpr double kContradiction_s = 0.5;
constexpr double kControlHolds_s = 1.0;  // what the vehicle said of who flies it

}  // namespace

void Tracker::watch(std::int64_t now_ns) {
  if (!within_bound(now_ns) || !has_state_) return;
  notice_stall(now_ns);
  watch_odometry(now_ns);
  watch_navigator(now_ns);
}

void Tracker::notice_stall(std::int64_t now_ns) {
  const std::int64_t last_ns = std::exchange(called_ns_, now_ns);
  const double gap_s = seconds(last_ns, now_ns);
  if (!has_state_ || gap_s <= config_.odometry_timeout_s) return;
  stalled_ = fail(ErrorCode::process_stalled,
                  "the tracker did not run for " + number(gap_s) + " s, more than " +
                      number(config_.odometry_timeout_s) +
                      " s: stopping where the vehicle is; was the process stopped or its host "
                      "overloaded?");
  stalled_ns_ = now_ns;
  whereabouts_lost_ = true;
  lose(stalled_, last_ns);
}

void Tracker::watch_odometry(std::int64_t now_ns) {
  const double age_s = seconds(stamp_ns_, now_ns);
  if (age_s <= config_.odometry_timeout_s) return;
  whereabouts_lost_ = true;
  lose(fail(ErrorCode::tracking_lost,
            "no valid odometry for " + number(age_s) + " s, more than " +
                number(config_.odometry_timeout_s) +
                " s: no command goes out, the vehicle brakes by itself; is its source alive?"),
       stamp_ns_);
}

double Tracker::jump_m(const RigidBodyState& state, std::int64_t stamp_ns) const {
  const double speed = std::max(state.velocity_map.norm(), state_.velocity_map.norm());
  const double moved = (state.position_map - state_.position_map).norm();
  return moved - speed * seconds(stamp_ns_, stamp_ns);
}

// The vehicle is where it was, but its coordinates are not: no path in them can be trusted, and it
// stops in those that it has now.
void Tracker::stop_after_jump(double jump_m, std::int64_t now_ns) {
  const Vec3 acceleration = reference_.at(stamp_ns_).acceleration;
  lose(fail(ErrorCode::tracking_lost,
            "odometry jumped by " + number(jump_m) + " m; stopping at the new position"),
       now_ns);
  reference_ = Reference::hold(state_.position_map);
  forget_errors();
  controller_.interrupt();
  landing_ = whereabouts_lost_ = false;
  if (state_.velocity_map.norm() > config_.start_velocity_tolerance_m_s) {
    stop_where_it_is(acceleration, stamp_ns_, now_ns);
  }
  // Once is a correction; to and fro is two sources that do not agree, and neither is believed.
  if (jumped_ns_ && seconds(*jumped_ns_, now_ns) < kContradiction_s) disputed_ns_ = now_ns;
  jumped_ns_ = now_ns;
}

Status Tracker::check_agreement(std::int64_t now_ns) const {
  if (!disputed_ns_ || seconds(*disputed_ns_, now_ns) >= kContradiction_s) return success();
  return fail(
      ErrorCode::tracking_lost,
      "odometry jumps to and fro: no command goes out, the vehicle brakes by itself; do two "
      "programs publish it?");
}

void Tracker::heard_vehicle(Control control, std::int64_t now_ns) {
  if (!within_bound(now_ns)) return;
  const bool returns = control == Control::goshawk && !check_control(now_ns);
  control_ = control;
  control_ns_ = now_ns;
  if (!returns) return;
  controller_.reset();  // what it learnt from a vehicle that others flew is wrong
  if (error_m_ > config_.error_allowance_m) whereabouts_lost_ = true;
}

Status Tracker::check_control(std::int64_t now_ns) const {
  if (seconds(control_ns_, now_ns) > kControlHolds_s) return success();
  const auto not_flown = [](const char* why) {
    return fail(ErrorCode::tracking_lost,
                std::string("the vehicle does not fly the setpoints: ") + why);
  };
  switch (control_) {
    case Control::goshawk:
      return success();
    case Control::autopilot:
      return not_flown(
          "its autopilot has control: none has reached it yet, or it is in another mode");
    case Control::pilot:
      return not_flown("its pilot has control");
    case Control::nobody:
      return not_flown("its motors are not armed");
  }
  throw std::logic_error("check_control() of no Control");
}

// Odometry is back, or tells another place.
void Tracker::find_again(std::int64_t last_stamp_ns, std::int64_t now_ns) {
  whereabouts_lost_ = false;
  controller_.interrupt();
  const double off_m = (state_.position_map - reference_.at(stamp_ns_).position).norm();
  const bool held = reference_.at_rest(now_ns) && off_m <= config_.error_allowance_m &&
                    state_.velocity_map.norm() <= config_.start_velocity_tolerance_m_s;
  if (!held) stop_where_it_is(Vec3::Zero(), last_stamp_ns, now_ns);
}

void Tracker::stop_where_it_is(const Vec3& acceleration_map, std::int64_t last_stamp_ns,
                               std::int64_t now_ns) {
  const FlatState vehicle{.position = state_.position_map,
                          .velocity = state_.velocity_map,
                          .acceleration = acceleration_map};
  reference_.leave_by(plan_stop_from(vehicle, last_stamp_ns, now_ns).curve, stamp_ns_);
  landing_ = false;
}

Stop Tracker::plan_stop_from(const FlatState& vehicle, std::int64_t last_stamp_ns,
                             std::int64_t now_ns) const {
  std::optional<LeftPath> path;
  if (reference_.has_trajectory()) {
    path = LeftPath{
        .trajectory = &reference_.committed().flown(),
        .from_s = std::max(0.0, reference_.progress_s(last_stamp_ns) - kSearchBefore_s),
        .to_s = std::min(reference_.duration_s(), reference_.progress_s(now_ns) + kSearchAfter_s)};
  }
  const StopLimits limits{.gentle_m_s2 = config_.brake_acceleration_m_s2,
                          .hardest_m_s2 = config_.stop_acceleration_m_s2};
  const auto contact = [this](const BezierPiece& curve) { return map_.first_contact(curve); };
  return plan_stop(vehicle, path, limits, contact);
}

void Tracker::watch_error(std::int64_t now_ns) {
  const FlatState reference = reference_.at(stamp_ns_);
  error_m_ = (state_.position_map - reference.position).norm();
  squared_error_m2_ += error_m_ * error_m_;
  max_error_m_ = std::max(max_error_m_, error_m_);
  ++samples_;
  if (error_m_ <= config_.error_allowance_m) return;
  const bool stops_already = lost_.code != ErrorCode::ok && !reference_.follows();
  const bool follows = !stops_already && !landing_ && !reference_.at_rest(now_ns);
  const std::string off = number(error_m_) +
                          " m from where it should be, more than the allowance of " +
                          number(config_.error_allowance_m) + " m";
  const Status flown = check_control(now_ns);
  lose(fail(ErrorCode::tracking_lost,
            flown ? "the vehicle is " + off + ": stopping; plan again from there"
                  : flown.error().message + ", and it is " + off),
       now_ns);
  if (follows) stop_where_it_is(reference.acceleration, stamp_ns_, now_ns);
}

// @param since_ns when the vehicle was last known to be where it should be. At rest nothing is lost
// for long: the fault lasts as long as its cause.
void Tracker::lose(const Error& why, std::int64_t since_ns) {
  if (lost_.code != ErrorCode::ok) return;
  const bool rests = reference_.at_rest(since_ns);
  if (rests && queue_.empty()) {
    refused_ = why;
    return;
  }
  lost_ = why;
  lost_id_ = newest_id();
  queue_.clear();
  if (whereabouts_lost_ && !landing_) reference_.brake(since_ns, config_.brake_acceleration_m_s2);
}

}  // namespace goshawk::tracker
