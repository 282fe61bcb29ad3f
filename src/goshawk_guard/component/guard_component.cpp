#include <fmt/format.h>

#include <algorithm>

#include "goshawk/conversions/plan.hpp"
#include "goshawk/conversions/status.hpp"
#include "goshawk/conversions/vehicle.hpp"
#include "goshawk/guard/guard.hpp"
#include "goshawk/runtime/component.hpp"
#include "goshawk/stage/intake.hpp"
#include "goshawk/stage/life_sign.hpp"
#include "goshawk/stage/map_subscription.hpp"
#include "plan_messages.hpp"

namespace goshawk::guard {
namespace {

using namespace goshawk::runtime;
using namespace goshawk::stage;
namespace msg = goshawk_msgs::msg;

// Milliseconds since 1970: commits of a restarted guard never repeat an id. In simulated time there
// may be no time yet; a simulation begins anew with its guard.
std::uint64_t first_id(std::int64_t now_ns) {
  return std::max<std::uint64_t>(1, std::uint64_t(now_ns / 1'000'000));
}

/// Only the tracker's answers count, and from one process.
std::uint8_t tracking_stage(const msg::StageReport& m) {
  return m.stage() == msg::StageReport_Constants::STAGE_TRACKER ? m.stage() : std::uint8_t{0};
}

Tracking tracking_of(const msg::TrackingState& m) {
  namespace constants = msg::TrackingState_Constants;
  Tracking tracking{.reference_map = conversions::from_msg(m.reference())};
  if (m.mode() == constants::MODE_HOLD) tracking.mode = Tracking::Mode::holds;
  if (m.mode() == constants::MODE_FOLLOW) tracking.mode = Tracking::Mode::follows;
  if (m.mode() == constants::MODE_BRAKE) tracking.mode = Tracking::Mode::brakes;
  return tracking;
}

std::uint8_t to_msg(Verdict verdict) {
  namespace constants = msg::GuardVerdict_Constants;
  static_assert(std::uint8_t(Verdict::passed) == constants::VERDICT_PASSED &&
                std::uint8_t(Verdict::slowed) == constants::VERDICT_SLOWED &&
                std::uint8_t(Verdict::replaced) == constants::VERDICT_REPLACED &&
                std::uint8_t(Verdict::refused) == constants::VERDICT_REFUSED);
  return std::uint8_t(verdict);
}

std::uint8_t to_msg(PlanKind kind) {
  namespace constants = msg::GuardVerdict_Constants;
  static_assert(std::uint8_t(PlanKind::path) == constants::KIND_PATH &&
                std::uint8_t(PlanKind::trajectory) == constants::KIND_TRAJECTORY &&
                std::uint8_t(PlanKind::polynomial) == constants::KIND_POLYNOMIAL &&
                std::uint8_t(PlanKind::bspline) == constants::KIND_BSPLINE);
  return std::uint8_t(kind);
}

/// "passed, trimmed: map 7 has an obstacle at (1, 2, 3) m"
std::string sentence_of(const Decision& decision) {
  std::string text = fmt::format("plan {} ({}) is {}{}", decision.plan, to_string(decision.kind),
                                 to_string(decision.verdict), decision.trimmed ? ", trimmed" : "");
  if (!decision.reason.message.empty()) text += ": " + decision.reason.message;
  return text;
}

/// plan/path, plan/trajectory, plan/polynomial, plan/bspline, tracking_state, map/voxels,
/// stage_report of the tracker -> committed_trajectory, guard_verdict, navigator_state,
/// navigator_alive. In the navigator's place. Counts on the monotonic clock; messages carry the
/// wall clock's.
class GuardComponent : public Component {
 public:
  explicit GuardComponent(Node& node)
      : node_(node),
        guard_(node.parameters<Config>([this](const Config& c) { return guard_.reconfigure(c); }),
               make_repair(), first_id(node.now_ns())),
        reporter_(node, StageRole::guard, "guard"),
        commits_(node.advertise<msg::CommittedTrajectory>("committed_trajectory", Qos::latched())),
        verdicts_(node.advertise<msg::GuardVerdict>("guard_verdict", Qos::latched(20))),
        states_(node.advertise<msg::NavigatorState>("navigator_state", Qos::latched(20))),
        life_sign_(node, reporter_, state_),
        map_(node, reporter_, [this](const auto& grid) {
          guard_.set_map(grid, node_.monotonic_ns());
          publish_commits();
        }) {
    listen_for_plans();
    listen_to_tracker();
    node.every(0.05, [this] {
      if (const auto silence = guard_.check_silence(node_.monotonic_ns())) {
        reporter_.fault(*silence);
      }
      publish_state();
    });
    publish_state();
    reporter_.ready(
        "waits for plans on plan/path, plan/trajectory, plan/polynomial and "
        "plan/bspline");
  }

