// How the navigator asks for plans, and what it does when one fails.

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "goshawk/core/brake.hpp"
#include "goshawk/core/free_curve.hpp"
#include "goshawk/navigator/navigator.hpp"
#include "times.hpp"

namespace goshawk::navigator {
namespace {

// A plan that begins in flight must come this long before, so that the tracker has it.
constexpr double kSwitchSlack_s = 0.02;

// Of the time at which a plan may begin.
constexpr double kSearchStep_s = 0.02;

// A stage may have planned in a map that is older than the newest by so much.
constexpr double kMapDelay_s = 1.0;
// A tracker that was heard is started again within this time.
constexpr double kTrackerBack_s = 60.0;
// A revoked goal is flown to for no more leads than these.
constexpr double kMostLeads = 3.0;

constexpr std::array kPlanningStages{StageRole::path_search, StageRole::corridor_builder,
                                     StageRole::trajectory_optimizer};

// The stage after the last one that answered.
StageRole next_stage(StageRole last) {
  const auto at = std::ranges::find(kPlanningStages, last);
  if (at == kPlanningStages.end()) return kPlanningStages.front();
  return at + 1 == kPlanningStages.end() ? kPlanningStages.back() : *(at + 1);
}

}  // namespace

std::optional<std::int64_t> Navigator::Open::too_late_ns() const {
  if (!request.start_time_ns) return {};
  return *request.start_time_ns - to_ns(kSwitchSlack_s);
}

// Where the next plan begins: a little ahead on what is flown, or at rest.
void Navigator::plan(std::int64_t now_ns) {
  if (!pursuit_.open || open_ || now_ns < pursuit_.retry_ns) return;
  if (schedule_.moves(now_ns) && odometry_ns_) return ask(start_in_flight(now_ns), now_ns);
  // Odometry that was only just discovered, a trajectory that is just ending, a vehicle that brakes
  // by itself: all of these pass.
  if (odometry_is_fresh(now_ns) && at_rest()) {
    if (!leave_blocked_place(now_ns)) return ask(start_at_rest(now_ns), now_ns);
    return ask(start_in_flight(now_ns), now_ns);
  }
  if (odometry_is_fresh(now_ns) && waits_for_tracker(now_ns)) return;
  const std::int64_t begin_ns = std::max(pursuit_.wait_begin_ns, pursuit_.settle_begin_ns);
  if (now_ns - begin_ns < to_ns(config_.settle_timeout_s)) return;
  give_up(why_it_does_not_rest(now_ns), now_ns);
}

Error Navigator::why_it_does_not_rest(std::int64_t now_ns) const {
  if (!odometry_is_fresh(now_ns)) {
    return fail(ErrorCode::tracking_lost,
                "no odometry comes, so there is nowhere to plan from: is the vehicle, or the "
                "simulator, running?");
  }
  if (tracker_is_silent(now_ns)) {
    return fail(ErrorCode::stage_silent,
                "the tracker is silent, and the vehicle flies by its own failsafe: is the tracker "
                "running?");
  }
  return fail(ErrorCode::tracking_lost,
              "the vehicle moves without a trajectory and does not come to rest");
}

bool Navigator::tracker_is_silent(std::int64_t now_ns) const {
  return tracked_ && now_ns - tracked_->ns >= to_ns(kTracking_s);
}

// A vehicle whose tracker is silent is flown by its own failsafe, at last down to the ground. It
// settles once a tracker is back.
bool Navigator::waits_for_tracker(std::int64_t now_ns) {
  if (!tracker_is_silent(now_ns) || now_ns - pursuit_.wait_begin_ns >= to_ns(kTrackerBack_s)) {
    return false;
  }
  pursuit_.settle_begin_ns = now_ns;
  return true;
}

Navigator::Start Navigator::start_in_flight(std::int64_t now_ns) const {
  return start_at(
      free_for_planning_from(std::max({now_ns + to_ns(pursuit_.lead_s), pursuit_.not_before_ns,
                                       schedule_.legs().front().start_ns()})));
}

// What is flown may lead through voxels that the map learnt late: free for flying, but no plan may
// begin there. @return the first moment from then on at which one may; if there is none, that one
std::int64_t Navigator::free_for_planning_from(std::int64_t time_ns) const {
  if (!space_.asks_for_known() || map()->raw.empty()) return time_ns;
  const auto is_free = [this](std::int64_t at_ns) {
    const auto voxel = map()->geometry.index_of(schedule_.at(at_ns)->at(at_ns).position);
    return voxel && !map()->grown.get(*voxel);
  };
  for (std::int64_t at_ns = time_ns; at_ns < schedule_.end_ns(); at_ns += to_ns(kSearchStep_s)) {
    if (is_free(at_ns)) return at_ns;
  }
  return is_free(schedule_.end_ns()) ? std::max(time_ns, schedule_.end_ns()) : time_ns;
}

// On what will be flown then. @pre not before the first leg
Navigator::Start Navigator::start_at(std::int64_t time_ns) const {
  const Leg& leg = *schedule_.at(time_ns);
  Start start{.state = leg.at(time_ns), .yaw_rad = yaw_of(vehicle_.q_map_base), .time_ns = time_ns};
  start.state.jerk.setZero();
  if (time_ns >= leg.end_ns()) start.state = {.position = start.state.position};
  // Without a curve the tracker turns as fast as it can: where to is known, not how far it is.
  if (const auto& curve = leg.committed.yaw_curve()) {
    const double t_s = double(time_ns - leg.start_ns()) * 1e-9;
    start.yaw_rad = curve->yaw_rad(t_s);
    start.yaw_rate_rad_s = curve->rate_rad_s(t_s);
  }
  return start;
}

Navigator::Start Navigator::start_at_rest(std::int64_t now_ns) const {
  const Vec3& here = vehicle_.position_map;
  const Leg* leg = schedule_.at(now_ns);
  const Vec3 end = leg != nullptr ? leg->at(leg->end_ns()).position : here;
  const bool holds_end = (here - end).norm() < config_.arrival_tolerance_m;
  return {.state = {.position = holds_end ? end : here},
          .yaw_rad = yaw_of(vehicle_.q_map_base),
          .yaw_rate_rad_s = (vehicle_.q_map_base * vehicle_.angular_velocity_base).z()};
}

// The parameters', or the goal's own speed limit if that is lower.
Limits Navigator::limits_from(const Start& start) const {
  Limits limits = start.time_ns ? config_.limits_in_flight() : config_.limits();
  const double own_m_s = pursuit_.goal.v_max_m_s;
  if (own_m_s <= 0.0) return limits;
  limits.v_max_m_s = std::min(limits.v_max_m_s, own_m_s);
  if (limits.v_max_vertical_m_s > 0.0) {
    limits.v_max_vertical_m_s = std::min(limits.v_max_vertical_m_s, own_m_s);
  }
  return limits;
}

void Navigator::ask(const Start& start, std::int64_t now_ns) {
  newest_id_ = next_id_++;
  open(start, newest_id_, now_ns);
  enter(schedule_.moves(now_ns) ? State::flying : State::planning, now_ns);
}

void Navigator::open(const Start& start, std::uint64_t id, std::int64_t now_ns) {
  PlanRequest request;
  request.id = id;
  request.stamp_ns = now_ns;
  request.start_time_ns = start.time_ns;
  request.start = start.state;
  request.start_yaw_rad = start.yaw_rad;
  request.start_yaw_rate_rad_s = start.yaw_rate_rad_s;
  request.goal.position = pursuit_.goal.position_map;
  request.goal_yaw_rad = pursuit_.goal.yaw_rad;
  request.limits = limits_from(start);
  request.deadline_s = config_.plan_timeout_s;
  request.supersedes = std::exchange(dropped_id_, 0);
  request.unknown = config_.unknown;
  open_ = Open{.request = request, .asked_ns = now_ns};
  if (const auto too_late_ns = open_->too_late_ns()) {
    const double left_s = double(*too_late_ns - now_ns) * 1e-9;
    request.deadline_s = std::min(request.deadline_s, std::max(left_s, 1e-3));
  }
  orders_.push_back(std::move(request));
}

// No answer to the open request is needed any more: the next one says so.
void Navigator::drop_open() {
  if (open_ && !open_->failure) dropped_id_ = open_->request.id;
  open_.reset();
  pending_.reset();
}

void Navigator::check_open(std::int64_t now_ns) {
  if (!open_) return;
  if (open_->failure) {
    if (now_ns < open_->failure->act_ns) return;
    const Error reason = open_->failure->reason;
    return act_on(reason, now_ns);
  }
  const std::uint64_t id = open_->request.id;
  const std::string refused = open_->refused == 0
                                  ? ""
                                  : fmt::format("; {} answers were refused, the last because {}",
                                                open_->refused, open_->why_refused);
  const auto stage = to_string(next_stage(open_->last_stage));
  if (const auto too_late_ns = open_->too_late_ns(); too_late_ns && now_ns > *too_late_ns) {
    return act_on(fail(ErrorCode::deadline_exceeded,
                       fmt::format("{} did not answer request {} before the moment that it begins "
                                   "at{}",
                                   stage, id, refused)),
                  now_ns);
  }
  if (now_ns - open_->asked_ns < to_ns(config_.plan_timeout_s)) return;
  act_on(fail(ErrorCode::stage_silent,
              fmt::format("{} did not answer request {} within {:.3g} s: is it running, in this "
                          "domain and namespace?{}",
                          stage, id, config_.plan_timeout_s, refused)),
         now_ns);
}

// The open request has failed.
void Navigator::act_on(const Error& reason, std::int64_t now_ns) {
  const bool late = reason.code == ErrorCode::deadline_exceeded;
  const bool from_motion = open_->from_motion();
  const std::int64_t asked_ns = open_->asked_ns;
  const Remedy remedy = remedy_of(reason.code, from_motion);
  const bool improves = open_->improves;
  drop_open();
  if (late && improves) latency_s_ = std::min(2.0 * latency_s_, config_.replan_lead_s);
  if (improves) {
    superseded_by_map_ = false;
    return;  // the next map, or the next moment, asks again
  }
  if (remedy == Remedy::other_start || (late && from_motion)) {
    return try_other_start(reason, now_ns);
  }
  if (remedy == Remedy::wait) {
    return plan_again(reason, late ? 0.0 : kRetryDelay_s, now_ns);
  }
  if (remedy == Remedy::other_map) wait_for_other_map(asked_ns, now_ns);
  give_up(reason, now_ns);
}

void Navigator::wait_for_other_map(std::int64_t asked_ns, std::int64_t now_ns) {
  if (pursuit_.map_retry) return;
  pursuit_.map_retry = MapRetry{.until_ns = now_ns + to_ns(config_.map_retry_s),
                                .changed_after_ns = asked_ns - to_ns(kMapDelay_s)};
}

// In flight: a later start, then a slower one, then one at rest.
void Navigator::try_other_start(const Error& reason, std::int64_t now_ns) {
  ++pursuit_.starts;
  enter(State::flying, now_ns, {ErrorCode::ok, "planning from a later start: " + reason.message});
  if (pursuit_.starts == 1) {
    pursuit_.lead_s *= 2.0;
  } else if (brakes()) {
    pursuit_.not_before_ns = schedule_.end_ns();
  } else if (brake(now_ns)) {
    const Leg& leg = *schedule_.last();
    pursuit_.not_before_ns = leg.start_ns() + (leg.end_ns() - leg.start_ns()) / 2;
  } else {
    pursuit_.starts = 0;
    pursuit_.lead_s = config_.replan_lead_s;
    pursuit_.retry_ns = now_ns + to_ns(kBrakeAgain_s);
  }
  plan(now_ns);
}

void Navigator::plan_again(const Error& reason, double delay_s, std::int64_t now_ns) {
  drop_open();
  if (++pursuit_.failures >= config_.max_attempts) {
    if (depends_on_map(reason.code)) wait_for_other_map(now_ns, now_ns);
    return give_up(
        {reason.code, fmt::format("{} (after {} attempts)", reason.message, pursuit_.failures)},
        now_ns);
  }
  pursuit_.retry_ns = now_ns + to_ns(delay_s);
  plan(now_ns);
}

// What was committed does not lead to the goal: it is planned for again.
void Navigator::reopen(std::int64_t not_before_ns, std::int64_t now_ns) {
  pursuit_.open = true;
  pursuit_.starts = 0;
  pursuit_.not_before_ns = not_before_ns;
  pursuit_.wait_begin_ns = now_ns;
}

void Navigator::give_up(const Error& reason, std::int64_t now_ns) {
  drop_open();
  pursuit_.open = false;
  pursuit_.revoked_ns.reset();
  enter(State::failed, now_ns, reason);
}

// On what is flown; nothing if there is none, or what is flown is one already.
std::optional<CommittedTrajectory> Navigator::way_to_rest(std::int64_t now_ns) {
  const std::int64_t begin_ns = now_ns + to_ns(config_.commit_lead_s);
  const Leg* leg = schedule_.at(begin_ns);
  if (leg == nullptr || leg->brakes || begin_ns >= leg->end_ns()) return {};
  const double from_s = double(begin_ns - leg->start_ns()) * 1e-9;
  auto way = brake_along(leg->committed, from_s, [this](const Trajectory& trajectory) {
    return map() == nullptr || !find_obstruction(space_, trajectory);
  });
  if (!way) return {};
  const double yaw_rad = leg->committed.yaw_at(from_s + way->duration_s() / 2.0);
  auto committed = CommittedTrajectory::make({.id = next_id_++,
                                              .nominal = *std::move(way),
                                              .start_time_ns = begin_ns,
                                              .map_version = leg->committed.map_version(),
                                              .yaw_rad = yaw_rad});
  if (!committed) return {};
  return *std::move(committed);
}

void Navigator::brake_by(CommittedTrajectory way) {
  orders_.push_back(Commit{way, 0});
  schedule_.add({.committed = std::move(way), .brakes = true});
}

// Commits a way to rest on what is flown. @return whether there is one
bool Navigator::brake(std::int64_t now_ns) {
  auto way = way_to_rest(now_ns);
  if (way) brake_by(*std::move(way));
  return way.has_value();
}

// However planning goes, the vehicle does not fly on to a goal that was revoked.
void Navigator::check_revoked(std::int64_t now_ns) {
  if (!pursuit_.open || !pursuit_.revoked_ns || brakes() || !schedule_.moves(now_ns)) return;
  if (now_ns - *pursuit_.revoked_ns < to_ns(kMostLeads * config_.replan_lead_s)) return;
  if (!brake(now_ns)) return;
  drop_open();
  plan(now_ns);
}

}  // namespace goshawk::navigator
