#include "goshawk/flight_check/watch.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace goshawk::flight_check {

namespace {

using Kind = Finding::Kind;

constexpr double kAfterLanding_s = 1.0;  // how long after its end a leg still counts as flown
constexpr double kAnyClearance = std::numeric_limits<double>::infinity();  // [m]

bool is_worse(const Verdict& a, const Verdict& b) {
  return !b.touched && (a.touched || a.clearance_m < b.clearance_m);
}

}  // namespace

void Watch::set_map(FlightCheck check) {
  check_ = std::move(check);
  map_is_new_ = true;
}

void Watch::commit(Plan plan) {
  finish_leg();
  newest_id_ = plan.request_id;
  const double duration_s = plan.track.empty() ? 0.0 : plan.track.back().t_s;
  leg_ = Leg{.id = plan.request_id, .end_s = plan.start_s + duration_s, .flown = {}};
  plan_ = std::move(plan);
  plan_is_judged_ = false;
  if (!check_) {
    findings_.push_back({Kind::planned, newest_id_,
                         fail(ErrorCode::no_map, "no map came yet: the plan is not judged")});
    return;
  }
  auto verdict = check_->judge(plan_->track);
  plan_is_judged_ = verdict.ok();
  if (!verdict || verdict->touched) plan_.reset();
  findings_.push_back({Kind::planned, newest_id_, std::move(verdict)});
}

void Watch::commit_unjudged(std::uint64_t request_id, const Error& why) {
  finish_leg();
  newest_id_ = request_id;
  leg_.reset();
  plan_.reset();
  findings_.push_back({Kind::planned, request_id, why});
}

void Watch::fly(const LiveSample& sample) {
  if (last_) {
    if (const auto event = discontinuity(*last_, sample)) end_track(*event);
  }
  track_.push_back(sample.sample);
  last_ = sample;
}

void Watch::forget_track() {
  judge_flown();
  finish_leg();
  track_.clear();
  last_.reset();
  touching_ = false;
}

void Watch::end_track(const std::string& why) {
  forget_track();
  findings_.push_back({Kind::event, 0,
                       fail(ErrorCode::tracking_lost,
                            why + ": what lies between was not flown, and judging begins anew")});
}

void Watch::tick(double now_s) {
  if (std::exchange(map_is_new_, false)) judge_plan_anew(now_s);
  judge_flown();
  if (leg_ && !track_.empty() && track_.back().t_s > leg_->end_s + kAfterLanding_s) finish_leg();
}

// What is left of the plan, against a newer map. Only news is told.
void Watch::judge_plan_anew(double now_s) {
  if (!plan_) return;
  const auto left = std::ranges::find_if(
      plan_->track, [&](const Sample& s) { return plan_->start_s + s.t_s >= now_s; });
  if (left == plan_->track.end()) return;
  auto verdict = check_->judge({left, plan_->track.end()}, plan_is_judged_ ? 0.0 : kAnyClearance);
  const bool is_news = !plan_is_judged_ || !verdict || verdict->touched;
  plan_is_judged_ = verdict.ok();
  if (!verdict || verdict->touched) plan_.reset();
  if (is_news) findings_.push_back({Kind::planned, newest_id_, std::move(verdict)});
}

// Of a leg, only what is below its smallest clearance matters; without one, only contacts.
double Watch::below_m() const {
  if (!leg_) return 0.0;
  return leg_->flown ? leg_->flown->clearance_m : kAnyClearance;
}

// What was flown since the last time, joined to it without a gap.
void Watch::judge_flown() {
  if (track_.size() < 2) return;
  const auto track = std::exchange(track_, {track_.back()});
  if (!check_) return;
  const auto verdict = check_->judge(track, below_m());
  if (!verdict) {
    findings_.push_back({Kind::event, 0, verdict.error()});
    return;
  }
  if (verdict->touched && !touching_) findings_.push_back({Kind::contact, newest_id_, *verdict});
  touching_ = verdict->touched;
  if (leg_ && (!leg_->flown || is_worse(*verdict, *leg_->flown))) leg_->flown = *verdict;
}

void Watch::finish_leg() {
  if (!leg_ || !leg_->flown) return;
  findings_.push_back({Kind::flown, leg_->id, *leg_->flown});
  leg_.reset();
}

}  // namespace goshawk::flight_check
