#include "goshawk/navigator/navigator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace goshawk::navigator {
namespace {

std::int64_t to_ns(double s) {
  return std::int64_t(std::llround(s * 1e9));
}

// A moving start's plan must come this long before the switch, so that the tracker has it.
constexpr double kSwitchSlack_s = 0.02;
// Failures that pass by themselves are tried again after this time.
constexpr double kRetryDelay_s = 0.2;

constexpr std::array kPlanningStages{StageRole::path_search, StageRole::corridor_builder,
                                     StageRole::trajectory_optimizer};

// The stage after the last one that answered.
StageRole next_stage(StageRole last) {
  const auto at = std::ranges::find(kPlanningStages, last);
  if (at == kPlanningStages.end()) return kPlanningStages.front();
  return at + 1 == kPlanningStages.end() ? kPlanningStages.back() : *(at + 1);
}

bool passes_by_itself(ErrorCode code) {
  return code == ErrorCode::no_map || code == ErrorCode::deadline_exceeded ||
         code == ErrorCode::stage_silent;
}

}  // namespace

std::string_view to_string(State state) {
  constexpr std::array<std::string_view, 5> names{"idle", "planning", "flying", "arrived",
                                                  "failed"};
  return names.at(std::size_t(state));
}

Navigator::Navigator(const Config& config, std::uint64_t first_id)
    : config_(config), next_id_(first_id), lead_s_(config.replan_lead_s) {}

Status Navigator::reconfigure(const Config& config) {
  ParameterFaults faults;
  describe(config, faults);
  if (auto status = faults.status(); !status) return status;
  if (auto status = check_change(config_, config); !status) return status;
  if (config.replan_lead_s != config_.replan_lead_s) lead_s_ = config.replan_lead_s;
  config_ = config;
  return success();
}

Status Navigator::on_goal(const Vec3& goal_map, double yaw_rad, std::int64_t now_ns) {
  if (!goal_map.allFinite() || !std::isfinite(yaw_rad)) {
    return fail(ErrorCode::invalid_input,
                fmt::format("goal {} with yaw {:.3g} is not finite: it is ignored",
                            to_text(goal_map), yaw_rad));
  }
  goal_ = {goal_map, yaw_rad};
  goal_open_ = true;
  attempts_ = 0;
  retry_ns_ = 0;
  wait_begin_ns_ = now_ns;
  lead_s_ = config_.replan_lead_s;
  drop_open();
  enter(flight_ ? State::flying : State::planning);
  plan(now_ns);
  return success();
}

void Navigator::on_odometry(const RigidBodyState& vehicle, std::int64_t now_ns) {
  vehicle_ = vehicle;
  odometry_ns_ = now_ns;
}

void Navigator::on_trajectory(Commitment candidate, std::int64_t now_ns) {
  if (!open_ || candidate.id != open_->id) return;
  if (open_->switch_ns && now_ns > *open_->switch_ns - to_ns(kSwitchSlack_s)) {
    lead_s_ *= 2.0;
    open_.reset();
    return plan_again(fail(ErrorCode::deadline_exceeded,
                           fmt::format("the plan came too late for the moment it begins at: the "
                                       "next one begins {:.3g} s ahead",
                                       lead_s_)),
                      now_ns);
  }
  candidate.start_time_ns = open_->switch_ns.value_or(now_ns + to_ns(config_.commit_lead_s));
  candidate.yaw_rad = goal_.yaw_rad;
  auto committed = CommittedTrajectory::make(std::move(candidate));
  if (!committed) return give_up(committed.error());
  const std::int64_t end_ns = committed->start_time_ns() + to_ns(committed->flown().duration_s());
  orders_.push_back(*committed);
  flight_ = Flight{*std::move(committed), end_ns, goal_};
  open_.reset();
  goal_open_ = false;
  enter(State::flying);
}

void Navigator::on_report(std::uint64_t id, StageRole stage, const Error& outcome,
                          std::int64_t now_ns) {
  if (stage == StageRole::tracker) {
    if (flight_ && id == flight_->committed.id() && outcome.code != ErrorCode::ok) {
      tracker_failed(outcome, now_ns);
    }
    return;
  }
  if (!open_ || id != open_->id) return;
  if (outcome.code == ErrorCode::ok) {
    open_->last_stage = stage;
  } else {
    const Error reason{outcome.code, fmt::format("{}: {}", to_string(stage), outcome.message)};
    open_.reset();  // it is answered: nothing to drop
    passes_by_itself(outcome.code) ? plan_again(reason, now_ns) : give_up(reason);
  }
}

void Navigator::tick(std::int64_t now_ns) {
  check_silence(now_ns);
  if (goal_open_ && !open_) plan(now_ns);
  check_arrival(now_ns);
}

// Where the next plan begins: on the present trajectory a little ahead, or at rest.
void Navigator::plan(std::int64_t now_ns) {
  if (now_ns < retry_ns_) return;
  const std::int64_t ahead_ns = now_ns + to_ns(lead_s_);
  if (flight_ && ahead_ns < flight_->end_ns) {
    const std::int64_t start_ns = flight_->committed.start_time_ns();
    return ask(start_on(*flight_, std::max(ahead_ns, start_ns)), now_ns);
  }
  // Odometry that was only just discovered, a trajectory that is just ending, a vehicle that brakes
  // by itself: all of these pass.
  if (!odometry_is_fresh(now_ns) || !at_rest()) {
    if (now_ns - wait_begin_ns_ < to_ns(config_.settle_timeout_s)) return;
    return give_up(
        fail(ErrorCode::tracking_lost,
             odometry_is_fresh(now_ns)
                 ? "the vehicle moves without a trajectory and does not come to rest"
                 : "no odometry comes, so there is nowhere to plan from: is the vehicle, or the "
                   "simulator, running?"));
  }
  ask(start_at_rest(), now_ns);
}

