#include "goshawk/mission/executor.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace goshawk::mission {
namespace {

using Does = NavigatorNews::Does;

constexpr double kShortLeg_m = 0.3;  // a shorter leg has no heading
constexpr double kSame_m = 1e-6;     // goals come back as they were sent

std::int64_t to_ns(double seconds) {
  return std::llround(seconds * 1e9);
}

}  // namespace

std::string_view to_string(State state) {
  constexpr std::array<std::string_view, 7> words{"none", "flying", "waiting",  "paused",
                                                  "done", "failed", "cancelled"};
  return words.at(std::size_t(state));
}

void Executor::restore(Memory memory, std::int64_t now_ns) {
  mission_ = std::move(memory.mission);
  next_ = memory.next;
  taken_ = memory.taken;
  sent_after_ns_ = newest_ns_ = memory.sent_after_ns;
  if (taken_) asked_ns_ = now_ns;
  if (memory.state == State::waiting) wait_until_ns_ = now_ns + to_ns(waypoint().hold_s);
  enter(memory.state, std::move(memory.reason));
}

Memory Executor::memory() const {
  return {.mission = mission_,
          .state = state_,
          .next = next_,
          .taken = taken_,
          .sent_after_ns = sent_after_ns_,
          .reason = reason_};
}

Status Executor::start(Mission mission, std::int64_t now_ns) {
  if (auto status = check(mission); !status) return status;
  mission_ = std::move(mission);
  next_ = 0;
  fly(now_ns);
  return success();
}

Status Executor::resume(std::int64_t now_ns) {
  if (state_ != State::paused && state_ != State::failed) {
    return fail(ErrorCode::invalid_input,
                state_ == State::none
                    ? std::string("there is no mission to resume")
                    : fmt::format("the mission is not paused: it is {}", to_string(state_)));
  }
  fly(now_ns);
  return success();
}

Status Executor::cancel() {
  if (!is_under_way() && state_ != State::paused && state_ != State::failed) {
    return fail(ErrorCode::invalid_input,
                state_ == State::none
                    ? std::string("there is no mission to cancel")
                    : fmt::format("the mission is not under way: it is {}", to_string(state_)));
  }
  enter(State::cancelled, {ErrorCode::cancelled, "an operator cancelled it before " + place()});
  return success();
}

bool Executor::is_under_way() const {
  return state_ == State::flying || state_ == State::waiting;
}

void Executor::enter(State state, Error reason) {
  state_ = state;
  reason_ = std::move(reason);
  changed_ = true;
}

void Executor::fly(std::int64_t now_ns) {
  taken_ = false;
  asked_ns_.reset();
  wait_until_ns_.reset();
  sent_after_ns_ = newest_ns_;
  enter(State::flying);
  if (vehicle_) send(now_ns);
}

void Executor::send(std::int64_t now_ns) {
  const Vec3 leg_map = waypoint().position_map - vehicle_->position_map;
  const bool has_heading = leg_map.head<2>().norm() > kShortLeg_m;
  const double heading_rad = has_heading ? std::atan2(leg_map.y(), leg_map.x()) : vehicle_->yaw_rad;
  goal_ = Goal{.position_map = waypoint().position_map,
               .yaw_rad = waypoint().yaw_rad.value_or(heading_rad),
               .v_max_m_s = waypoint().v_max_m_s};
  if (!asked_ns_) asked_ns_ = now_ns;
  sent_ns_ = now_ns;
}

void Executor::on_navigator(const NavigatorNews& news, std::int64_t now_ns) {
  newest_ns_ = std::max(newest_ns_, news.stamp_ns);
  const bool open = is_under_way() || state_ == State::paused || state_ == State::failed;
  if (!open || news.stamp_ns <= sent_after_ns_) return;
  if (news.does == Does::held) {
    if (!is_under_way()) return;
    return enter(State::paused,
                 {ErrorCode::cancelled, "an operator holds the vehicle on its way to " + place()});
  }
  if (news.does == Does::idle) {  // it was started anew and knows nothing
    if (taken_ && state_ == State::flying) fly(now_ns);
    return;
  }
  if ((news.goal_map - waypoint().position_map).norm() < kSame_m) {
    return on_own_goal(news, now_ns);
  }
  // Until it has taken ours, it still says how the goal before stands.
  if (!taken_ || !is_under_way() || news.does == Does::failed) return;
  enter(State::paused, {ErrorCode::cancelled, fmt::format("the navigator was given another goal, "
                                                          "{}, on the way to {}",
                                                          to_text(news.goal_map), place())});
}

void Executor::on_own_goal(const NavigatorNews& news, std::int64_t now_ns) {
  if (!taken_) {
    taken_ = true;
    if (state_ == State::flying) enter(State::flying);
  }
  if (state_ == State::waiting) return;
  switch (news.does) {
    case Does::arrived:
      return reached(now_ns);
    case Does::failed:
      if (state_ != State::flying) return;
      return enter(State::failed,
                   {news.reason.code, fmt::format("{}: {}", place(), news.reason.message)});
    default:
      if (state_ != State::flying) enter(State::flying);  // it is pursued after all
  }
}

void Executor::on_vehicle(const Vec3& position_map, double yaw_rad, std::int64_t now_ns) {
  vehicle_ = Vehicle{position_map, yaw_rad};
  if (state_ != State::flying) return;
  if (!asked_ns_) send(now_ns);
  const double distance_m = (position_map - waypoint().position_map).norm();
  if (waypoint().passes() && distance_m <= waypoint().pass_radius_m) reached(now_ns);
}

void Executor::reached(std::int64_t now_ns) {
  if (waypoint().hold_s <= 0.0) return go_on(now_ns);
  wait_until_ns_ = now_ns + to_ns(waypoint().hold_s);
  enter(State::waiting);
}

void Executor::go_on(std::int64_t now_ns) {
  if (next_ + 1 == mission_.waypoints.size()) return enter(State::done);
  ++next_;
  fly(now_ns);
}

void Executor::tick(std::int64_t now_ns) {
  if (state_ == State::waiting && now_ns >= *wait_until_ns_) go_on(now_ns);
  if (state_ == State::flying) repeat(now_ns);
}

void Executor::repeat(std::int64_t now_ns) {
  if (taken_ || !vehicle_) return;
  if (!asked_ns_ || now_ns - sent_ns_ >= to_ns(config_.repeat_s)) send(now_ns);
  if (now_ns - *asked_ns_ < to_ns(config_.silence_s) || reason_.code != ErrorCode::ok) return;
  enter(State::flying,
        {ErrorCode::stage_silent,
         fmt::format("the navigator has not taken {} for {:g} s: is it running, in this domain and "
                     "namespace?",
                     place(), config_.silence_s)});
}

Progress Executor::progress(std::int64_t now_ns) const {
  Progress progress{.state = state_, .reason = reason_};
  if (state_ == State::none) return progress;
  progress.waypoint = next_ + 1;
  progress.position_map = waypoint().position_map;
  if (state_ != State::done) {
    const Vec3 from_map = vehicle_ ? vehicle_->position_map : waypoint().position_map;
    progress.left_m = length_from(mission_, next_, from_map);
  }
  if (state_ == State::waiting) {
    progress.hold_left_s = std::max(0.0, double(*wait_until_ns_ - now_ns) * 1e-9);
  }
  return progress;
}

std::string Executor::place() const {
  return fmt::format("waypoint {} of {} at {}", next_ + 1, mission_.waypoints.size(),
                     to_text(waypoint().position_map));
}

}  // namespace goshawk::mission