 private:
  template <typename Message>
  void listen(const char* topic, PlanKind kind) {
    node_.subscribe<Message>(
        topic, Qos::reliable_last(1),
        [this, kind](const Message& m, const MessageInfo& info) { on_plan(m, kind, info); },
        Writers::one("plan"));
  }

  void listen_for_plans() {
    listen<nav_msgs::msg::Path>("plan/path", PlanKind::path);
    listen<trajectory_msgs::msg::MultiDOFJointTrajectory>("plan/trajectory", PlanKind::trajectory);
    listen<msg::PolynomialPlan>("plan/polynomial", PlanKind::polynomial);
    listen<msg::BsplinePlan>("plan/bspline", PlanKind::bspline);
  }

  void listen_to_tracker() {
    node_.subscribe<msg::TrackingState>(
        "tracking_state", Qos::best_effort(),
        [this](const msg::TrackingState& m, const MessageInfo&) {
          guard_.on_tracking(tracking_of(m), node_.monotonic_ns());
        },
        Writers::one("tracking_state"));
    node_.subscribe<msg::StageReport>(
        "stage_report", Qos::reliable_last(50),
        [this](const msg::StageReport& m, const MessageInfo&) {
          if (tracking_stage(m) == 0 || m.request_id() == 0) return;
          const Error outcome{conversions::error_code_of(m.code()), m.message()};
          guard_.on_tracker_answer(m.request_id(), outcome, node_.monotonic_ns());
        },
        Writers::one_each<msg::StageReport>("stage_report", &tracking_stage));
    node_.subscribe<nav_msgs::msg::Odometry>(
        "odom", Qos::best_effort(),
        [this](const nav_msgs::msg::Odometry& m, const MessageInfo&) {
          if (guard_.flown().newest(node_.monotonic_ns()) != nullptr) return;
          const auto vehicle = conversions::from_msg(m);
          if (!vehicle) return;  // the tracker reports bad odometry
          guard_.on_heading(yaw_of(vehicle->q_map_base));
        },
        Writers::one("odom"));
  }

  std::int64_t wall_ahead_ns() const { return node_.now_ns() - node_.monotonic_ns(); }

  template <typename Message>
  void on_plan(const Message& m, PlanKind kind, const MessageInfo& info) {
    const std::int64_t now_ns = node_.monotonic_ns();
    const auto [decision, compute_ns] = timed([&] {
      auto plan = plan_of(m);
      if (!plan) return guard_.refuse(kind, plan.error(), now_ns);
      if (plan->start_time_ns) *plan->start_time_ns -= wall_ahead_ns();
      return guard_.on_plan(*plan, now_ns);
    });
    newest_ = decision;
    publish_commits();
    publish(decision, m.header(), compute_ns);
    const Timing timing{.wire_ns = wire_time_ns(m.header(), info), .compute_ns = compute_ns};
    if (decision.verdict == Verdict::refused) {
      reporter_.complain({decision.reason.code, sentence_of(decision)});
    } else {
      reporter_.answered(decision.commit_id, timing, {{"deviation_m", decision.deviation_m}},
                         sentence_of(decision));
    }
    publish_state();
  }

