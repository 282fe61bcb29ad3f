#include "goshawk/navigator/navigator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "times.hpp"

namespace goshawk::navigator {

std::string_view to_string(State state) {
  constexpr std::array<std::string_view, 6> names{"idle",    "planning", "flying",
                                                  "arrived", "failed",   "held"};
  return names.at(std::size_t(state));
}

Navigator::Navigator(const Config& config, std::uint64_t first_id)
    : config_(config),
      next_id_(first_id),
      space_(config.fly_unknown),
      latency_s_(config.replan_lead_s / 2.0) {}

Status Navigator::reconfigure(const Config& config) {
  ParameterFaults faults;
  describe(config, faults);
  if (auto status = faults.status(); !status) return status;
  if (auto status = check_change(config_, config); !status) return status;
  if (config.replan_lead_s != config_.replan_lead_s) pursuit_.lead_s = config.replan_lead_s;
  config_ = config;
  return success();
}

void Navigator::resume(Memory memory, std::int64_t now_ns) {
  newest_id_ = memory.newest_id;
  pursuit_ = {.goal = memory.goal,
              .open = memory.open,
              .lead_s = config_.replan_lead_s,
              .wait_begin_ns = now_ns};
  for (Leg& leg : memory.legs) {
    next_id_ = std::max(next_id_, leg.id() + 1);
    leg.accepted = false;
    leg.beyond_m = left_m(leg);
    if (leg.end_ns() > now_ns) orders_.push_back(Commit{leg.committed, 0});
    schedule_.add(std::move(leg));
  }
  next_id_ = std::max(next_id_, newest_id_ + 1);
  if (memory.open && schedule_.moves(now_ns)) pursuit_.revoked_ns = now_ns;
  enter(memory.state, now_ns, std::move(memory.reason));
}

// [m] from the end of a leg's plan to the goal, straight: how far its plan led is not kept. A goal
// that the search moved is then planned for once more.
double Navigator::left_m(const Leg& leg) const {
  if (leg.brakes) return 0.0;
  const Trajectory& nominal = leg.committed.nominal().trajectory();
  const double left_m =
      (nominal.sample(nominal.duration_s()).position - pursuit_.goal.position_map).norm();
  return left_m > config_.arrival_tolerance_m ? left_m : 0.0;
}

Memory Navigator::memory() const {
  return {.state = state_,
          .newest_id = newest_id_,
          .goal = pursuit_.goal,
          .open = pursuit_.open,
          .reason = said_reason_,
          .legs = schedule_.legs()};
}

Status Navigator::on_goal(const Goal& goal, std::int64_t now_ns) {
  if (!goal.position_map.allFinite() || !std::isfinite(goal.yaw_rad)) {
    return fail(ErrorCode::invalid_input,
                fmt::format("goal {} with yaw {:.3g} is not finite: it is ignored",
                            to_text(goal.position_map), goal.yaw_rad));
  }
  if (!std::isfinite(goal.v_max_m_s) || goal.v_max_m_s < 0.0) {
    return fail(
        ErrorCode::invalid_input,
        fmt::format("goal {} has a speed limit of {:.3g} m/s, which is not 0 or more: it is "
                    "ignored",
                    to_text(goal.position_map), goal.v_max_m_s));
  }
  const bool moves = schedule_.moves(now_ns);
  const auto revoked_ns = pursuit_.revoked_ns;
  pursuit_ = {.goal = goal, .open = true, .lead_s = config_.replan_lead_s, .wait_begin_ns = now_ns};
  if (moves) pursuit_.revoked_ns = revoked_ns.value_or(now_ns);
  if (left_) left_->answers = false;
  drop_open();
  enter(moves ? State::flying : State::planning, now_ns);
  plan(now_ns);
  return success();
}

void Navigator::on_odometry(const RigidBodyState& vehicle, std::int64_t now_ns) {
  vehicle_ = vehicle;
  odometry_ns_ = now_ns;
}

void Navigator::on_tracking(std::uint64_t id, bool follows, std::int64_t now_ns) {
  tracked_ = Tracked{id, now_ns};
  if (follows) {
    if (Leg* leg = schedule_.find(id)) leg->accepted = true;  // an answer, too
    take_up_again(id, now_ns);
  }
  say_what_is_flown(now_ns);
}

void Navigator::tick(std::int64_t now_ns) {
  schedule_.forget_before(now_ns);
  check_pending(now_ns);
  check_open(now_ns);
  check_map_retry(now_ns);
  plan(now_ns);
  check_revoked(now_ns);
  hold_on(now_ns);
  check_arrival(now_ns);
  improve(now_ns);
  say_what_is_flown(now_ns);
}

void Navigator::check_arrival(std::int64_t now_ns) {
  const Leg* leg = schedule_.last();
  if (pursuit_.open || state_ != State::flying || leg == nullptr || now_ns < leg->end_ns()) return;
  const Vec3 end_map = leg->at(leg->end_ns()).position;
  const double distance_m = (vehicle_.position_map - end_map).norm();
  if (odometry_is_fresh(now_ns) && at_rest() && distance_m < config_.arrival_tolerance_m) {
    pursuit_.failures = 0;
    if (leg->stops_early(config_.arrival_tolerance_m)) return rest_before_goal(now_ns);
    const double moved_m = (end_map - pursuit_.goal.position_map).norm();
    return enter(
        State::arrived, now_ns,
        {ErrorCode::ok, moved_m > 1e-3
                            ? fmt::format("{:.3g} m from the goal, as the search moved it", moved_m)
                            : ""});
  }
  if (now_ns - leg->end_ns() < to_ns(config_.settle_timeout_s)) return;
  pursue_again(fail(ErrorCode::tracking_lost,
                    fmt::format("the trajectory has ended, but the vehicle is {:.3g} m from the "
                                "goal or not at rest",
                                distance_m)),
               now_ns);
}

bool Navigator::at_rest() const {
  return vehicle_.velocity_map.norm() < config_.rest_speed_m_s;
}

bool Navigator::odometry_is_fresh(std::int64_t now_ns) const {
  return odometry_ns_ && now_ns - *odometry_ns_ < to_ns(config_.odometry_timeout_s);
}

// As the tracker says, if it does; else as it was committed.
std::uint64_t Navigator::flown_id(std::int64_t now_ns) const {
  if (tracked_ && now_ns - tracked_->ns < to_ns(kTracking_s)) {
    return tracked_->id == lost_id_ ? 0 : tracked_->id;
  }
  const Leg* leg = schedule_.at(now_ns);
  return leg != nullptr ? leg->id() : 0;
}

void Navigator::say_what_is_flown(std::int64_t now_ns) {
  if (flown_id(now_ns) != said_flown_id_) enter(state_, now_ns, said_reason_);
}

void Navigator::enter(State state, std::int64_t now_ns, Error reason) {
  state_ = state;
  said_flown_id_ = flown_id(now_ns);
  said_reason_ = reason;
  orders_.push_back(StateOrder{.state = state,
                               .id = newest_id_,
                               .flown_id = said_flown_id_,
                               .goal_map = pursuit_.goal.position_map,
                               .reason = std::move(reason)});
}

}  // namespace goshawk::navigator
