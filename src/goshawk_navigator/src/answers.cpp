// What the navigator does with answers: of the planning stages, of the tracker, and of the map.

#include "goshawk/navigator/answer_check.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "goshawk/core/free_curve.hpp"
#include "goshawk/navigator/navigator.hpp"
#include "times.hpp"

namespace goshawk::navigator {
namespace {

// A failure is believed after this time: a good answer may still come.
constexpr double kDoubt_s = 0.1;
// Failures of trajectories in flight are not added up if one comes so long after the next attempt
// that followed the one before.
constexpr double kApart_s = 1.0;

// About one request; the sentence of its end counts them all.
constexpr int kMostComplaints = 3;

bool plans(StageRole stage) {
  return stage == StageRole::path_search || stage == StageRole::corridor_builder ||
         stage == StageRole::trajectory_optimizer;
}

}  // namespace

void Navigator::on_trajectory(Commitment candidate, std::uint64_t number, std::int64_t now_ns) {
  if (!open_ || candidate.id != open_->request.id) return;
  take_answer(std::move(candidate), number, now_ns);
}

void Navigator::take_answer(Commitment candidate, std::uint64_t number, std::int64_t now_ns) {
  if (open_->improves) return take_improvement(std::move(candidate), number, now_ns);
  const PlanRequest& request = open_->request;
  if (auto status = check_answer(candidate, request, open_->shortfall); !status) {
    return refuse_answer(status.error());
  }
  if (const auto too_late_ns = open_->too_late_ns(); too_late_ns && now_ns > *too_late_ns) {
    return act_on(fail(ErrorCode::deadline_exceeded,
                       fmt::format("the answer to request {} came too late for the moment that it "
                                   "begins at",
                                   request.id)),
                  now_ns);
  }
  if (wait_for_map(candidate, number, now_ns)) return;
  const double lead_s = config_.commit_lead_s + longer_lead_s(pursuit_.failures);
  candidate.start_time_ns = request.start_time_ns.value_or(now_ns + to_ns(lead_s));
  candidate.yaw_rad = pursuit_.goal.yaw_rad;
  const bool rests = !open_->from_motion();
  if (auto status = add_stop(candidate, rests); !status) {
    if (rests && look_along(candidate.nominal.trajectory(), now_ns)) return;
    return act_on(status.error(), now_ns);
  }
  auto committed = CommittedTrajectory::make(std::move(candidate));
  if (!committed) return refuse_answer(committed.error());
  if (map() != nullptr) {
    if (auto status = check_against(space_, *committed, 0.0); !status) {
      if (committed->map_version() >= map()->version) return refuse_answer(status.error());
      return act_on(status.error(), now_ns);  // planned in an older map: it was right to try
    }
  }
  commit(*std::move(committed), open_->shortfall.beyond_m, number, now_ns);
}

// Counted and said; the request stays open, for a good answer may still come.
void Navigator::refuse_answer(const Error& why) {
  on_bad_answer(open_->request.id, why);
  if (open_->refused <= kMostComplaints) orders_.push_back(Complaint{open_->request.id, why});
}

void Navigator::on_bad_answer(std::uint64_t id, const Error& why) {
  if (!open_ || id != open_->request.id) return;
  ++open_->refused;
  open_->why_refused = why.message;
}

// @return whether the answer now waits, or is refused because its map does not come
bool Navigator::wait_for_map(const Commitment& candidate, std::uint64_t number,
                             std::int64_t now_ns) {
  if (map() == nullptr && !config_.require_map) return false;
  if (map() != nullptr && map()->version >= candidate.map_version) return false;
  if (!pending_) {
    pending_ = Pending{candidate, number, now_ns + to_ns(config_.map_wait_s)};
  } else if (pending_->number != number) {  // another one waits already
    refuse_answer(
        fail(ErrorCode::no_map, fmt::format("it was planned in map version {}, which has not come",
                                            candidate.map_version)));
  }
  return true;
}

void Navigator::check_pending(std::int64_t now_ns) {
  if (!pending_ || now_ns < pending_->until_ns) return;
  const std::uint64_t version = pending_->candidate.map_version;
  pending_.reset();
  if (!open_) return;
  act_on(fail(ErrorCode::no_map,
              map() == nullptr
                  ? std::string("no map has come yet on map/voxels, so that no plan can be "
                                "checked: is the map server running?")
                  : fmt::format("the answer was planned in map version {}, but version {} is the "
                                "newest here",
                                version, map()->version)),
         now_ns);
}

void Navigator::commit(CommittedTrajectory committed, double beyond_m, std::uint64_t number,
                       std::int64_t now_ns) {
  orders_.push_back(Commit{committed, number});
  left_.reset();
  schedule_.add({.committed = std::move(committed), .beyond_m = beyond_m});
  drop_open();
  dropped_id_ = 0;
  pursuit_.open = false;
  pursuit_.revoked_ns.reset();
  enter(State::flying, now_ns);
}

void Navigator::on_report(std::uint64_t id, StageRole stage, const Error& outcome,
                          std::int64_t now_ns, const Shortfall& shortfall) {
  if (stage == StageRole::tracker) return on_tracker_report(id, outcome, now_ns);
  if (!open_ || id != open_->request.id || !plans(stage)) return;
  if (outcome.code == ErrorCode::ok) {
    open_->last_stage = stage;
    if (stage == StageRole::path_search) open_->shortfall.goal_moved_m = shortfall.goal_moved_m;
    if (stage == StageRole::corridor_builder) open_->shortfall.beyond_m = shortfall.beyond_m;
    return;
  }
  if (open_->failure) return;
  const Error reason{outcome.code, fmt::format("{}: {}", to_string(stage), outcome.message)};
  const Remedy remedy = remedy_of(reason.code, open_->from_motion());
  const double doubt_s = remedy == Remedy::other_start ? 0.0 : kDoubt_s;
  open_->failure = Failure{reason, now_ns + to_ns(doubt_s)};
  if (remedy == Remedy::other_start) act_on(reason, now_ns);
}

// A trajectory that the tracker did not take leaves what was flown before; one that it has left
// leaves nothing: from where the vehicle comes to rest, the goal is planned for anew.
void Navigator::on_tracker_report(std::uint64_t id, const Error& outcome, std::int64_t now_ns) {
  Leg* leg = schedule_.find(id);
  if (leg == nullptr) return;
  if (outcome.code == ErrorCode::ok) {
    leg->accepted = true;
    return;
  }
  // A later stop that is not taken leaves the earlier one, which leads to the same goal; one that
  // gave way to an even later stop leaves that.
  if (schedule_.drop_later_stop(id)) return say_what_is_flown(now_ns);
  const bool flew = std::ranges::any_of(schedule_.legs(), &Leg::accepted);
  const double apart_s = pause_s(pursuit_.failures) + kApart_s;
  if (flew && now_ns - pursuit_.lost_ns > to_ns(apart_s)) pursuit_.failures = 0;
  pursuit_.lost_ns = now_ns;
  left_ = Left{*leg, now_ns, !pursuit_.open};
  if (leg->accepted) {
    lost_id_ = id;
    schedule_.clear();
  } else {
    schedule_.drop_refused(id);
  }
  pursue_again({outcome.code, "tracker: " + outcome.message}, now_ns);
}

// A tracker that was started again may refuse a trajectory and then take it: it comes twice.
void Navigator::take_up_again(std::uint64_t followed_id, std::int64_t now_ns) {
  if (!left_ || left_->leg.id() != followed_id) return;
  if (now_ns - left_->since_ns < to_ns(kDoubt_s)) return;  // said before it left it
  const Left left = *std::exchange(left_, {});
  lost_id_ = 0;
  schedule_.add(left.leg);
  if (!left.answers) return;
  drop_open();
  pursuit_.open = false;
  enter(State::flying, now_ns);
}

// What was committed for the newest goal will not lead there.
void Navigator::pursue_again(const Error& why, std::int64_t now_ns) {
  if (has_given_up() || state_ == State::idle) return say_what_is_flown(now_ns);
  drop_open();
  if (++pursuit_.failures >= config_.max_attempts) return give_up(why, now_ns);
  reopen(0, now_ns);
  pursuit_.retry_ns = now_ns + to_ns(pause_s(pursuit_.failures));
  enter(schedule_.moves(now_ns) ? State::flying : State::planning, now_ns,
        {why.code, why.message + "; planning again"});
}

void Navigator::on_map(std::shared_ptr<const VoxelGrid> grid, std::int64_t now_ns) {
  space_.set_map(std::move(grid));
  map_changed_ns_ = now_ns;
  if (pending_ && open_ && map()->version >= pending_->candidate.map_version) {
    auto pending = *std::exchange(pending_, {});
    take_answer(std::move(pending.candidate), pending.number, now_ns);
  }
  check_legs(now_ns);
  move_stop(now_ns);
  improve_by_new_map(now_ns);
}

// A goal that failed because of the map is taken up again when the map has changed since.
void Navigator::check_map_retry(std::int64_t now_ns) {
  if (!pursuit_.map_retry || pursuit_.open || now_ns < pursuit_.retry_ns) return;
  if (now_ns > pursuit_.map_retry->until_ns) return pursuit_.map_retry.reset();
  if (!map_changed_ns_ || *map_changed_ns_ <= pursuit_.map_retry->changed_after_ns) return;
  pursuit_.map_retry->changed_after_ns = now_ns;
  pursuit_.open = true;
  pursuit_.failures = 0;
  pursuit_.wait_begin_ns = now_ns;
  plan(now_ns);
  pursuit_.retry_ns = now_ns + to_ns(kRetryDelay_s);
}

// Is what is left of what is flown still free?
void Navigator::check_legs(std::int64_t now_ns) {
  for (const Leg& leg : schedule_.legs()) {
    const std::int64_t from_ns = std::max(now_ns, leg.start_ns());
    const std::int64_t until_ns = schedule_.until_ns(leg);
    if (from_ns >= until_ns) continue;
    const double from_s = double(from_ns - leg.start_ns()) * 1e-9;
    const double to_s = double(until_ns - leg.start_ns()) * 1e-9;
    if (!find_obstruction(space_, leg.committed.flown(), from_s, to_s)) continue;
    if (&leg == schedule_.last() && stop_sooner(now_ns)) return;
    return blocked(check_against(space_, leg.committed, from_s).error(), now_ns);
  }
}

void Navigator::blocked(const Error& why, std::int64_t now_ns) {
  const bool brakes_now = brake(now_ns);
  if (has_given_up() || (brakes() && !brakes_now)) return;
  drop_open();
  reopen(brakes_now ? schedule_.last()->start_ns() : 0, now_ns);
  enter(State::flying, now_ns, {why.code, why.message + "; planning again"});
  plan(now_ns);
}

}  // namespace goshawk::navigator
