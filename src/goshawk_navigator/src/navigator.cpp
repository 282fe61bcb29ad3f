#include "goshawk/navigator/navigator.hpp"

#include <algorithm>
#include <array>
#include <cmath>

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
    return fail(ErrorCode::invalid_input, "goal " + to_text(goal_map) + " with yaw " +
                                              std::to_string(yaw_rad) +
                                              " is not finite: it is ignored");
  }
  goal_ = {goal_map, yaw_rad};
  goal_open_ = true;
  attempts_ = 0;
  retry_ns_ = 0;
  wait_begin_ns_ = now_ns;
  lead_s_ = config_.replan_lead_s;
  open_.reset();
  enter(flight_ ? State::flying : State::planning);
  plan(now_ns);
  return success();
}

void Navigator::on_odometry(const Vec3& position_map, const Vec3& velocity_map,
                            std::int64_t now_ns) {
  position_map_ = position_map;
  velocity_map_ = velocity_map;
  odometry_ns_ = now_ns;
}

void Navigator::on_trajectory(std::uint64_t id, Trajectory trajectory, std::int64_t now_ns) {
  if (!open_ || id != open_->id) return;
  if (open_->switch_ns && now_ns > *open_->switch_ns - to_ns(kSwitchSlack_s)) {
    lead_s_ *= 2.0;
    return plan_again(fail(ErrorCode::deadline_exceeded,
                           "the plan came too late for the moment it begins at: with a lead of " +
                               std::to_string(lead_s_) + " s next"),
                      now_ns);
  }
  const std::int64_t start_ns = open_->switch_ns.value_or(now_ns + to_ns(config_.commit_lead_s));
  const std::int64_t end_ns = start_ns + to_ns(trajectory.duration_s());
  flight_ = Flight{id, std::move(trajectory), start_ns, end_ns, goal_};
  open_.reset();
  goal_open_ = false;
  orders_.push_back(CommitOrder{id, start_ns, goal_.yaw_rad});
  enter(State::flying);
}

void Navigator::on_report(std::uint64_t id, StageRole stage, const Error& outcome,
                          std::int64_t now_ns) {
  if (stage == StageRole::tracker) {
    if (flight_ && id == flight_->id && outcome.code != ErrorCode::ok) {
      tracker_failed(outcome, now_ns);
    }
    return;
  }
  if (!open_ || id != open_->id) return;
  if (outcome.code == ErrorCode::ok) {
    open_->last_stage = stage;
  } else {
    const Error reason{outcome.code, std::string(to_string(stage)) + ": " + outcome.message};
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
    const std::int64_t switch_ns = std::max(ahead_ns, flight_->start_ns);
    const double t_s = double(switch_ns - flight_->start_ns) * 1e-9;
    return ask(flight_->trajectory.sample(std::min(t_s, flight_->trajectory.duration_s())),
               switch_ns, now_ns);
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
  FlatState start;
  const bool holds_end =
      flight_ && (position_map_ - flight_->goal.position_map).norm() < config_.arrival_tolerance_m;
  start.position = holds_end ? flight_->goal.position_map : position_map_;
  ask(start, {}, now_ns);
}

void Navigator::ask(const FlatState& start, std::optional<std::int64_t> switch_ns,
                    std::int64_t now_ns) {
  ++attempts_;
  newest_id_ = next_id_++;
  open_ = Open{.id = newest_id_, .asked_ns = now_ns, .switch_ns = switch_ns};
  FlatState goal;
  goal.position = goal_.position_map;
  FlatState from = start;
  from.jerk.setZero();
  orders_.push_back(
      PlanOrder{open_->id, now_ns, from, goal, goal_.yaw_rad, config_.plan_timeout_s});
  enter(flight_ && now_ns < flight_->end_ns ? State::flying : State::planning);
}

void Navigator::plan_again(const Error& reason, std::int64_t now_ns) {
  open_.reset();
  if (attempts_ >= config_.max_attempts) {
    return give_up(
        {reason.code, reason.message + " (after " + std::to_string(attempts_) + " attempts)"});
  }
  retry_ns_ = now_ns + to_ns(kRetryDelay_s);
}

void Navigator::give_up(const Error& reason) {
  open_.reset();
  goal_open_ = false;
  enter(State::failed, reason);
}

// The trajectory will not be flown, or not to its end: from where the vehicle comes to rest, the
// goal is planned for anew.
void Navigator::tracker_failed(const Error& reason, std::int64_t now_ns) {
  const Goal goal = goal_open_ ? goal_ : flight_->goal;
  flight_.reset();
  open_.reset();
  if (attempts_ >= config_.max_attempts) return give_up(reason);
  goal_ = goal;
  goal_open_ = true;
  wait_begin_ns_ = now_ns;
  retry_ns_ = now_ns + to_ns(kRetryDelay_s);
  enter(State::planning, {reason.code, "tracker: " + reason.message + "; planning again"});
}

void Navigator::check_arrival(std::int64_t now_ns) {
  if (!flight_ || goal_open_ || state_ != State::flying || now_ns < flight_->end_ns) return;
  const double distance_m = (position_map_ - flight_->goal.position_map).norm();
  if (odometry_is_fresh(now_ns) && at_rest() && distance_m < config_.arrival_tolerance_m) {
    attempts_ = 0;
    return enter(State::arrived);
  }
  if (now_ns - flight_->end_ns < to_ns(config_.settle_timeout_s)) return;
  enter(State::failed, fail(ErrorCode::tracking_lost,
                            "the trajectory has ended, but the vehicle is " +
                                std::to_string(distance_m) + " m from the goal or not at rest"));
}

void Navigator::check_silence(std::int64_t now_ns) {
  if (!open_ || now_ns - open_->asked_ns < to_ns(config_.plan_timeout_s)) return;
  plan_again(
      fail(ErrorCode::stage_silent, std::string(to_string(next_stage(open_->last_stage))) +
                                        " did not answer request " + std::to_string(open_->id) +
                                        " within " + std::to_string(config_.plan_timeout_s) +
                                        " s: is it running, in this domain and namespace?"),
      now_ns);
}

bool Navigator::at_rest() const {
  return velocity_map_.norm() < config_.rest_speed_m_s;
}

bool Navigator::odometry_is_fresh(std::int64_t now_ns) const {
  return odometry_ns_ && now_ns - *odometry_ns_ < to_ns(config_.odometry_timeout_s);
}

void Navigator::enter(State state, Error reason) {
  state_ = state;
  orders_.push_back(StateOrder{.state = state,
                               .id = newest_id_,
                               .flown_id = flight_ ? flight_->id : 0,
                               .goal_map = goal_.position_map,
                               .reason = std::move(reason)});
}

}  // namespace goshawk::navigator
