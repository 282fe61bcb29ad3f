#include "goshawk/guard/guard.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "goshawk/core/free_curve.hpp"
#include "goshawk/core/stop_part.hpp"
#include "polyline.hpp"

namespace goshawk::guard {
namespace {

constexpr std::array kBlends_s{0.2, 0.5, 1.0, 2.0};
constexpr double kLaterStop_s = 0.05;  // a stop that moves by less is not committed again
constexpr double kJoinAhead_s = 0.3;   // a path is joined so far ahead of a vehicle that moves
constexpr double kLongest_s = 3600.0, kShortest_s = 1e-3;

Status check_duration(const Curve& curve) {
  const double duration_s = curve.trajectory.duration_s();
  if (duration_s >= kShortest_s && duration_s <= kLongest_s) return success();
  return fail(ErrorCode::invalid_input, fmt::format("it lasts {:.3g} s; {:g} to {:g} s are allowed",
                                                    duration_s, kShortest_s, kLongest_s));
}

Result<Curve> curve_of_shape(const Plan& plan) {
  if (const auto* spline = std::get_if<Bspline>(&plan.shape)) return curve_of(*spline);
  if (const auto* p = std::get_if<Polynomials>(&plan.shape)) return curve_of(*p);
  return curve_of(std::get<Samples>(plan.shape));
}

// Each is flown until the next begins.
bool is_blocked(const FreeSpace& space, std::span<const CommittedTrajectory> legs,
                std::int64_t now_ns) {
  double until_s = HUGE_VAL;  // from now on
  for (std::size_t i = legs.size(); i-- > 0;) {
    const double start_s = double(legs[i].start_time_ns() - now_ns) * 1e-9;
    const double from_s = std::max(0.0, -start_s), to_s = until_s - start_s;
    if (to_s > from_s && find_obstruction(space, legs[i].flown(), from_s, to_s)) return true;
    until_s = start_s;
  }
  return false;
}

}  // namespace

std::string_view to_string(PlanKind kind) {
  constexpr std::array<std::string_view, 4> kWords{"path", "trajectory", "polynomial", "bspline"};
  return kWords.at(std::size_t(kind));
}

std::string_view to_string(Verdict verdict) {
  constexpr std::array<std::string_view, 4> kWords{"passed", "slowed", "replaced", "refused"};
  return kWords.at(std::size_t(verdict));
}

Guard::Guard(const Config& config, std::unique_ptr<Repair> repair, std::uint64_t first_id)
    : config_(config), repair_(std::move(repair)), space_(config.fly_unknown), next_id_(first_id) {
  if (repair_ == nullptr || first_id == 0) throw std::logic_error("Guard without repair or id");
}

Status Guard::reconfigure(const Config& config) {
  if (auto status = config.limits().check(); !status) return status;
  if (config.fly_unknown != config_.fly_unknown) {
    return fail(ErrorCode::invalid_parameter, "fly_unknown cannot change while the guard runs");
  }
  config_ = config;
  return success();
}

void Guard::set_map(std::shared_ptr<const VoxelGrid> grid, std::int64_t now_ns) {
  space_.set_map(std::move(grid));
  // The tracker has the same map and brakes by itself.
  if (is_blocked(space_, flown_.legs(), now_ns)) flown_.lose();
  move_stop(now_ns);
}

void Guard::on_tracker_answer(std::uint64_t id, const Error& outcome, std::int64_t now_ns) {
  flown_.answer(id, outcome.code == ErrorCode::ok, now_ns);
}

Decision Guard::on_plan(const Plan& plan, std::int64_t now_ns) {
  Decision decision{.plan = ++plans_, .kind = plan.kind};
  const double gap_s = heard_ns_ ? double(now_ns - *heard_ns_) * 1e-9 : HUGE_VAL;
  repeats_ = gap_s <= config_.plan_timeout_s;
  heard_ns_ = now_ns;
  decide(plan, now_ns, decision);
  return decision;
}

Decision Guard::refuse(PlanKind kind, const Error& why, std::int64_t now_ns) {
  heard_ns_ = now_ns;
  return {.plan = ++plans_, .kind = kind, .reason = why};
}

void Guard::note(const Refusal& refusal, Decision& decision) {
  if (decision.reason.code != ErrorCode::ok) return;
  decision.reason = refusal.error;
  decision.place_map = refusal.place_map;
}

Status Guard::check_ready(std::int64_t now_ns) const {
  if (space_.grid() == nullptr) {
    return fail(ErrorCode::no_map,
                "no map has come to check it against; is map_server running, in this domain and "
                "namespace?");
  }
  if (flown_.tracker_is_silent(now_ns)) {
    return fail(ErrorCode::stage_silent,
                fmt::format("the tracker has said nothing for {:g} s, and it is not known where "
                            "the vehicle will be; is the tracker alive, and does odometry come?",
                            kTrackerSilent_s));
  }
  if (!yaw_rad_) {
    return fail(ErrorCode::not_at_start,
                "no odometry has come to take the heading from; is the vehicle alive?");
  }
  return success();
}

void Guard::decide(const Plan& plan, std::int64_t now_ns, Decision& decision) {
  if (auto status = check_ready(now_ns); !status) return note({status.error()}, decision);
  if (const auto* waypoints = std::get_if<Waypoints>(&plan.shape)) {
    return fly_along(*waypoints, now_ns, decision);
  }
  const auto curve = curve_of_shape(plan);
  if (!curve) return note({curve.error()}, decision);
  if (auto status = check_duration(*curve); !status) return note({status.error()}, decision);
  fly(plan, *curve, now_ns, decision);
}

void Guard::fly(const Plan& plan, const Curve& curve, std::int64_t now_ns, Decision& decision) {
  auto found = join_of(plan, curve, now_ns);
  if (const auto* why = std::get_if<Refusal>(&found)) return note(*why, decision);
  const Join& join = std::get<Join>(found);
  if (curve.deviation_m <= config_.follow_within_m) {
    if (take(exactly(curve, join), Verdict::passed, join, decision)) return;
    if (!config_.repair) return;
    if (join.at_rest && take(slowed(curve, join), Verdict::slowed, join, decision)) return;
    for (const double over_s : kBlends_s) {
      if (take(blended(curve, join, over_s), Verdict::replaced, join, decision)) return;
    }
  }
  if (curve.deviation_m > config_.follow_within_m) {
    note({fail(ErrorCode::trajectory_infeasible,
               fmt::format("the smooth curve through its points strays {:.2g} m from the lines "
                           "between them: send points closer together",
                           curve.deviation_m))},
         decision);
  }
  if (config_.repair) take(repaired(curve, join), Verdict::replaced, join, decision);
}

// From the nearest of its points on.
void Guard::fly_along(const Waypoints& waypoints, std::int64_t now_ns, Decision& decision) {
  if (auto status = check(waypoints); !status) return note({status.error()}, decision);
  auto found = join_now(now_ns + std::llround(config_.lead_s * 1e9));
  if (const auto* why = std::get_if<Refusal>(&found)) return note(*why, decision);
  const Join& join = std::get<Join>(found);
  const Polyline path(waypoints.points_map);
  const auto nearest = path.nearest(join.state.position);
  if (nearest.distance_m > config_.join_within_m) {
    return note({fail(ErrorCode::not_at_start,
                      fmt::format("its nearest point is at {} m, {:.2g} m from where the vehicle "
                                  "will be: plan from there",
                                  to_text(nearest.point_map), nearest.distance_m)),
                 nearest.point_map},
                decision);
  }
  const double ahead_m = nearest.distance_m + kJoinAhead_s * join.state.velocity.norm();
  auto points = path.from(nearest, ahead_m);
  points.insert(points.begin(), join.state.position);
  const Outline planned{path.from(nearest, 0.0)};
  take(along(std::move(points), planned, config_.v_max_m_s, join), Verdict::passed, join, decision);
}

// Where it ends matters more than why it is flown otherwise; the sentence says both.
void Guard::add_cut(const Refusal& cut, Decision& decision) {
  const std::string before = decision.reason.message;
  decision.reason = cut.error;
  decision.place_map = cut.place_map;
  if (!before.empty()) decision.reason.message = before + "; then " + cut.error.message;
}

bool Guard::take(Or<Candidate> candidate, Verdict verdict, const Join& join, Decision& decision) {
  if (const auto* why = std::get_if<Refusal>(&candidate)) {
    note(*why, decision);
    return false;
  }
  auto& [nominal, deviation_m, cut] = std::get<Candidate>(candidate);
  const auto found = find_obstruction(space_, nominal.trajectory());
  const Vec3 place = nominal.trajectory().sample(found ? found->time_s : 0.0).position;
  const auto refuse_for = [&decision, place](const Error& why) {
    note({why, place}, decision);
    return false;
  };
  auto stop = latest_stop(nominal, space_, 0.0);
  if (!stop) return refuse_for(stop.error());
  if (found) {
    cut = Refusal{fail(ErrorCode::trajectory_blocked, to_text(*space_.grid(), *found)), place};
  }
  const bool trimmed = stop->has_value();
  auto committed = CommittedTrajectory::make({.id = next_id_,
                                              .nominal = std::move(nominal),
                                              .stop = *std::move(stop),
                                              .start_time_ns = join.start_ns,
                                              .map_version = space_.grid()->version,
                                              .yaw_rad = *yaw_rad_});
  if (!committed) return refuse_for(committed.error());
  if (auto status = check_against(space_, *committed, 0.0); !status) {
    return refuse_for(status.error());
  }
  if (verdict == Verdict::passed) decision.reason = {ErrorCode::ok, ""};
  if (cut) add_cut(*cut, decision);
  decision.verdict = verdict;
  decision.trimmed = trimmed || cut;
  decision.commit_id = next_id_++;
  decision.deviation_m = deviation_m;
  flown_kind_ = decision.kind;
  flown_.add(*committed);
  commits_.push_back({*std::move(committed), flown_kind_});
  return true;
}

// The same nominal part, but as much more of it as the map now shows free.
void Guard::move_stop(std::int64_t now_ns) {
  const CommittedTrajectory* flown = flown_.newest(now_ns);
  if (flown == nullptr || !flown->stop()) return;
  const std::int64_t lead_ns = std::llround(config_.lead_s * 1e9);
  const std::int64_t from_ns = std::max(now_ns + lead_ns, flown->start_time_ns());
  const double from_s = double(from_ns - flown->start_time_ns()) * 1e-9;
  if (from_s >= flown->stop()->after_s) return;  // it brakes, or will before this arrives
  auto later = latest_stop(flown->nominal(), space_, from_s);
  if (!later) return;
  if (*later && (*later)->after_s < flown->stop()->after_s + kLaterStop_s) return;
  auto committed = CommittedTrajectory::make({.id = next_id_,
                                              .nominal = flown->nominal(),
                                              .stop = *std::move(later),
                                              .start_time_ns = flown->start_time_ns(),
                                              .map_version = space_.grid()->version,
                                              .yaw_rad = flown->yaw_rad()});
  if (!committed) return;
  ++next_id_;
  flown_.add(*committed);
  commits_.push_back({*std::move(committed), flown_kind_});
}

std::optional<Error> Guard::check_silence(std::int64_t now_ns) {
  if (!repeats_ || !heard_ns_ || config_.plan_timeout_s == 0.0) return {};
  const double silent_s = double(now_ns - *heard_ns_) * 1e-9;
  const CommittedTrajectory* flown = flown_.newest(now_ns);
  if (silent_s <= config_.plan_timeout_s || flown == nullptr) return {};
  repeats_ = false;
  return fail(ErrorCode::stage_silent,
              fmt::format("no plan has come for {:.2g} s: trajectory {} is flown to its end, where "
                          "the vehicle rests",
                          silent_s, flown->id()));
}

}  // namespace goshawk::guard
