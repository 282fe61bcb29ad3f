#include <fmt/format.h>

#include "../messages/memory.hpp"
#include "goshawk/conversions/vehicle.hpp"
#include "goshawk/mission_messages/messages.hpp"
#include "goshawk/runtime/component.hpp"
#include "goshawk/stage/operator_desk.hpp"

namespace goshawk::mission {
namespace {

using namespace goshawk::runtime;
using namespace goshawk::stage;
namespace msg = goshawk_msgs::msg;
namespace verb = goshawk_msgs::msg::OperatorCommand_Constants;

constexpr double kTick_s = 0.02;
constexpr double kTell_s = 0.5;  // how far it is, while nothing changes

/// mission, operator_command, navigator_state, odom -> goal, mission_state, operator_answer. Counts
/// on the monotonic clock; messages carry the wall clock's.
class MissionComponent : public Component {
 public:
  explicit MissionComponent(Node& node)
      : node_(node),
        config_(node.parameters<Config>([this](const Config& c) { return reconfigure(c); })),
        executor_(config_),
        reporter_(node, StageRole::mission, "mission"),
        desk_(node, reporter_),
        goals_(node.advertise<msg::Goal>("goal", Qos::reliable_last())),
        states_(node.advertise<msg::MissionState>("mission_state", Qos::latched())) {
    resume();
    subscribe();
    publish_state();
    node.every(kTick_s, [this] {
      executor_.tick(node_.monotonic_ns());
      carry_out();
    });
    node.every(kTell_s, [this] { publish_state(); });
    reporter_.ready(executor_.mission().waypoints.empty()
                        ? "waits for a mission on mission"
                        : "goes on with " + executor_.mission().name);
  }

 private:
  Status reconfigure(const Config& config) {
    config_ = config;
    executor_.reconfigure(config);
    return success();
  }

  // Where the stage before this one ended, if there was one.
  void resume() {
    if (config_.memory_file.empty()) return;
    auto memory = read_memory(config_.memory_file);
    if (!memory) return reporter_.fault(memory.error());
    if (memory->state != State::none) executor_.restore(*std::move(memory), node_.monotonic_ns());
  }

  void subscribe() {
    node_.subscribe<msg::Mission>("mission", Qos::reliable_last(),
                                  [this](const msg::Mission& m, const auto&) { on_mission(m); });
    node_.subscribe<msg::OperatorCommand>(
        "operator_command", Qos::reliable_last(),
        [this](const msg::OperatorCommand& m, const auto&) { on_command(m); });
    node_.subscribe<nav_msgs::msg::Odometry>(
        "odom", Qos::best_effort(),
        [this](const nav_msgs::msg::Odometry& m, const auto&) {
          const auto vehicle = conversions::from_msg(m);
          if (!vehicle) return;  // the tracker reports bad odometry
          executor_.on_vehicle(vehicle->position_map, yaw_of(vehicle->q_map_base),
                               node_.monotonic_ns());
          carry_out();
        },
        Writers::one("odom"));
    node_.subscribe<msg::NavigatorState>(
        "navigator_state", Qos::latched(20),
        [this](const msg::NavigatorState& m, const auto&) {
          if (const auto news = from_msg(m)) executor_.on_navigator(*news, node_.monotonic_ns());
          carry_out();
        },
        Writers::one("navigator_state"));
  }

  void on_mission(const msg::Mission& m) {
    desk_.answer(m.id(), m.client(), [&]() -> Result<std::string> {
      auto mission = from_msg(m);
      if (!mission) return mission.error();
      const std::size_t count = mission->waypoints.size();
      const auto status = executor_.start(*std::move(mission), node_.monotonic_ns());
      if (!status) return status.error();
      return fmt::format("flies {} waypoints", count);
    });
    carry_out();
  }

  void on_command(const msg::OperatorCommand& m) {
    if (m.verb() != verb::VERB_RESUME_MISSION && m.verb() != verb::VERB_CANCEL_MISSION) return;
    desk_.answer(m.id(), m.client(), [&]() -> Result<std::string> {
      const bool goes_on = m.verb() == verb::VERB_RESUME_MISSION;
      const auto status = goes_on ? executor_.resume(node_.monotonic_ns()) : executor_.cancel();
      if (!status) return status.error();
      const auto progress = executor_.progress(node_.monotonic_ns());
      return fmt::format("{} waypoint {} of {}", goes_on ? "flies to" : "cancelled before",
                         progress.waypoint, executor_.mission().waypoints.size());
    });
    carry_out();
  }

  // What the stage after this one must know is written before anybody else hears of it.
  void carry_out() {
    const auto goal = executor_.take_goal();
    if (executor_.take_change()) {
      remember();
      publish_state();
      const auto progress = executor_.progress(node_.monotonic_ns());
      if (progress.state == State::failed) reporter_.fault(progress.reason);
    }
    if (goal) reporter_.send(goals_, to_msg(*goal, node_.now_ns()));
  }

  void remember() {
    if (config_.memory_file.empty()) return;
    const Status status = write_memory(config_.memory_file, executor_.memory());
    if (!status) reporter_.complain(status.error());
  }

  void publish_state() {
    reporter_.send(states_, to_msg(executor_.mission(), executor_.progress(node_.monotonic_ns()),
                                   node_.now_ns()));
  }

  Node& node_;
  Config config_;
  Executor executor_;
  StageReporter reporter_;
  OperatorDesk desk_;
  Publisher<msg::Goal> goals_;
  Publisher<msg::MissionState> states_;
};

}  // namespace
}  // namespace goshawk::mission

GOSHAWK_REGISTER_COMPONENT(goshawk::mission::MissionComponent, goshawk::mission::Config)
