#include <algorithm>

#include "goshawk/conversions/vehicle.hpp"
#include "goshawk/runtime/component.hpp"
#include "goshawk/runtime/stage_reporter.hpp"
#include "goshawk/simulator/quadrotor.hpp"
#include "tf2_msgs.h"

namespace goshawk::simulator {

/// What the component needs beyond the plant.
struct ComponentConfig {
  Config plant;
  double start_x_m = 3.0;
  double start_y_m = 0.0;
  double start_z_m = 1.0;
  double start_yaw_rad = 0.0;
  double rate_hz = 250.0;
};

template <typename Self, typename Visitor>
requires std::same_as<std::remove_const_t<Self>, ComponentConfig>
void describe(Self& c, Visitor&& visit) {
  visit("start_x_m", c.start_x_m, "m", "where the vehicle hovers at first: map x", Anything{});
  visit("start_y_m", c.start_y_m, "m", "likewise map y", Anything{});
  visit("start_z_m", c.start_z_m, "m", "likewise map z", Anything{});
  visit("start_yaw_rad", c.start_yaw_rad, "rad", "its heading, from map x to y",
        Range{-3.1416, 3.1416});
  visit("rate_hz", c.rate_hz, "Hz", "how often odometry is published", Range{10.0, 1000.0});
  describe(c.plant, visit);
}

namespace {

using namespace goshawk::runtime;
namespace msg = goshawk_msgs::msg;

Quadrotor make_quadrotor(const ComponentConfig& config) {
  auto quadrotor = Quadrotor::create(config.plant);
  if (!quadrotor) throw StartupFault(quadrotor.error());
  auto status = quadrotor->reset({config.start_x_m, config.start_y_m, config.start_z_m},
                                 config.start_yaw_rad);
  if (!status) throw StartupFault(status.error());
  return *std::move(quadrotor);
}

/// command -> odom, in real time
class SimulatorComponent : public Component {
 public:
  explicit SimulatorComponent(Node& node)
      : node_(node),
        config_(node.parameters<ComponentConfig>()),
        quadrotor_(make_quadrotor(config_)),
        reporter_(node, "rigid_body_rk4"),
        odometry_(node.advertise<nav_msgs::msg::Odometry>("odom", Qos::best_effort())),
        status_(node.advertise<msg::VehicleStatus>("vehicle_status", Qos::best_effort())),
        tf_(node.advertise<tf2_msgs::msg::TFMessage>("/tf", Qos::best_effort(10))) {
    node.subscribe<msg::ThrustAttitude>(
        "command", Qos::best_effort(),
        [this](const msg::ThrustAttitude& m, const MessageInfo& info) { on_command(m, info); });
    last_ns_ = node.now_ns();
    node.every(1.0 / config_.rate_hz, [this] { step(); });
    node.every(0.05, [this] { publish_slow(); });
    reporter_.ready("hovers at " + to_text(quadrotor_.state().position_map));
  }

 private:
  void on_command(const msg::ThrustAttitude& m, const MessageInfo& info) {
    const auto command = conversions::from_msg(m);
    const Status status = command ? quadrotor_.command(*command) : command.error();
    if (status) {
      command_ns_ = info.received_ns;
    } else if (info.received_ns - complained_ns_ > 1'000'000'000) {  // once a second is enough
      complained_ns_ = info.received_ns;
      reporter_.fault(status.error());
    }
  }

  void step() {
    const std::int64_t now_ns = node_.now_ns();
    // After a pause (a stopped machine, a clock that was set) the world goes on, it does not jump.
    const double dt_s = std::clamp(double(now_ns - last_ns_) * 1e-9, 0.0, 0.1);
    last_ns_ = now_ns;
    if (auto status = quadrotor_.advance(dt_s); !status)
      throw std::logic_error(status.error().message);
    odometry_message_.header().stamp(conversions::to_stamp(now_ns));
    conversions::fill_msg(quadrotor_.state(), odometry_message_);
    send(odometry_, odometry_message_);
  }

  void publish_slow() {
    msg::VehicleStatus status;
    status.header(conversions::make_header(last_ns_));
    status.failsafe(quadrotor_.control() == Control::failsafe);
    status.command_age(command_ns_ == 0 ? -1.0 : double(last_ns_ - command_ns_) * 1e-9);
    send(status_, status);
    geometry_msgs::msg::TransformStamped transform;
    transform.header(conversions::make_header(last_ns_));
    transform.child_frame_id(std::string(conversions::kBodyFrame));
    transform.transform().translation(conversions::to_vector(quadrotor_.state().position_map));
    transform.transform().rotation(conversions::to_msg(quadrotor_.state().q_map_base));
    tf2_msgs::msg::TFMessage tf;
    tf.transforms().push_back(transform);
    send(tf_, tf);
  }

  template <typename Message>
  void send(const Publisher<Message>& publisher, const Message& message) {
    if (auto status = publisher.publish(message); !status) reporter_.fault(status.error());
  }

  Node& node_;
  ComponentConfig config_;
  Quadrotor quadrotor_;
  StageReporter reporter_;
  Publisher<nav_msgs::msg::Odometry> odometry_;
  Publisher<msg::VehicleStatus> status_;
  Publisher<tf2_msgs::msg::TFMessage> tf_;
  nav_msgs::msg::Odometry odometry_message_;
  std::int64_t last_ns_ = 0;
  std::int64_t command_ns_ = 0;
  std::int64_t complained_ns_ = 0;
};

}  // namespace
}  // namespace goshawk::simulator

GOSHAWK_REGISTER_COMPONENT(goshawk::simulator::SimulatorComponent,
                           goshawk::simulator::ComponentConfig)
