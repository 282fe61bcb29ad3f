// How the navigator flies into a world that unfolds: a stop that moves with what is seen, and
// better plans for what is flown.

#include <algorithm>
#include <cmath>

#include "goshawk/core/free_curve.hpp"
#include "goshawk/core/stop_part.hpp"
#include "goshawk/navigator/answer_check.hpp"
#include "goshawk/navigator/navigator.hpp"
#include "times.hpp"

namespace goshawk::navigator {
namespace {

// While a stop part lies ahead, a better plan is asked for this often, and with each map.
constexpr double kAskAgain_s = 0.05;
// Less is not worth a commit.
constexpr double kLaterStop_s = 0.05;
// A plan replaces another if it arrives sooner by this time, and by this share of what is left.
constexpr double kSooner_s = 0.2;
constexpr double kSoonerShare = 0.05;
// Or if it stops later by this time, and arrives hardly later.
constexpr double kMuchLaterStop_s = 0.3;
// From so long before the stop begins, any plan that stops later will do.
constexpr double kUrgent_s = 0.3;
// A plan must come this long before it begins: the tracker's share of the lead.
constexpr double kToTracker_s = 0.03;
constexpr double kSameState = 1e-6;  // [m], [m/s], [m/s^2]

// [s] from full speed to rest
double braking_s(const Limits& limits) {
  const double ramp_s = limits.j_max_m_s3 > 0.0 ? limits.a_max_m_s2 / limits.j_max_m_s3 : 0.0;
  return limits.v_max_m_s / limits.a_max_m_s2 + ramp_s;
}

// [ns] when a leg leaves its nominal part, ends, or begins to brake for its horizon
std::int64_t stop_ns(const Leg& leg) {
  const CertifiedTrajectory& nominal = leg.committed.nominal();
  double after_s = nominal.duration_s();
  if (leg.beyond_m > 0.0) after_s -= braking_s(nominal.limits());
  if (leg.committed.stop()) after_s = std::min(after_s, leg.committed.stop()->after_s);
  return leg.start_ns() + to_ns(after_s);
}

// [ns] when its plan gets to the goal; beyond its horizon at full speed
std::int64_t arrival_ns(const Leg& leg) {
  const CertifiedTrajectory& nominal = leg.committed.nominal();
  const double beyond_s = leg.beyond_m / nominal.limits().v_max_m_s;
  return leg.start_ns() + to_ns(nominal.duration_s() + beyond_s);
}

}  // namespace

// What is flown leads to the goal, but will stop before it unless more is seen, or planned.
bool Navigator::approaches() const {
  const Leg* leg = schedule_.last();
  return space_.asks_for_known() && state_ == State::flying && !pursuit_.open && leg != nullptr &&
         !leg->brakes && (leg->committed.stop() || leg->beyond_m > 0.0);
}

// @return trajectory_blocked: no stop fits, or from rest none that leads anywhere
Status Navigator::add_stop(Commitment& candidate, bool from_rest) const {
  if (!space_.asks_for_known()) return success();
  auto stop = latest_stop(candidate.nominal, space_, 0.0);
  if (!stop) return stop.error();
  if (*stop && from_rest) {
    const Trajectory& way = (*stop)->trajectory.trajectory();
    const Vec3 moved =
        way.sample(way.duration_s()).position - candidate.nominal.trajectory().sample(0.0).position;
    if (moved.norm() < config_.arrival_tolerance_m) {
      return fail(ErrorCode::trajectory_blocked,
                  "the plan leads at once into space that was never seen: look there, or choose "
                  "another goal");
    }
  }
  candidate.stop = *std::move(stop);
  candidate.map_version = map()->version;
  return success();
}

// The same nominal part, but as much more of it as has been seen by now.
void Navigator::move_stop(std::int64_t now_ns) {
  if (!approaches()) return;
  const CommittedTrajectory& flown = schedule_.last()->committed;
  if (!flown.stop()) return;
  const std::int64_t from_ns =
      std::max(now_ns + to_ns(config_.commit_lead_s), flown.start_time_ns());
  const double from_s = double(from_ns - flown.start_time_ns()) * 1e-9;
  if (from_s >= flown.stop()->after_s) return;  // the vehicle brakes, or will before this arrives
  auto later = latest_stop(flown.nominal(), space_, from_s);
  if (!later) return;
  if (*later && (*later)->after_s < flown.stop()->after_s + kLaterStop_s) return;
  commit_stop(*std::move(later));
}

// An obstacle was found before what is flown stops: it goes on as far as it is free, as the tracker
// does by itself. @return whether a stop fits
bool Navigator::stop_sooner(std::int64_t now_ns) {
  if (!approaches()) return false;
  const CommittedTrajectory& flown = schedule_.last()->committed;
  if (!flown.stop()) return false;
  const std::int64_t from_ns = std::max(now_ns, flown.start_time_ns());
  const double from_s = double(from_ns - flown.start_time_ns()) * 1e-9;
  if (from_s >= flown.stop()->after_s) return false;
  auto sooner = latest_stop(flown.nominal(), space_, from_s);
  if (!sooner || !*sooner) return false;
  commit_stop(*std::move(sooner));
  // Another plan is needed at once: the one that is awaited does not know of the obstacle.
  if (open_ && open_->improves) drop_open();
  improve_ns_ = now_ns;
  return true;
}

// The nominal part that is flown, with another stop part.
void Navigator::commit_stop(std::optional<StopPart> stop) {
  const Leg& leg = *schedule_.last();
  const CommittedTrajectory& flown = leg.committed;
  auto committed = CommittedTrajectory::make({.id = next_id_++,
                                              .nominal = flown.nominal(),
                                              .stop = std::move(stop),
                                              .start_time_ns = flown.start_time_ns(),
                                              .map_version = map()->version,
                                              .yaw_rad = flown.yaw_rad(),
                                              .yaw_curve = flown.yaw_curve()});
  if (!committed) return;
  orders_.push_back(Commit{*committed, 0, flown.id()});
  schedule_.add({.committed = *std::move(committed), .beyond_m = leg.beyond_m, .continues = true});
}

double Navigator::improvement_lead_s() const {
  return std::min(config_.replan_lead_s, 1.5 * latency_s_ + kToTracker_s);
}

// Asks for a better plan than what is flown. The newest request replaces one that takes too long.
void Navigator::improve(std::int64_t now_ns) {
  if (!approaches() || !schedule_.moves(now_ns) || now_ns < improve_ns_) return;
  if (open_) {
    if (!open_->improves || now_ns - open_->asked_ns < to_ns(2.0 * latency_s_)) return;
    drop_open();
  }
  improve_ns_ = now_ns + to_ns(kAskAgain_s);
  const std::int64_t begin_ns = free_for_planning_from(
      std::max(now_ns + to_ns(improvement_lead_s()), schedule_.legs().front().start_ns()));
  if (begin_ns >= schedule_.end_ns()) return;  // it will be planned for from rest
  open(start_at(begin_ns), next_id_++, now_ns);
  open_->improves = true;
}

// At once, and not when the next plan is due. A plan that is awaited, and was asked for before this
// map came, is superseded; but not twice in a row, so that maps that come faster than plans do not
// keep all of them from being made.
void Navigator::improve_by_new_map(std::int64_t now_ns) {
  if (open_ && open_->improves && !pending_ && !superseded_by_map_) {
    drop_open();
    superseded_by_map_ = true;
  }
  if (!open_) improve_ns_ = now_ns;
  improve(now_ns);
}

void Navigator::take_improvement(Commitment candidate, std::uint64_t number, std::int64_t now_ns) {
  const Open asked = *std::exchange(open_, {});
  superseded_by_map_ = false;
  latency_s_ =
      std::clamp(double(now_ns - asked.asked_ns) * 1e-9, 0.9 * latency_s_, config_.replan_lead_s);
  const PlanRequest& request = asked.request;
  if (auto status = check_answer(candidate, request, asked.shortfall); !status) {
    orders_.push_back(Complaint{request.id, status.error()});
    return;
  }
  if (now_ns > *asked.too_late_ns() || map()->version < candidate.map_version) return;
  // What is flown then may have changed since it was asked.
  const FlatState then = start_at(*request.start_time_ns).state;
  if (!(largest_difference(then, request.start) <= kSameState)) return;
  candidate.start_time_ns = *request.start_time_ns;
  candidate.yaw_rad = pursuit_.goal.yaw_rad;
  if (!add_stop(candidate, false)) return;
  auto committed = CommittedTrajectory::make(std::move(candidate));
  if (!committed || !check_against(space_, *committed, 0.0)) return;
  const double beyond_m = asked.shortfall.beyond_m;
  if (!is_better({.committed = *committed, .beyond_m = beyond_m}, now_ns)) return;
  newest_id_ = request.id;
  commit(*std::move(committed), beyond_m, number, now_ns);
}

// A plan that is hardly better is not worth the change: two that are as good would alternate.
bool Navigator::is_better(const Leg& other, std::int64_t now_ns) const {
  const Leg& flown = *schedule_.last();
  const double from_s = double(now_ns - flown.start_ns()) * 1e-9;
  const Trajectory& nominal = flown.committed.nominal().trajectory();
  const bool dead = find_obstruction(*map(), nominal, from_s, nominal.duration_s()).has_value();
  const double later_stop_s = double(stop_ns(other) - stop_ns(flown)) * 1e-9;
  const double sooner_s = double(arrival_ns(flown) - arrival_ns(other)) * 1e-9;
  const double left_s = double(arrival_ns(flown) - now_ns) * 1e-9;
  const bool arrives = !other.committed.stop() && other.beyond_m == 0.0;
  if (dead || (arrives && sooner_s > -kSooner_s)) return true;
  const double soon_s = improvement_lead_s() + kUrgent_s;
  if (double(stop_ns(flown) - now_ns) * 1e-9 < soon_s) return later_stop_s > kLaterStop_s;
  if (later_stop_s > kMuchLaterStop_s && sooner_s > -kSooner_s) return true;
  const bool stops_soon = double(stop_ns(other) - now_ns) * 1e-9 < soon_s;
  return !stops_soon && sooner_s > std::max(kSooner_s, kSoonerShare * left_s);
}

// The stop part was flown to its end.
void Navigator::rest_before_goal(std::int64_t now_ns) {
  drop_open();
  reopen(0, now_ns);
  pursuit_.retry_ns = now_ns;
  plan(now_ns);
}

}  // namespace goshawk::navigator
