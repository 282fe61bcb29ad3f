#include "goshawk/flight_check/watch.hpp"

#include <algorithm>
#include <limits>
#include <span>
#include <utility>

namespace goshawk::flight_check {

namespace {

using Kind = Finding::Kind;

constexpr double kAfterLanding_s = 1.0;  // how long after its end a leg still counts as flown
constexpr double kAnyClearance = std::numeric_limits<double>::infinity();  // [m]

bool is_worse(const Verdict& a, const Verdict& b) {
  return !b.touched && (a.touched || a.clearance_m < b.clearance_m);
}

/// What is flown if nothing newer comes.
double end_s(const Plan& plan) {
  const auto& last = plan.stop.empty() ? plan.nominal : plan.stop;
  return plan.start_s + (last.empty() ? 0.0 : last.back().t_s);
}

std::span<const Sample> from(const std::vector<Sample>& track, double t_s) {
  const auto first = std::ranges::lower_bound(track, t_s, {}, &Sample::t_s);
  return {first, track.end()};
}

/// The worse verdict on the two parts of a plan, from t_s on. @pre one of them is not over
Result<Verdict> judge_parts(const FlightCheck& check, const Plan& plan, double t_s,
                            double below_m) {
  std::optional<Verdict> worst;
  for (const auto* part : {&plan.nominal, &plan.stop}) {
    const auto left = from(*part, t_s);
    if (left.empty()) continue;
    auto verdict = check.judge(left, below_m);
    if (!verdict) return verdict;
    if (!worst || is_worse(*verdict, *worst)) worst = *std::move(verdict);
  }
  if (worst) return *std::move(worst);
  return fail(ErrorCode::invalid_input, "the plan has no sample to judge: plan again");
}

Error without_map(const MoverVerdict& movers) {
  return fail(
      movers.touched.empty() ? ErrorCode::no_map : ErrorCode::collision,
      "no map came yet: the flight is judged against what moves alone; " + movers.sentence());
}

}  // namespace

void Watch::set_map(FlightCheck check) {
  check_ = std::move(check);
  map_is_new_ = true;
}

void Watch::commit(Plan plan) {
  judge_flown();
  finish_leg();
  newest_id_ = plan.request_id;
  leg_ = Leg{.id = plan.request_id, .end_s = end_s(plan), .flown = {}};
  plan_ = std::move(plan);
  plan_is_judged_ = false;
  if (!check_) {
    findings_.push_back({Kind::planned, newest_id_,
                         fail(ErrorCode::no_map, "no map came yet: the plan is not judged")});
    return;
  }
  auto verdict = judge_parts(*check_, *plan_, -kAnyClearance, kAnyClearance);
  plan_is_judged_ = verdict.ok();
  if (!verdict || verdict->touched) plan_.reset();
  findings_.push_back({Kind::planned, newest_id_, std::move(verdict)});
}

void Watch::commit_unjudged(std::uint64_t request_id, const Error& why) {
  judge_flown();
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
  touching_movers_.clear();
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
  const double t_s = plan_ ? now_s - plan_->start_s : 0.0;
  const bool is_over =
      !plan_ || (from(plan_->nominal, t_s).empty() && from(plan_->stop, t_s).empty());
  if (is_over) return;
  auto verdict = judge_parts(*check_, *plan_, t_s, plan_is_judged_ ? 0.0 : kAnyClearance);
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
  judge_movers(track);
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

// A contact that goes on is told once.
void Watch::judge_movers(std::span<const Sample> track) {
  if (!movers_) return;
  auto verdict = movers_->judge(track);
  if (!verdict) {  // with a map, judge_flown() reports the same
    if (!check_) findings_.push_back({Kind::event, 0, verdict.error()});
    return;
  }
  const bool is_news = std::ranges::any_of(
      verdict->touched, [&](std::uint64_t id) { return !touching_movers_.contains(id); });
  touching_movers_ = {verdict->touched.begin(), verdict->touched.end()};
  if (is_news) {
    findings_.push_back(
        {Kind::mover, newest_id_, fail(ErrorCode::collision, verdict->sentence()), *verdict});
  }
  if (!leg_) return;
  if (leg_->movers) {
    leg_->movers->add(*verdict);
  } else {
    leg_->movers = *std::move(verdict);
  }
}

void Watch::finish_leg() {
  if (!leg_ || (!leg_->flown && !leg_->movers)) return;
  Result<Verdict> outcome =
      leg_->flown ? Result<Verdict>(*leg_->flown) : without_map(*leg_->movers);
  findings_.push_back({Kind::flown, leg_->id, std::move(outcome), leg_->movers});
  leg_.reset();
}

}  // namespace goshawk::flight_check
