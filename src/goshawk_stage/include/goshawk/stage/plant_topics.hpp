#pragma once

#include <optional>

#include "goshawk/core/vehicle.hpp"
#include "goshawk/stage/stage_reporter.hpp"
#include "nav_msgs.h"
#include "tf2_msgs.h"

namespace goshawk::stage {

/// What every plant publishes: `odom`, `vehicle_status`, `/tf`, and `odom_true` where the plant
/// knows better than its sensors.
class PlantTopics {
 public:
  /// @param with_truth `odom` is noisy or late: `odom_true` carries the truth, for judges
  PlantTopics(runtime::Node& node, StageReporter& reporter, bool with_truth);

  /// @param stamp_ns when the state was true
  void publish_odometry(const RigidBodyState& state, std::int64_t stamp_ns);
  /// Does nothing without `odom_true`.
  void publish_truth(const RigidBodyState& state, std::int64_t stamp_ns);
  void publish_status(goshawk_msgs::msg::VehicleStatus status, std::int64_t stamp_ns);
  /// The transform from `map` to `base_link`.
  void publish_pose(const RigidBodyState& state, std::int64_t stamp_ns);

 private:
  StageReporter& reporter_;
  runtime::Publisher<nav_msgs::msg::Odometry> odometry_;
  std::optional<runtime::Publisher<nav_msgs::msg::Odometry>> truth_;
  runtime::Publisher<goshawk_msgs::msg::VehicleStatus> status_;
  runtime::Publisher<tf2_msgs::msg::TFMessage> tf_;
  nav_msgs::msg::Odometry message_;
};

}  // namespace goshawk::stage
