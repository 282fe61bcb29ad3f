#include <algorithm>

#include "goshawk/conversions/status.hpp"
#include "goshawk/conversions/vehicle.hpp"
#include "goshawk/navigator/navigator.hpp"
#include "goshawk/runtime/component.hpp"
#include "goshawk/stage/intake.hpp"
#include "goshawk/stage/life_sign.hpp"
#include "goshawk/stage/map_subscription.hpp"
#include "goshawk/stage/operator_desk.hpp"
#include "kept_answers.hpp"
#include "memory_file.hpp"
#include "operator_answers.hpp"

namespace goshawk::navigator {
namespace {

using namespace goshawk::runtime;
using namespace goshawk::stage;
namespace msg = goshawk_msgs::msg;

// Milliseconds since 1970: requests of a restarted navigator never repeat an id. In simulated time
// there may be no time yet; a simulation begins anew with its navigator.
std::uint64_t first_id(std::int64_t now_ns) {
  return std::max<std::uint64_t>(1, std::uint64_t(now_ns / 1'000'000));
}

std::uint8_t to_msg(State state) {
  namespace constants = goshawk_msgs::msg::NavigatorState_Constants;
  static_assert(std::uint8_t(State::idle) == constants::STATE_IDLE &&
                std::uint8_t(State::planning) == constants::STATE_PLANNING &&
                std::uint8_t(State::flying) == constants::STATE_FLYING &&
                std::uint8_t(State::arrived) == constants::STATE_ARRIVED &&
                std::uint8_t(State::failed) == constants::STATE_FAILED &&
                std::uint8_t(State::held) == constants::STATE_HELD);
  return std::uint8_t(state);
}

/// What the navigator plans by itself, for those who read who planned.
constexpr const char* kBrakeName = "navigator_brake";

Shortfall shortfall_of(const msg::StageReport& m) {
  Shortfall shortfall;
  for (const auto& counter : m.counters()) {
    if (!(counter.value() >= 0.0) || !std::isfinite(counter.value())) continue;
    if (counter.name() == "goal_moved_m") shortfall.goal_moved_m = counter.value();
    if (counter.name() == "beyond_m") shortfall.beyond_m = counter.value();
  }
  return shortfall;
}

/// The same trajectory, by another clock.
Result<CommittedTrajectory> begun_at(const CommittedTrajectory& committed, std::int64_t start_ns) {
  return CommittedTrajectory::make({.id = committed.id(),
                                    .nominal = committed.nominal(),
                                    .stop = committed.stop(),
                                    .start_time_ns = start_ns,
                                    .map_version = committed.map_version(),
                                    .yaw_rad = committed.yaw_rad(),
                                    .yaw_curve = committed.yaw_curve()});
}

/// A report can end a request, so it is heard from one process for each stage of the plan and for
/// the tracker. @return 0: anybody's
std::uint8_t reporting_stage(const msg::StageReport& m) {
  namespace constants = msg::StageReport_Constants;
  const bool decides =
      m.stage() == constants::STAGE_PATH_SEARCH || m.stage() == constants::STAGE_CORRIDOR_BUILDER ||
      m.stage() == constants::STAGE_TRAJECTORY_OPTIMIZER || m.stage() == constants::STAGE_TRACKER;
  return decides ? m.stage() : std::uint8_t{0};
}

/// goal_pose, goal, operator_command, odom, trajectory, stage_report, tracking_state, map/voxels ->
/// plan_request, committed_trajectory, navigator_state, navigator_alive, operator_answer. Counts on
/// the monotonic clock; messages carry the wall clock's.
class NavigatorComponent : public Component {
 public:
  explicit NavigatorComponent(Node& node)
      : node_(node),
        config_(node.parameters<Config>([this](const Config& c) { return reconfigure(c); })),
        navigator_(config_, first_id(node.now_ns())),
        reporter_(node, StageRole::navigator, "navigator"),
        desk_(node, reporter_),
        requests_(node.advertise<msg::PlanRequest>("plan_request", Qos::reliable_last())),
        commits_(node.advertise<msg::CommittedTrajectory>("committed_trajectory", Qos::latched())),
        states_(node.advertise<msg::NavigatorState>("navigator_state", Qos::latched(20))),
        life_sign_(node, reporter_, state_message_),
        map_(node, reporter_, [this](const auto& grid) {
          navigator_.on_map(grid, node_.monotonic_ns());
          carry_out();
        }) {
    subscribe();
    node.every(0.02, [this] {
      if (!resumed_) resume();
      navigator_.tick(node_.monotonic_ns());
      carry_out();
    });
    if (config_.memory_file.empty()) publish(StateOrder{});
    if (config_.memory_file.empty() || node.monotonic_ns() > 0) resume();
    reporter_.ready("waits for a goal on goal_pose");
  }

