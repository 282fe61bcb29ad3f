#pragma once

#include "goshawk/px4_wire/messages.hpp"

namespace goshawk::px4 {

/// What we send to PX4 beside what a mode needs (mode_messages.hpp).

struct VehicleCommand {
  static constexpr std::string_view kType = "VehicleCommand", kTopic = "in/vehicle_command";
  static constexpr std::uint32_t kLand = 21, kArm = 400, kSetNavState = 100001;
  float param1 = 0.0f, param2 = 0.0f;
  std::uint32_t command = 0;
  std::uint8_t target_system = 0, target_component = 0, source_system = 0;
  std::uint16_t source_component = 0;
  bool from_external = true;

  template <typename Self, typename Visitor>
  static void fields(Self& m, Visitor& visit) {
    visit("param1", m.param1);
    visit("param2", m.param2);
    visit("command", m.command);
    visit("target_system", m.target_system);
    visit("target_component", m.target_component);
    visit("source_system", m.source_system);
    visit("source_component", m.source_component);
    visit("from_external", m.from_external);
  }
};

struct OffboardControlMode {
  static constexpr std::string_view kType = "OffboardControlMode",
                                    kTopic = "in/offboard_control_mode";
  bool position = false, velocity = false, acceleration = false, attitude = false;

  template <typename Self, typename Visitor>
  static void fields(Self& m, Visitor& visit) {
    visit("position", m.position);
    visit("velocity", m.velocity);
    visit("acceleration", m.acceleration);
    visit("attitude", m.attitude);
  }
};

struct TrajectorySetpoint {
  static constexpr std::string_view kType = "TrajectorySetpoint", kTopic = "in/trajectory_setpoint";
  Vec3f position = kNoVector, velocity = kNoVector, acceleration = kNoVector, jerk = kNoVector;
  float yaw = kNan;       // [rad]
  float yawspeed = kNan;  // [rad/s]

  template <typename Self, typename Visitor>
  static void fields(Self& m, Visitor& visit) {
    visit("position", m.position);
    visit("velocity", m.velocity);
    visit("acceleration", m.acceleration);
    visit("jerk", m.jerk);
    visit("yaw", m.yaw);
    visit("yawspeed", m.yawspeed);
  }
};

struct VehicleAttitudeSetpoint {
  static constexpr std::string_view kType = "VehicleAttitudeSetpoint",
                                    kTopic = "in/vehicle_attitude_setpoint";
  std::array<float, 4> q_d{1.0f, 0.0f, 0.0f, 0.0f};
  Vec3f thrust_body{0.0f, 0.0f, 0.0f};  // FRD, -1 to 1: up is negative z

  template <typename Self, typename Visitor>
  static void fields(Self& m, Visitor& visit) {
    visit("q_d", m.q_d);
    visit("thrust_body", m.thrust_body);
  }
};

struct MessageFormatRequest {
  static constexpr std::string_view kType = "MessageFormatRequest",
                                    kTopic = "in/message_format_request";
  static constexpr std::uint16_t kProtocol = 1;
  std::uint16_t protocol_version = kProtocol;
  TopicName topic_name{};

  template <typename Self, typename Visitor>
  static void fields(Self& m, Visitor& visit) {
    visit("protocol_version", m.protocol_version);
    visit("topic_name", m.topic_name);
  }
};

struct MessageFormatResponse {
  static constexpr std::string_view kType = "MessageFormatResponse",
                                    kTopic = "out/message_format_response";
  std::uint16_t protocol_version = MessageFormatRequest::kProtocol;
  TopicName topic_name{};
  bool success = false;
  std::uint32_t message_hash = 0;

  template <typename Self, typename Visitor>
  static void fields(Self& m, Visitor& visit) {
    visit("protocol_version", m.protocol_version);
    visit("topic_name", m.topic_name);
    visit("success", m.success);
    visit("message_hash", m.message_hash);
  }
};

}  // namespace goshawk::px4
