#include <fmt/format.h>

#include "goshawk/conversions/vehicle.hpp"
#include "goshawk/px4_stand_in/autopilot.hpp"
#include "goshawk/px4_topics/px4_topics.hpp"
#include "goshawk/runtime/component.hpp"
#include "goshawk/stage/stage_reporter.hpp"
#include "nav_msgs.h"

namespace goshawk::px4_stand_in {
namespace {

using namespace goshawk::runtime;

/// What the stand-in sends, as topics.
class TopicWire : public Wire {
 public:
  TopicWire(Node& node, stage::StageReporter& reporter, px4::Release release)
      : topics_(node, reporter, release) {
    topics_.advertise<px4::VehicleStatus>();
    topics_.advertise<px4::VehicleLandDetected>();
    topics_.advertise<px4::BatteryStatus>();
    topics_.advertise<px4::FailsafeFlags>();
    topics_.advertise<px4::ManualControlSetpoint>();
    topics_.advertise<px4::VehicleLocalPosition>();
    topics_.advertise<px4::VehicleOdometry>();
    topics_.advertise<px4::VehicleCommandAck>();
    topics_.advertise<px4::MessageFormatResponse>();
    topics_.advertise<px4::RegisterExtComponentReply>();
    topics_.advertise<px4::ArmingCheckRequest>();
    if (release >= px4::Release::v1_18) topics_.advertise<px4::SetpointConfigReply>();
  }

  void send(const px4::VehicleStatus& m) override { topics_.send(m); }
  void send(const px4::VehicleLandDetected& m) override { topics_.send(m); }
  void send(const px4::BatteryStatus& m) override { topics_.send(m); }
  void send(const px4::FailsafeFlags& m) override { topics_.send(m); }
  void send(const px4::ManualControlSetpoint& m) override { topics_.send(m); }
  void send(const px4::VehicleLocalPosition& m) override { topics_.send(m); }
  void send(const px4::VehicleOdometry& m) override { topics_.send(m); }
  void send(const px4::VehicleCommandAck& m) override { topics_.send(m); }
  void send(const px4::MessageFormatResponse& m) override { topics_.send(m); }
  void send(const px4::RegisterExtComponentReply& m) override { topics_.send(m); }
  void send(const px4::ArmingCheckRequest& m) override { topics_.send(m); }
  void send(const px4::SetpointConfigReply& m) override { topics_.send(m); }

  px4::Px4Topics& topics() { return topics_; }

 private:
  px4::Px4Topics topics_;
};

/// fmu/in/... -> fmu/out/..., and the truth for judges on odom_true while it is in the air. In real
/// time, by the monotonic clock.
class Px4StandInComponent : public Component {
 public:
  explicit Px4StandInComponent(Node& node)
      : node_(node),
        config_(node.parameters<Config>([this](const Config& c) { return reconfigure(c); })),
        reporter_(node, StageRole::other, "px4 stand-in"),
        wire_(node, reporter_, config_.release),
        autopilot_(make_autopilot()),
        truth_(node.advertise<nav_msgs::msg::Odometry>("odom_true", Qos::state())) {
    hear<px4::VehicleCommand>();
    hear<px4::OffboardControlMode>();
    hear<px4::TrajectorySetpoint>();
    hear<px4::VehicleAttitudeSetpoint>();
    hear<px4::MessageFormatRequest>();
    hear<px4::RegisterExtComponentRequest>();
    hear<px4::UnregisterExtComponent>();
    hear<px4::ArmingCheckReply>();
    if (config_.release >= px4::Release::v1_18) {
      hear<px4::SetpointConfig>();
    } else {
      hear<px4::VehicleControlMode>();
    }
    node.every(Airframe::kStep_s, [this] { step(); });
    reporter_.ready(fmt::format("PX4 {} stands at {} m", to_word(config_.release),
                                to_text(autopilot_.truth().position_map)));
  }

 private:
  Autopilot make_autopilot() {
    auto autopilot = Autopilot::create(config_, wire_, node_.monotonic_ns());
    if (!autopilot) throw StartupFault(autopilot.error());
    return *std::move(autopilot);
  }

  Status reconfigure(const Config& config) {
    if (auto status = check(config); !status) return status;
    config_ = config;
    autopilot_.reconfigure(config);
    return success();
  }

  template <typename Message>
  void hear() {
    wire_.topics().subscribe<Message>([this](const Message& m) { autopilot_.hear(m); },
                                      Writers::any(), 5);
  }

  void step() {
    const std::int64_t now_ns = node_.monotonic_ns();
    // After a pause of this process the world goes on, it does not jump.
    if (last_ns_ != 0 && now_ns - last_ns_ > kMostPause_ns) paused_ns_ += now_ns - last_ns_;
    last_ns_ = now_ns;
    autopilot_.advance(now_ns - paused_ns_);
    if (autopilot_.landed()) return;
    message_.header().stamp(conversions::to_stamp(node_.now_ns()));
    conversions::fill_msg(autopilot_.truth(), message_);
    reporter_.send(truth_, message_);
  }

  static constexpr std::int64_t kMostPause_ns = 200'000'000;

  Node& node_;
  Config config_;
  stage::StageReporter reporter_;
  TopicWire wire_;
  Autopilot autopilot_;
  Publisher<nav_msgs::msg::Odometry> truth_;
  nav_msgs::msg::Odometry message_;
  std::int64_t last_ns_ = 0;
  std::int64_t paused_ns_ = 0;
};

}  // namespace
}  // namespace goshawk::px4_stand_in

GOSHAWK_REGISTER_COMPONENT(goshawk::px4_stand_in::Px4StandInComponent,
                           goshawk::px4_stand_in::Config)