 private:
  Status reconfigure(const Config& config) {
    if (auto status = navigator_.reconfigure(config); !status) return status;
    config_ = config;
    return success();
  }

  void subscribe() {
    node_.subscribe<geometry_msgs::msg::PoseStamped>(
        "goal_pose", Qos::reliable_last(),
        [this](const geometry_msgs::msg::PoseStamped& m, const MessageInfo&) {
          const auto pose = conversions::from_msg(m);
          on_goal(pose ? Result<Goal>(Goal{pose->position_map, pose->yaw_rad}) : pose.error());
        });
    node_.subscribe<msg::Goal>(
        "goal", Qos::reliable_last(),
        [this](const msg::Goal& m, const MessageInfo&) { on_goal(goal_of(m)); });
    node_.subscribe<msg::OperatorCommand>(
        "operator_command", Qos::reliable_last(),
        [this](const msg::OperatorCommand& m, const MessageInfo&) { on_command(m); });
    node_.subscribe<nav_msgs::msg::Odometry>(
        "odom", Qos::best_effort(),
        [this](const nav_msgs::msg::Odometry& m, const MessageInfo&) {
          const auto state = conversions::from_msg(m);
          if (!state) return;  // the tracker reports bad odometry
          navigator_.on_odometry(*state, node_.monotonic_ns());
        },
        Writers::one("odom"));
    node_.subscribe<msg::BezierTrajectory>(
        "trajectory", Qos::reliable_last(),
        [this](const msg::BezierTrajectory& m, const MessageInfo& info) { on_trajectory(m, info); },
        Writers::one("trajectory"));
    node_.subscribe<msg::StageReport>(
        "stage_report", Qos::reliable_last(50),
        [this](const msg::StageReport& m, const MessageInfo&) { on_report(m); },
        Writers::one_each<msg::StageReport>("stage_report", &reporting_stage));
    node_.subscribe<msg::TrackingState>(
        "tracking_state", Qos::best_effort(),
        [this](const msg::TrackingState& m, const MessageInfo&) {
          const bool follows = m.mode() == msg::TrackingState_Constants::MODE_FOLLOW;
          navigator_.on_tracking(m.request_id(), follows, node_.monotonic_ns());
          carry_out();
        },
        Writers::one("tracking_state"));
  }

  static Result<Goal> goal_of(const msg::Goal& m) {
    if (auto s = conversions::check_frame(m.header(), conversions::kMapFrame, "a goal"); !s) {
      return s.error();
    }
    return Goal{conversions::from_msg(m.position()), m.yaw(), m.v_max()};
  }

  void on_goal(const Result<Goal>& goal) {
    const Status status =
        goal ? navigator_.on_goal(*goal, node_.monotonic_ns()) : Status(goal.error());
    if (!status) {
      reporter_.fault(status.error());
      // The sender of this goal waits for its answer on navigator_state.
      if (navigator_.state() != State::flying && navigator_.state() != State::planning) {
        publish(StateOrder{.state = State::failed, .reason = status.error()});
      }
    }
    carry_out();
  }

  void on_command(const msg::OperatorCommand& m) {
    namespace verb = msg::OperatorCommand_Constants;
    if (m.verb() > verb::VERB_TAKEOFF) return;  // the mission's
    desk_.answer(m.id(), m.client(), [&]() -> Result<std::string> {
      const std::int64_t now_ns = node_.monotonic_ns();
      switch (m.verb()) {
        case verb::VERB_HOLD:
          navigator_.hold(now_ns);
          return std::string("the vehicle comes to rest");
        case verb::VERB_RESUME:
          return sentence(navigator_.resume_held(now_ns), "flies to its goal again");
        case verb::VERB_LAND:
          return sentence(navigator_.land(now_ns));
        default:
          return sentence(navigator_.take_off(m.height(), now_ns));
      }
    });
    carry_out();
  }

