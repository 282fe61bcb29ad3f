#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <stdexcept>

#include "goshawk/conversions/vehicle.hpp"
#include "goshawk/plant/world_time.hpp"
#include "goshawk/runtime/component.hpp"
#include "goshawk/runtime/lock_step.hpp"
#include "goshawk/stage/map_subscription.hpp"
#include "goshawk/stage/plant_config.hpp"
#include "goshawk/stage/plant_topics.hpp"

namespace goshawk::stage {

/// The component of a simulated plant: command, fallback_stop -> odom, vehicle_status, /tf, in real
/// time (by the monotonic clock; stamps are the wall clock's) or as the clock of nodes in lock
/// step. With sensor noise or delay, `odom_true` has the truth.
///
/// @tparam Vehicle flies: simulator::Quadrotor's functions. A parameter of the template, so that
///         this package knows no plant
template <typename Vehicle>
class PlantComponent : public runtime::Component {
 public:
  using Config = SimulatedPlantConfig<typename Vehicle::Config>;

  /// @param make_plant what Vehicle::create() takes beside its configuration
  template <typename MakePlant>
  PlantComponent(runtime::Node& node, const MakePlant& make_plant)
      : node_(node),
        config_(node.parameters<Config>([this](const Config& c) { return reconfigure(c); })),
        vehicle_(make_vehicle(config_, make_plant)),
        reporter_(node, StageRole::vehicle, vehicle_.plant_name()),
        topics_(node, reporter_, !config_.vehicle.sensor.is_perfect()) {
    node.subscribe<goshawk_msgs::msg::AttitudeSetpoint>(
        "command", runtime::Qos::best_effort(),
        [this](const goshawk_msgs::msg::AttitudeSetpoint& m, const runtime::MessageInfo&) {
          on_command(m);
        },
        runtime::Writers::one("command"));
    node.subscribe<goshawk_msgs::msg::FallbackStop>(
        "fallback_stop", runtime::Qos::best_effort(),
        [this](const goshawk_msgs::msg::FallbackStop& m, const runtime::MessageInfo&) {
          on_fallback(m);
        },
        runtime::Writers::one("command"));
    const double period_s = 1.0 / config_.plant.rate_hz;
    const auto followers = runtime::split_names(config_.plant.lock_step_nodes);
    if (!followers.empty()) {
      node.lead_lock_step(
          {.followers = followers, .step_s = period_s, .speed = config_.plant.speed});
    }
    last_ns_ = node.monotonic_ns();
    node.every(period_s, [this] { step(); });
    node.every(0.05, [this] { publish_slow(); });
    reporter_.ready("hovers at " + to_text(vehicle_.state().position_map));
  }

 private:
  using Control = typename Vehicle::Control;

  template <typename MakePlant>
  static Vehicle make_vehicle(const Config& config, const MakePlant& make_plant) {
    auto vehicle = Vehicle::create(config.vehicle, make_plant);
    if (!vehicle) throw runtime::StartupFault(vehicle.error());
    const PlantConfig& at = config.plant;
    auto status = vehicle->reset({at.start_x_m, at.start_y_m, at.start_z_m}, at.start_yaw_rad);
    if (!status) throw runtime::StartupFault(status.error());
    return *std::move(vehicle);
  }

  Status reconfigure(const Config& config) {
    if (auto status = vehicle_.reconfigure(config.vehicle); !status) return status;
    config_ = config;
    return success();
  }

  void on_command(const goshawk_msgs::msg::AttitudeSetpoint& m) {
    const auto command = conversions::from_msg(m);
    const Status status = command ? vehicle_.command(*command) : command.error();
    if (!status) return reporter_.complain(status.error());
    command_ns_ = node_.monotonic_ns();
  }

  void on_fallback(const goshawk_msgs::msg::FallbackStop& m) {
    auto stop = conversions::from_msg(m);
    const Status status = stop ? vehicle_.set_fallback(*std::move(stop)) : stop.error();
    if (!status) reporter_.complain(status.error());
  }

  void step() {
    const std::int64_t now_ns = node_.monotonic_ns();
    // In a turn that another node leads, the plant has no time before its first step.
    if (last_ns_ == 0) last_ns_ = now_ns - std::llround(1e9 / config_.plant.rate_hz);
    const double gap_s = double(now_ns - last_ns_) * 1e-9;
    last_ns_ = now_ns;
    const double dt_s = plant::world_time_s(gap_s, 1.0 / config_.plant.rate_hz);
    if (auto status = vehicle_.advance(dt_s); !status)
      throw std::logic_error(status.error().message);
    const auto measured = vehicle_.measure();
    // The vehicle has its own clock; only the age of a measurement carries over.
    const std::int64_t stamp_ns = node_.now_ns();
    topics_.publish_odometry(measured.state, stamp_ns - (vehicle_.time_ns() - measured.time_ns));
    topics_.publish_truth(vehicle_.state(), stamp_ns);
  }

  void publish_slow() {
    report_control();
    // Not before: a large map would keep the plant waiting while it is taken in.
    if (vehicle_.needs_map() && !map_) {
      map_.emplace(node_, reporter_, [this](const auto& grid) { vehicle_.set_map(grid); });
    }
    publish_status();
    topics_.publish_pose(vehicle_.state(), node_.now_ns());
  }

  void publish_status() {
    namespace constants = goshawk_msgs::msg::VehicleStatus_Constants;
    const bool commanded = vehicle_.control() == Control::commanded;
    const bool was_commanded = command_ns_ != 0;
    goshawk_msgs::msg::VehicleStatus status;
    status.armed(true);  // it hovers from the start
    status.control(commanded ? constants::CONTROL_GOSHAWK : constants::CONTROL_AUTOPILOT);
    status.failsafe(was_commanded && !commanded);
    status.resets(0);  // a simulated position never jumps
    status.battery(-1.0);
    status.command_age(was_commanded ? double(last_ns_ - command_ns_) * 1e-9 : -1.0);
    topics_.publish_status(status, node_.now_ns());
  }

  /// Loss of control is reported once each time.
  void report_control() {
    const Control control = vehicle_.control();
    const std::string place = to_text(vehicle_.state().position_map) + " m";
    if (control == Control::landing && said_ != control) {
      reporter_.fault(fail(ErrorCode::tracking_lost, "still no commands: landing at " + place));
    } else if (control == Control::failsafe && said_ == Control::commanded) {
      reporter_.fault(fail(ErrorCode::tracking_lost,
                           fmt::format("commands stopped coming: braking {}, then holding; landing "
                                       "after {} s if the way down is free",
                                       vehicle_.flies_fallback() ? "on the tracker's fallback stop"
                                                                 : "straight ahead",
                                       config_.vehicle.failsafe_hold_s)));
    }
    said_ = control;
    const Error& why = vehicle_.not_landing();
    if (why.code != ErrorCode::ok && why.message != said_why_) {
      reporter_.fault(fail(why.code, "still no commands, and instead of landing it holds at " +
                                         place + ": " + why.message));
    }
    said_why_ = why.message;
  }

  runtime::Node& node_;
  Config config_;
  Vehicle vehicle_;
  StageReporter reporter_;
  PlantTopics topics_;
  std::optional<MapSubscription> map_;
  Control said_ = Control::failsafe;
  std::string said_why_;
  std::int64_t last_ns_ = 0;
  std::int64_t command_ns_ = 0;
};

}  // namespace goshawk::stage