Navigator::Start Navigator::start_on(const Flight& flight, std::int64_t time_ns) const {
  const CommittedTrajectory& committed = flight.committed;
  const Trajectory& flown = committed.flown();
  const double t_s = double(time_ns - committed.start_time_ns()) * 1e-9;
  Start start{.state = flown.sample(std::min(t_s, flown.duration_s())),
              .yaw_rad = yaw_of(vehicle_.q_map_base),
              .time_ns = time_ns};
  start.state.jerk.setZero();
  // Without a curve the tracker turns as fast as it can: where to is known, not how far it is.
  if (const auto& curve = committed.yaw_curve()) {
    start.yaw_rad = curve->yaw_rad(t_s);
    start.yaw_rate_rad_s = curve->rate_rad_s(t_s);
  }
  return start;
}

Navigator::Start Navigator::start_at_rest() const {
  const Vec3& here = vehicle_.position_map;
  const bool holds_end =
      flight_ && (here - flight_->goal.position_map).norm() < config_.arrival_tolerance_m;
  return {.state = {.position = holds_end ? flight_->goal.position_map : here},
          .yaw_rad = yaw_of(vehicle_.q_map_base),
          .yaw_rate_rad_s = (vehicle_.q_map_base * vehicle_.angular_velocity_base).z()};
}

void Navigator::ask(const Start& start, std::int64_t now_ns) {
  ++attempts_;
  newest_id_ = next_id_++;
  open_ = Open{.id = newest_id_, .asked_ns = now_ns, .switch_ns = start.time_ns};
  PlanRequest request;
  request.id = open_->id;
  request.stamp_ns = now_ns;
  request.start_time_ns = start.time_ns;
  request.start = start.state;
  request.start_yaw_rad = start.yaw_rad;
  request.start_yaw_rate_rad_s = start.yaw_rate_rad_s;
  request.goal.position = goal_.position_map;
  request.goal_yaw_rad = goal_.yaw_rad;
  request.limits = config_.limits();
  request.deadline_s = config_.plan_timeout_s;
  request.supersedes = std::exchange(dropped_id_, 0);
  request.unknown = config_.unknown;
  orders_.push_back(std::move(request));
  enter(flight_ && now_ns < flight_->end_ns ? State::flying : State::planning);
}

// No answer to the open request is needed any more: the next one says so.
void Navigator::drop_open() {
  if (open_) dropped_id_ = open_->id;
  open_.reset();
}

void Navigator::plan_again(const Error& reason, std::int64_t now_ns) {
  drop_open();
  if (attempts_ >= config_.max_attempts) {
    return give_up({reason.code, fmt::format("{} (after {} attempts)", reason.message, attempts_)});
  }
  retry_ns_ = now_ns + to_ns(kRetryDelay_s);
}

void Navigator::give_up(const Error& reason) {
  drop_open();
  goal_open_ = false;
  enter(State::failed, reason);
}

// The trajectory will not be flown, or not to its end: from where the vehicle comes to rest, the
// goal is planned for anew.
void Navigator::tracker_failed(const Error& reason, std::int64_t now_ns) {
  const Goal goal = goal_open_ ? goal_ : flight_->goal;
  flight_.reset();
  drop_open();
  if (attempts_ >= config_.max_attempts) return give_up(reason);
  goal_ = goal;
  goal_open_ = true;
  wait_begin_ns_ = now_ns;
  retry_ns_ = now_ns + to_ns(kRetryDelay_s);
  enter(State::planning, {reason.code, "tracker: " + reason.message + "; planning again"});
}

void Navigator::check_arrival(std::int64_t now_ns) {
  if (!flight_ || goal_open_ || state_ != State::flying || now_ns < flight_->end_ns) return;
  const double distance_m = (vehicle_.position_map - flight_->goal.position_map).norm();
  if (odometry_is_fresh(now_ns) && at_rest() && distance_m < config_.arrival_tolerance_m) {
    attempts_ = 0;
    return enter(State::arrived);
  }
  if (now_ns - flight_->end_ns < to_ns(config_.settle_timeout_s)) return;
  enter(State::failed, fail(ErrorCode::tracking_lost,
                            fmt::format("the trajectory has ended, but the vehicle is {:.3g} m "
                                        "from the goal or not at rest",
                                        distance_m)));
}

void Navigator::check_silence(std::int64_t now_ns) {
  if (!open_ || now_ns - open_->asked_ns < to_ns(config_.plan_timeout_s)) return;
  plan_again(fail(ErrorCode::stage_silent,
                  fmt::format(
                      "{} did not answer request {} within {:.3g} s: is it running, in this domain "
                      "and namespace?",
                      to_string(next_stage(open_->last_stage)), open_->id, config_.plan_timeout_s)),
             now_ns);
}

bool Navigator::at_rest() const {
  return vehicle_.velocity_map.norm() < config_.rest_speed_m_s;
}

bool Navigator::odometry_is_fresh(std::int64_t now_ns) const {
  return odometry_ns_ && now_ns - *odometry_ns_ < to_ns(config_.odometry_timeout_s);
}

void Navigator::enter(State state, Error reason) {
  state_ = state;
  orders_.push_back(StateOrder{.state = state,
                               .id = newest_id_,
                               .flown_id = flight_ ? flight_->committed.id() : 0,
                               .goal_map = goal_.position_map,
                               .reason = std::move(reason)});
}

}  // namespace goshawk::navigator