  void publish(const Decision& decision, const std_msgs::msg::Header& plan,
               std::int64_t compute_ns) {
    msg::GuardVerdict m;
    m.header(conversions::make_header(node_.now_ns()));
    m.plan(decision.plan);
    m.kind(to_msg(decision.kind));
    m.plan_stamp(plan.stamp());
    m.verdict(to_msg(decision.verdict));
    m.trimmed(decision.trimmed);
    m.request_id(decision.commit_id);
    m.code(std::string(to_string(decision.reason.code)));
    m.message(sentence_of(decision));
    if (decision.place_map) m.place({conversions::to_point(*decision.place_map)});
    m.deviation(decision.deviation_m);
    m.compute_ns(compute_ns);
    reporter_.send(verdicts_, m);
  }

  void publish_commits() {
    for (const Commit& commit : guard_.take_commits()) {
      const CommittedTrajectory& committed = commit.trajectory;
      const std::int64_t start_ns = committed.start_time_ns() + wall_ahead_ns();
      msg::CommittedTrajectory m;
      m.header(conversions::make_header(node_.now_ns()));
      m.nominal(nominal_of(commit, start_ns));
      conversions::fill_msg(committed, m);
      m.start_time(conversions::to_stamp(start_ns));
      life_sign_.before_commit();
      reporter_.send(commits_, m, committed.id());
    }
  }

  msg::BezierTrajectory nominal_of(const Commit& commit, std::int64_t start_ns) const {
    const CertifiedTrajectory& nominal = commit.trajectory.nominal();
    PlanRequest request;
    request.id = commit.trajectory.id();
    request.start = nominal.start();
    request.goal = nominal.goal();
    request.goal_yaw_rad = request.start_yaw_rad = commit.trajectory.yaw_rad();
    request.limits = nominal.limits();
    msg::BezierTrajectory m;
    m.header(conversions::make_header(node_.now_ns()));
    m.request(conversions::to_msg(request));
    m.request().header(m.header());
    m.request().start_time(conversions::to_stamp(start_ns));
    m.implementation(fmt::format("guard_{}", to_string(commit.kind)));
    m.map_version(commit.trajectory.map_version());
    m.pieces(conversions::to_msg(nominal.trajectory()));
    m.polytopes(conversions::to_msg(nominal.polytopes()));
    m.certificate(conversions::to_msg(nominal.certificate()));
    return m;
  }

  // For those who watch a navigator; and the tracker lands without its sign of life.
  void publish_state() {
    namespace constants = msg::NavigatorState_Constants;
    const auto* flown = guard_.flown().newest(node_.monotonic_ns());
    const std::uint64_t flown_id = flown != nullptr ? flown->id() : state_.flown_request_id();
    std::uint8_t state = constants::STATE_IDLE;
    if (flown != nullptr) {
      state = constants::STATE_FLYING;
      state_.goal(conversions::to_point(flown->nominal().goal().position));
    } else if (newest_.plan > 0) {
      const bool falls_short = newest_.verdict == Verdict::refused ||
                               newest_.reason.code == ErrorCode::trajectory_blocked;
      state = falls_short ? constants::STATE_FAILED : constants::STATE_ARRIVED;
    }
    const bool is_new = state_.header().frame_id().empty() || state != state_.state() ||
                        newest_.plan != told_plan_ || flown_id != state_.flown_request_id();
    told_plan_ = newest_.plan;
    state_.header(conversions::make_header(node_.now_ns()));
    state_.state(state);
    state_.request_id(newest_.plan);
    state_.flown_request_id(flown_id);
    state_.code(std::string(to_string(newest_.reason.code)));
    state_.message(newest_.plan > 0 ? sentence_of(newest_) : "");
    if (is_new) reporter_.send(states_, state_);
  }

  Node& node_;
  Guard guard_;
  StageReporter reporter_;
  Publisher<msg::CommittedTrajectory> commits_;
  Publisher<msg::GuardVerdict> verdicts_;
  Publisher<msg::NavigatorState> states_;
  msg::NavigatorState state_;
  stage::LifeSign life_sign_;
  Decision newest_;
  std::uint64_t told_plan_ = 0;
  MapSubscription map_;
};

}  // namespace
}  // namespace goshawk::guard

GOSHAWK_REGISTER_COMPONENT(goshawk::guard::GuardComponent, goshawk::guard::Config)
