#pragma once

#include <algorithm>
#include <cmath>
#include <optional>

#include "goshawk/conversions/vehicle.hpp"
#include "goshawk/runtime/component.hpp"
#include "goshawk/runtime/lock_step.hpp"
#include "goshawk/runtime/map_subscription.hpp"
#include "goshawk/runtime/stage_reporter.hpp"
#include "goshawk/simulator/quadrotor.hpp"
#include "tf2_msgs.h"

namespace goshawk::simulator {

/// What the component of a plant needs beyond the plant.
struct ComponentConfig {
  Config plant;
  double start_x_m = 3.0;
  double start_y_m = 0.0;
  double start_z_m = 1.0;
  double start_yaw_rad = 0.0;
  double rate_hz = 250.0;
  std::string lock_step_nodes;
  double speed = 1.0;
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
  visit("lock_step_nodes", c.lock_step_nodes, "",
        "names with commas of the nodes that run in lock step with this plant, in the order of "
        "their turns; empty: real time",
        Anything{});
  visit("speed", c.speed, "",
        "in lock step: simulated seconds for a second of the machine's time, at the most; 0: as "
        "fast as the nodes can",
        Range{0.0, 1000.0});
  describe(c.plant, visit);
}

/// command -> odom, vehicle_status, /tf, with whatever plant; in real time, or as the clock of
/// nodes in lock step. With sensor noise or delay, `odom_true` has the truth, for judges.
class PlantComponent : public runtime::Component {
 public:
  PlantComponent(runtime::Node& node, const PlantFactory& make_plant)
      : node_(node),
        config_(node.parameters<ComponentConfig>(
            [this](const ComponentConfig& c) { return reconfigure(c); })),
        quadrotor_(make_quadrotor(config_, make_plant)),
        reporter_(node, quadrotor_.plant_name()),
        odometry_(node.advertise<nav_msgs::msg::Odometry>("odom", runtime::Qos::best_effort())),
        status_(node.advertise<goshawk_msgs::msg::VehicleStatus>("vehicle_status",
                                                                 runtime::Qos::best_effort())),
        tf_(node.advertise<tf2_msgs::msg::TFMessage>("/tf", runtime::Qos::best_effort(10))) {
    if (!config_.plant.sensor.is_perfect()) {
      truth_ = node.advertise<nav_msgs::msg::Odometry>("odom_true", runtime::Qos::best_effort());
    }
    node.subscribe<goshawk_msgs::msg::ThrustAttitude>(
        "command", runtime::Qos::best_effort(),
        [this](const goshawk_msgs::msg::ThrustAttitude& m, const runtime::MessageInfo& info) {
          on_command(m, info);
        });
    const double period_s = 1.0 / config_.rate_hz;
    if (const auto followers = runtime::split_names(config_.lock_step_nodes); !followers.empty()) {
      node.lead_lock_step({.followers = followers, .step_s = period_s, .speed = config_.speed});
    }
    last_ns_ = node.now_ns();
    node.every(period_s, [this] { step(); });
    node.every(0.05, [this] { publish_slow(); });
    reporter_.ready("hovers at " + to_text(quadrotor_.state().position_map));
  }

 private:
  static Quadrotor make_quadrotor(const ComponentConfig& config, const PlantFactory& make_plant) {
    auto quadrotor = Quadrotor::create(config.plant, make_plant);
    if (!quadrotor) throw runtime::StartupFault(quadrotor.error());
    auto status = quadrotor->reset({config.start_x_m, config.start_y_m, config.start_z_m},
                                   config.start_yaw_rad);
    if (!status) throw runtime::StartupFault(status.error());
    return *std::move(quadrotor);
  }

  Status reconfigure(const ComponentConfig& config) {
    if (auto status = quadrotor_.reconfigure(config.plant); !status) return status;
    config_ = config;
    return success();
  }

  void on_command(const goshawk_msgs::msg::ThrustAttitude& m, const runtime::MessageInfo& info) {
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
    // In a turn that somebody else gives it, the plant has no time before its first step.
    if (last_ns_ == 0) last_ns_ = now_ns - std::llround(1e9 / config_.rate_hz);
    // After a pause (a stopped machine, a clock that was set) the world goes on, it does not jump.
    const double dt_s = std::clamp(double(now_ns - last_ns_) * 1e-9, 0.0, 0.1);
    last_ns_ = now_ns;
    if (auto status = quadrotor_.advance(dt_s); !status)
      throw std::logic_error(status.error().message);
    const Measurement measured = quadrotor_.measure();
    // The plant counts its own time; what is old there is as old here.
    const std::int64_t age_ns = quadrotor_.time_ns() - measured.time_ns;
    odometry_message_.header().stamp(conversions::to_stamp(now_ns - age_ns));
    conversions::fill_msg(measured.state, odometry_message_);
    send(odometry_, odometry_message_);
    if (!config_.plant.sensor.is_perfect()) {
      odometry_message_.header().stamp(conversions::to_stamp(now_ns));
      conversions::fill_msg(quadrotor_.state(), odometry_message_);
      send(truth_, odometry_message_);
    }
  }

  // Who lost control says so, once each time.
  void report_control() {
    const Control control = quadrotor_.control();
    const std::string place = to_text(quadrotor_.state().position_map) + " m";
    if (control == Control::landing && said_ != control) {
      reporter_.fault(fail(ErrorCode::tracking_lost, "still no commands: landing at " + place));
    } else if (control == Control::failsafe && said_ == Control::commanded) {
      reporter_.fault(fail(ErrorCode::tracking_lost,
                           "commands stopped coming: braking and holding; landing after " +
                               std::to_string(config_.plant.failsafe_hold_s) +
                               " s, where that is free"));
    }
    said_ = control;
    const Error& why = quadrotor_.not_landing();
    if (why.code != ErrorCode::ok && why.message != said_why_) {
      reporter_.fault(fail(why.code, "still no commands, and instead of landing it holds at " +
                                         place + ": " + why.message));
    }
    said_why_ = why.message;
  }

  void publish_slow() {
    report_control();
    // Not before: a large map would keep the plant waiting while it is taken in.
    if (quadrotor_.needs_map() && !map_) {
      map_.emplace(node_, reporter_, [this](const auto& grid) { quadrotor_.set_map(grid); });
    }
    goshawk_msgs::msg::VehicleStatus status;
    status.header(conversions::make_header(last_ns_));
    status.failsafe(quadrotor_.control() != Control::commanded);
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
  void send(const runtime::Publisher<Message>& publisher, const Message& message) {
    if (auto status = publisher.publish(message); !status) reporter_.fault(status.error());
  }

  runtime::Node& node_;
  ComponentConfig config_;
  Quadrotor quadrotor_;
  runtime::StageReporter reporter_;
  runtime::Publisher<nav_msgs::msg::Odometry> odometry_;
  runtime::Publisher<nav_msgs::msg::Odometry> truth_;
  runtime::Publisher<goshawk_msgs::msg::VehicleStatus> status_;
  runtime::Publisher<tf2_msgs::msg::TFMessage> tf_;
  nav_msgs::msg::Odometry odometry_message_;
  std::optional<runtime::MapSubscription> map_;
  Control said_ = Control::failsafe;
  std::string said_why_;
  std::int64_t last_ns_ = 0;
  std::int64_t command_ns_ = 0;
  std::int64_t complained_ns_ = 0;
};

}  // namespace goshawk::simulator
