#include <fmt/format.h>

#include <spdlog/logger.h>

#include <random>
#include <stdexcept>

#include "goshawk/conversions/vehicle.hpp"
#include "goshawk/px4/bridge.hpp"
#include "goshawk/px4_topics/px4_topics.hpp"
#include "goshawk/runtime/component.hpp"
#include "goshawk/stage/plant_topics.hpp"

namespace goshawk::px4 {
namespace {

using namespace goshawk::runtime;
namespace msg = goshawk_msgs::msg;

constexpr int kDepth = 5;  // resets and answers must not be overwritten by the next

Config checked(Config config) {
  if (auto status = check(config); !status) throw StartupFault(status.error());
  return config;
}

/// The bridge's messages as topics, and its sentences as reports.
class TopicLink : public Link {
 public:
  TopicLink(Node& node, stage::StageReporter& reporter, const Config& config)
      : node_(node), reporter_(reporter), topics_(node, reporter, config.release) {
    topics_.advertise<VehicleCommand>();
    topics_.advertise<OffboardControlMode>();
    topics_.advertise<TrajectorySetpoint>();
    topics_.advertise<VehicleAttitudeSetpoint>();
    topics_.advertise<MessageFormatRequest>();
    if (config.mode == ModeKind::offboard) return;
    topics_.advertise<RegisterExtComponentRequest>();
    topics_.advertise<ArmingCheckReply>();
    if (config.release >= Release::v1_18) {
      topics_.advertise<SetpointConfig>();
    } else {
      topics_.advertise<VehicleControlMode>();
    }
  }

  void send(const VehicleCommand& m) override { topics_.send(m); }
  void send(const OffboardControlMode& m) override { topics_.send(m); }
  void send(const TrajectorySetpoint& m) override { topics_.send(m); }
  void send(const VehicleAttitudeSetpoint& m) override { topics_.send(m); }
  void send(const MessageFormatRequest& m) override { topics_.send(m); }
  void send(const RegisterExtComponentRequest& m) override { topics_.send(m); }
  void send(const ArmingCheckReply& m) override { topics_.send(m); }
  void send(const VehicleControlMode& m) override { topics_.send(m); }
  void send(const SetpointConfig& m) override { topics_.send(m); }
  // News go to the log: on stage_report "ok" means that the stages may begin.
  void tell(const Error& fault) override {
    if (fault.code != ErrorCode::ok) return reporter_.fault(fault);
    node_.log().info("{}", fault.message);
  }

  Px4Topics& topics() { return topics_; }

 private:
  Node& node_;
  stage::StageReporter& reporter_;
  Px4Topics topics_;
};

std::uint8_t to_msg(InCharge who) {
  namespace constants = msg::VehicleStatus_Constants;
  switch (who) {
    case InCharge::nobody:
      return constants::CONTROL_NONE;
    case InCharge::goshawk:
      return constants::CONTROL_GOSHAWK;
    case InCharge::pilot:
      return constants::CONTROL_PILOT;
    case InCharge::autopilot:
      return constants::CONTROL_AUTOPILOT;
  }
  throw std::logic_error("to_msg() of no InCharge");
}

/// fmu/out/..., command, fallback_stop -> fmu/in/..., odom, vehicle_status, /tf. Counts on the
/// monotonic clock.
class Px4Component : public Component {
 public:
  explicit Px4Component(Node& node)
      : node_(node),
        config_(checked(node.parameters<Config>())),
        reporter_(node, StageRole::vehicle, fmt::format("px4 {}", to_word(config_.release))),
        topics_(node, reporter_, false),
        link_(node, reporter_, config_),
        bridge_(config_, link_, std::random_device{}()) {
    listen_to_px4();
    listen_to_tracker();
    node.every(0.02, [this] { step(); });
    node.every(0.05, [this] { publish_slow(); });
    node.log().info("waits for PX4 {}", to_word(config_.release));
  }

 private:
  void listen_to_px4() {
    hear_timed<VehicleStatus>();
    hear_timed<VehicleLocalPosition>();
    hear<VehicleLandDetected>();
    hear<BatteryStatus>();
    hear<FailsafeFlags>();
    hear<ManualControlSetpoint>();
    hear<VehicleCommandAck>();
    hear<MessageFormatResponse>();
    link_.topics().subscribe<VehicleOdometry>([this](const auto& m) { on_odometry(m); },
                                              Writers::one("px4"));
    if (config_.mode == ModeKind::offboard) return;
    hear_timed<RegisterExtComponentReply>();
    hear_timed<ArmingCheckRequest>();
    if (config_.release >= Release::v1_18) hear<SetpointConfigReply>();
  }

  template <typename Message>
  void hear() {
    link_.topics().subscribe<Message>([this](const auto& m) { bridge_.hear(m); },
                                      Writers::one("px4"), kDepth);
  }
  template <typename Message>
  void hear_timed() {
    link_.topics().subscribe<Message>(
        [this](const auto& m) { bridge_.hear(m, node_.monotonic_ns()); }, Writers::one("px4"),
        kDepth);
  }

  void listen_to_tracker() {
    node_.subscribe<msg::AttitudeSetpoint>(
        "command", Qos::best_effort(),
        [this](const msg::AttitudeSetpoint& m, const MessageInfo&) {
          const auto command = conversions::from_msg(m);
          if (!command) return reporter_.complain(command.error());
          bridge_.hear(*command, node_.monotonic_ns());
        },
        Writers::one("command"));
    node_.subscribe<msg::FallbackStop>(
        "fallback_stop", Qos::best_effort(),
        [this](const msg::FallbackStop& m, const MessageInfo&) {
          auto stop = conversions::from_msg(m);
          if (!stop) return reporter_.complain(stop.error());
          bridge_.hear(*std::move(stop), node_.monotonic_ns());
        },
        Writers::one("command"));
  }

  void on_odometry(const VehicleOdometry& m) {
    const std::int64_t now_ns = node_.monotonic_ns();
    const auto state = bridge_.hear(m, now_ns);
    if (!state) return;
    state_ = state->state;
    topics_.publish_odometry(state->state, node_.now_ns() - (now_ns - state->time_ns));
  }

  void step() {
    bridge_.step(node_.monotonic_ns());
    if (!bridge_.ready() || said_ready_) return;
    said_ready_ = true;
    reporter_.ready("hovers under PX4's control");
  }

  void publish_slow() {
    const auto& px4 = bridge_.status();
    if (!px4) return;
    msg::VehicleStatus status;
    status.armed(px4->armed());
    status.control(to_msg(bridge_.in_charge()));
    status.failsafe(px4->failsafe);
    status.resets(bridge_.resets());
    status.battery(bridge_.battery().value_or(-1.0));
    status.command_age(bridge_.command_age_s(node_.monotonic_ns()).value_or(-1.0));
    topics_.publish_status(status, node_.now_ns());
    if (state_) topics_.publish_pose(*state_, node_.now_ns());
  }

  Node& node_;
  Config config_;
  stage::StageReporter reporter_;
  stage::PlantTopics topics_;
  TopicLink link_;
  Bridge bridge_;
  std::optional<RigidBodyState> state_;
  bool said_ready_ = false;
};

}  // namespace
}  // namespace goshawk::px4

GOSHAWK_REGISTER_COMPONENT(goshawk::px4::Px4Component, goshawk::px4::Config)