  void on_trajectory(const msg::BezierTrajectory& m, const MessageInfo& info) {
    auto candidate = candidate_of(m);
    if (!candidate) {
      reporter_.failed(m.request().id(), candidate.error());
      navigator_.on_bad_answer(m.request().id(), candidate.error());
    } else {
      const std::uint64_t number = answers_.keep(m, wire_time_ns(m.header(), info));
      navigator_.on_trajectory(*std::move(candidate), number, node_.monotonic_ns());
    }
    carry_out();
  }

  static Result<Commitment> candidate_of(const msg::BezierTrajectory& m) {
    auto nominal = conversions::from_msg(m);
    if (!nominal) return nominal.error();
    auto yaw_curve = conversions::yaw_curve_of(m);
    if (!yaw_curve) return yaw_curve.error();
    return Commitment{.id = m.request().id(),
                      .nominal = *std::move(nominal),
                      .map_version = m.map_version(),
                      .yaw_curve = *std::move(yaw_curve)};
  }

  void on_report(const msg::StageReport& m) {
    const Error outcome{conversions::error_code_of(m.code()), m.message()};
    navigator_.on_report(m.request_id(), conversions::stage_role_of(m.stage()), outcome,
                         node_.monotonic_ns(), shortfall_of(m));
    carry_out();
  }

  // Where the navigator before this one ended, if there was one and its clock is known.
  void resume() {
    resumed_ = true;
    if (config_.memory_file.empty()) return;
    auto stored = read_memory(config_.memory_file);
    if (!stored) reporter_.fault(stored.error());
    if (!stored || stored->memory.state == State::idle) return publish(StateOrder{});
    for (PublishedLeg& m : stored->legs) {
      auto leg = conversions::from_msg(m);
      if (leg) leg = begun_at(*leg, leg->start_time_ns() - to_wall_ns(0));
      if (!leg) {
        reporter_.fault(leg.error());
        continue;
      }
      stored->memory.legs.push_back(
          {.committed = *std::move(leg), .brakes = m.nominal().implementation() == kBrakeName});
      published_.push_back(std::move(m));
    }
    navigator_.resume(std::move(stored->memory), node_.monotonic_ns());
    carry_out();
  }

  // Before anything is published: the navigator after this one then knows what others may have.
  void remember() {
    StoredMemory stored{.memory = navigator_.memory()};
    for (const Leg& leg : stored.memory.legs) {
      const auto at = std::ranges::find(published_, leg.id(), &id_of);
      if (at != published_.end()) stored.legs.push_back(*at);
    }
    published_ = stored.legs;
    stored.memory.legs.clear();
    if (config_.memory_file.empty()) return;
    const Status status = write_memory(config_.memory_file, stored);
    if (!status) reporter_.complain(status.error());
  }

  static std::uint64_t id_of(const PublishedLeg& leg) { return leg.nominal().request().id(); }

  void carry_out() {
    const auto orders = navigator_.take_orders();
    if (orders.empty()) return;
    for (const Order& order : orders) {
      if (const auto* commit = std::get_if<Commit>(&order)) keep(message_of(*commit));
    }
    const auto legs = published_;
    // A request for a better plan changes nothing that the next navigator must know.
    const auto is_request = [](const Order& o) { return std::holds_alternative<PlanRequest>(o); };
    if (!std::ranges::all_of(orders, is_request)) remember();
    for (const Order& order : orders) {
      if (const auto* commit = std::get_if<Commit>(&order)) publish(*commit, legs);
      if (const auto* request = std::get_if<PlanRequest>(&order)) publish(*request);
      if (const auto* state = std::get_if<StateOrder>(&order)) publish(*state);
      if (const auto* complaint = std::get_if<Complaint>(&order)) publish(*complaint);
    }
  }

  void keep(PublishedLeg leg) {
    const auto at = std::ranges::find(published_, id_of(leg), &id_of);
    if (at == published_.end()) {
      published_.push_back(std::move(leg));
    } else {
      *at = std::move(leg);
    }
  }

