#pragma once

#include "goshawk/px4_wire/messages.hpp"

namespace goshawk::px4 {

/// What a mode of PX4 that another program brings (an external mode) says and hears.

struct RegisterExtComponentRequest {
  static constexpr std::string_view kType = "RegisterExtComponentRequest",
                                    kTopic = "in/register_ext_component_request";
  std::uint64_t request_id = 0;
  Name name{};
  std::uint16_t px4_ros2_api_version = 1;
  bool register_arming_check = true, register_mode = true;

  template <typename Self, typename Visitor>
  static void fields(Self& m, Visitor& visit) {
    visit("request_id", m.request_id);
    visit("name", m.name);
    visit("px4_ros2_api_version", m.px4_ros2_api_version);
    visit("register_arming_check", m.register_arming_check);
    visit("register_mode", m.register_mode);
  }
};

struct RegisterExtComponentReply {
  static constexpr std::string_view kType = "RegisterExtComponentReply",
                                    kTopic = "out/register_ext_component_reply";
  std::uint64_t request_id = 0;
  Name name{};
  std::uint16_t px4_ros2_api_version = 1;
  bool success = false;
  std::int8_t arming_check_id = -1, mode_id = -1, mode_executor_id = -1;

  template <typename Self, typename Visitor>
  static void fields(Self& m, Visitor& visit) {
    visit("request_id", m.request_id);
    visit("name", m.name);
    visit("px4_ros2_api_version", m.px4_ros2_api_version);
    visit("success", m.success);
    visit("arming_check_id", m.arming_check_id);
    visit("mode_id", m.mode_id);
    visit("mode_executor_id", m.mode_executor_id);
  }
};

struct UnregisterExtComponent {
  static constexpr std::string_view kType = "UnregisterExtComponent",
                                    kTopic = "in/unregister_ext_component";
  Name name{};
  std::int8_t arming_check_id = -1, mode_id = -1, mode_executor_id = -1;

  template <typename Self, typename Visitor>
  static void fields(Self& m, Visitor& visit) {
    visit("name", m.name);
    visit("arming_check_id", m.arming_check_id);
    visit("mode_id", m.mode_id);
    visit("mode_executor_id", m.mode_executor_id);
  }
};

struct ArmingCheckRequest {
  static constexpr std::string_view kType = "ArmingCheckRequest",
                                    kTopic = "out/arming_check_request";
  std::uint8_t request_id = 0;
  std::uint32_t valid_registrations_mask = 0xffffffff;  // before 1.17 PX4 does not say

  template <typename Self, typename Visitor>
  static void fields(Self& m, Visitor& visit) {
    visit("request_id", m.request_id);
    visit.optional("valid_registrations_mask", m.valid_registrations_mask);
  }
};

struct ArmingCheckReply {
  static constexpr std::string_view kType = "ArmingCheckReply", kTopic = "in/arming_check_reply";
  std::uint8_t request_id = 0, registration_id = 0;
  bool can_arm_and_run = false;
  bool mode_req_angular_velocity = true, mode_req_attitude = true, mode_req_local_alt = true,
       mode_req_local_position = true;

  template <typename Self, typename Visitor>
  static void fields(Self& m, Visitor& visit) {
    visit("request_id", m.request_id);
    visit("registration_id", m.registration_id);
    visit("can_arm_and_run", m.can_arm_and_run);
    visit("mode_req_angular_velocity", m.mode_req_angular_velocity);
    visit("mode_req_attitude", m.mode_req_attitude);
    visit("mode_req_local_alt", m.mode_req_local_alt);
    visit("mode_req_local_position", m.mode_req_local_position);
  }
};

/// Up to 1.17: which controllers run below the mode.
struct VehicleControlMode {
  static constexpr std::string_view kType = "VehicleControlMode",
                                    kTopic = "in/config_control_setpoints";
  bool position = true, velocity = true, altitude = true, climb_rate = true, acceleration = true;
  bool attitude = true, rates = true, allocation = true;
  std::uint8_t source_id = 0;

  template <typename Self, typename Visitor>
  static void fields(Self& m, Visitor& visit) {
    visit("flag_control_position_enabled", m.position);
    visit("flag_control_velocity_enabled", m.velocity);
    visit("flag_control_altitude_enabled", m.altitude);
    visit("flag_control_climb_rate_enabled", m.climb_rate);
    visit.optional("flag_control_acceleration_enabled", m.acceleration);
    visit("flag_control_attitude_enabled", m.attitude);
    visit("flag_control_rates_enabled", m.rates);
    visit("flag_control_allocation_enabled", m.allocation);
    visit.optional("source_id", m.source_id);
  }
};

/// From 1.18 on, in place of VehicleControlMode.
struct SetpointConfig {
  static constexpr std::string_view kType = "SetpointConfig", kTopic = "in/setpoint_config";
  static constexpr std::uint16_t kTrajectory = 4, kAttitude = 6;
  std::uint16_t type = kTrajectory;
  std::uint8_t source_id = 0;
  bool should_apply = false;
  std::uint16_t timeout_ms = 0;

  template <typename Self, typename Visitor>
  static void fields(Self& m, Visitor& visit) {
    visit("type", m.type);
    visit("source_id", m.source_id);
    visit("should_apply", m.should_apply);
    visit("timeout_ms", m.timeout_ms);
  }
};

struct SetpointConfigReply {
  static constexpr std::string_view kType = "SetpointConfigReply",
                                    kTopic = "out/setpoint_config_reply";
  std::uint16_t type = 0;
  std::uint8_t source_id = 0;
  std::uint8_t result = 0;  // 0: it is so

  template <typename Self, typename Visitor>
  static void fields(Self& m, Visitor& visit) {
    visit("type", m.type);
    visit("source_id", m.source_id);
    visit("result", m.result);
  }
};

}  // namespace goshawk::px4