  std::int64_t to_wall_ns(std::int64_t monotonic_ns) const {
    return monotonic_ns + (node_.now_ns() - node_.monotonic_ns());
  }

  void publish(const PlanRequest& request) {
    auto m = conversions::to_msg(request);
    m.header().stamp(conversions::to_stamp(node_.now_ns()));
    if (request.start_time_ns) {
      m.start_time(conversions::to_stamp(to_wall_ns(*request.start_time_ns)));
    }
    reporter_.send(requests_, m);
  }

  /// As it is published: the nominal part as its optimizer sent it, under the commit's own id.
  PublishedLeg message_of(const Commit& commit) const {
    const CommittedTrajectory& committed = commit.trajectory;
    const auto known = std::ranges::find(published_, committed.id(), &id_of);
    const auto* answer = answers_.find(commit.answer);
    const auto continued = std::ranges::find(published_, commit.continues, &id_of);
    PublishedLeg m;
    if (known != published_.end()) {
      m = *known;
    } else if (continued != published_.end()) {
      m.nominal(continued->nominal());
      m.nominal().request().id(committed.id());
    } else {
      m.nominal(answer != nullptr ? answer->message : nominal_of(committed));
    }
    if (known == published_.end()) conversions::fill_msg(committed, m);
    // Also of one that is repeated: this host's clock may have been set since.
    m.header(conversions::make_header(node_.now_ns()));
    m.start_time(conversions::to_stamp(to_wall_ns(committed.start_time_ns())));
    return m;
  }

  void publish(const Commit& commit, const std::vector<PublishedLeg>& legs) {
    const std::uint64_t id = commit.trajectory.id();
    life_sign_.before_commit();
    reporter_.send(commits_, *std::ranges::find(legs, id, &id_of));
    const auto* answer = answers_.find(commit.answer);
    reporter_.answered(id, {.wire_ns = answer != nullptr ? answer->wire_ns : 0});
  }

  /// Of a trajectory that is no stage's answer.
  msg::BezierTrajectory nominal_of(const CommittedTrajectory& committed) const {
    const CertifiedTrajectory& nominal = committed.nominal();
    PlanRequest request;
    request.id = committed.id();
    request.start = nominal.start();
    request.goal = nominal.goal();
    request.goal_yaw_rad = request.start_yaw_rad = committed.yaw_rad();
    request.limits = nominal.limits();
    msg::BezierTrajectory m;
    m.header(conversions::make_header(node_.now_ns()));
    m.request(conversions::to_msg(request));
    m.request().header(m.header());
    m.request().start_time(conversions::to_stamp(to_wall_ns(committed.start_time_ns())));
    m.implementation(kBrakeName);
    m.map_version(committed.map_version());
    m.pieces(conversions::to_msg(nominal.trajectory()));
    m.polytopes(conversions::to_msg(nominal.polytopes()));
    m.certificate(conversions::to_msg(nominal.certificate()));
    return m;
  }

  void publish(const Complaint& complaint) { reporter_.failed(complaint.id, complaint.reason); }

  void publish(const StateOrder& order) {
    auto& m = state_message_;
    m.header(conversions::make_header(node_.now_ns()));
    m.state(to_msg(order.state));
    m.request_id(order.id);
    m.flown_request_id(order.flown_id);
    m.goal(conversions::to_point(order.goal_map));
    m.code(std::string(to_string(order.reason.code)));
    m.message(order.reason.message);
    reporter_.send(states_, m);
  }

  Node& node_;
  Config config_;
  Navigator navigator_;
  StageReporter reporter_;
  OperatorDesk desk_;
  Publisher<msg::PlanRequest> requests_;
  Publisher<msg::CommittedTrajectory> commits_;
  Publisher<msg::NavigatorState> states_;
  msg::NavigatorState state_message_;
  LifeSign life_sign_;
  KeptAnswers answers_;
  std::vector<PublishedLeg> published_;  // of what is flown, by start
  bool resumed_ = false;
  MapSubscription map_;
};

}  // namespace
}  // namespace goshawk::navigator

GOSHAWK_REGISTER_COMPONENT(goshawk::navigator::NavigatorComponent, goshawk::navigator::Config)
