#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <string_view>

namespace goshawk::px4 {

/// What we read and write of PX4's messages: units SI, frames NED and FRD, NaN for "not known" and
/// "not controlled". Each struct lists its fields for the codec; those that are left out are sent
/// as zero. A field that only some releases have is named by `optional`.

inline constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
using Vec3f = std::array<float, 3>;
inline constexpr Vec3f kNoVector{kNan, kNan, kNan};
using Name = std::array<char, 25>;
using TopicName = std::array<char, 50>;

/// VehicleStatus::nav_state.
namespace nav_state {
inline constexpr std::uint8_t kManual = 0, kAltitude = 1, kPosition = 2, kHold = 4, kReturn = 5,
                              kDescend = 12, kTermination = 13, kOffboard = 14, kStabilized = 15,
                              kTakeoff = 17, kLand = 18, kExternal1 = 23, kExternal8 = 30;
}  // namespace nav_state

struct VehicleOdometry {
  static constexpr std::string_view kType = "VehicleOdometry", kTopic = "out/vehicle_odometry";
  static constexpr std::uint8_t kNed = 1;
  std::uint64_t timestamp_sample = 0;  // [us]
  std::uint8_t pose_frame = kNed;
  Vec3f position = kNoVector;                      // [m]
  std::array<float, 4> q{kNan, kNan, kNan, kNan};  // w, x, y, z: FRD to NED
  std::uint8_t velocity_frame = kNed;
  Vec3f velocity = kNoVector;          // [m/s]
  Vec3f angular_velocity = kNoVector;  // [rad/s] body FRD
  Vec3f position_variance = kNoVector;
  Vec3f orientation_variance = kNoVector;
  Vec3f velocity_variance = kNoVector;
  std::uint8_t reset_counter = 0;

  template <typename Self, typename Visitor>
  static void fields(Self& m, Visitor& visit) {
    visit("timestamp_sample", m.timestamp_sample);
    visit("pose_frame", m.pose_frame);
    visit("position", m.position);
    visit("q", m.q);
    visit("velocity_frame", m.velocity_frame);
    visit("velocity", m.velocity);
    visit("angular_velocity", m.angular_velocity);
    visit("position_variance", m.position_variance);
    visit("orientation_variance", m.orientation_variance);
    visit("velocity_variance", m.velocity_variance);
    visit("reset_counter", m.reset_counter);
  }
};

struct VehicleLocalPosition {
  static constexpr std::string_view kType = "VehicleLocalPosition",
                                    kTopic = "out/vehicle_local_position";
  std::uint64_t timestamp_sample = 0;  // [us]
  bool xy_valid = false, z_valid = false, v_xy_valid = false, v_z_valid = false;
  float x = kNan, y = kNan, z = kNan;         // [m] NED
  std::array<float, 2> delta_xy{0.0f, 0.0f};  // [m] of the newest reset: new minus old
  float delta_z = 0.0f;
  float delta_heading = 0.0f;  // [rad]
  std::uint8_t xy_reset_counter = 0, z_reset_counter = 0, heading_reset_counter = 0;
  float heading = kNan;  // [rad]
  bool heading_good_for_control = false;

  template <typename Self, typename Visitor>
  static void fields(Self& m, Visitor& visit) {
    visit("timestamp_sample", m.timestamp_sample);
    visit("xy_valid", m.xy_valid);
    visit("z_valid", m.z_valid);
    visit("v_xy_valid", m.v_xy_valid);
    visit("v_z_valid", m.v_z_valid);
    visit("x", m.x);
    visit("y", m.y);
    visit("z", m.z);
    visit("delta_xy", m.delta_xy);
    visit("delta_z", m.delta_z);
    visit("delta_heading", m.delta_heading);
    visit("xy_reset_counter", m.xy_reset_counter);
    visit("z_reset_counter", m.z_reset_counter);
    visit("heading_reset_counter", m.heading_reset_counter);
    visit("heading", m.heading);
    visit("heading_good_for_control", m.heading_good_for_control);
  }
};

struct VehicleStatus {
  static constexpr std::string_view kType = "VehicleStatus", kTopic = "out/vehicle_status";
  static constexpr std::uint8_t kDisarmed = 1, kArmed = 2, kRotary = 1;
  std::uint8_t arming_state = 0;
  std::uint8_t nav_state = 0;
  std::uint8_t nav_state_user_intention = 0;
  std::uint8_t vehicle_type = 0;
  bool failsafe = false;
  bool failsafe_and_user_took_over = false;
  std::uint8_t system_id = 0, component_id = 0;
  bool pre_flight_checks_pass = false;

  bool armed() const { return arming_state == kArmed; }
  bool operator==(const VehicleStatus&) const = default;

  template <typename Self, typename Visitor>
  static void fields(Self& m, Visitor& visit) {
    visit("arming_state", m.arming_state);
    visit("nav_state", m.nav_state);
    visit("nav_state_user_intention", m.nav_state_user_intention);
    visit("vehicle_type", m.vehicle_type);
    visit("failsafe", m.failsafe);
    visit("failsafe_and_user_took_over", m.failsafe_and_user_took_over);
    visit("system_id", m.system_id);
    visit("component_id", m.component_id);
    visit("pre_flight_checks_pass", m.pre_flight_checks_pass);
  }
};

struct VehicleLandDetected {
  static constexpr std::string_view kType = "VehicleLandDetected",
                                    kTopic = "out/vehicle_land_detected";
  bool landed = false;

  template <typename Self, typename Visitor>
  static void fields(Self& m, Visitor& visit) {
    visit("landed", m.landed);
  }
};

struct BatteryStatus {
  static constexpr std::string_view kType = "BatteryStatus", kTopic = "out/battery_status";
  static constexpr std::uint8_t kLow = 1, kCritical = 2;
  bool connected = false;
  float remaining = kNan;    // 0 to 1
  std::uint8_t warning = 0;  // none, low, critical, emergency, failed

  template <typename Self, typename Visitor>
  static void fields(Self& m, Visitor& visit) {
    visit("connected", m.connected);
    visit("remaining", m.remaining);
    visit("warning", m.warning);
  }
};

/// What PX4 finds wrong: its reasons not to arm, as far as it tells them over DDS.
struct FailsafeFlags {
  static constexpr std::string_view kType = "FailsafeFlags", kTopic = "out/failsafe_flags";
  bool attitude_invalid = false, local_position_invalid = false, local_velocity_invalid = false;
  bool offboard_control_signal_lost = false, manual_control_signal_lost = false;
  bool battery_unhealthy = false, geofence_breached = false, fd_critical_failure = false;

  template <typename Self, typename Visitor>
  static void fields(Self& m, Visitor& visit) {
    visit("attitude_invalid", m.attitude_invalid);
    visit("local_position_invalid", m.local_position_invalid);
    visit("local_velocity_invalid", m.local_velocity_invalid);
    visit("offboard_control_signal_lost", m.offboard_control_signal_lost);
    visit("manual_control_signal_lost", m.manual_control_signal_lost);
    visit("battery_unhealthy", m.battery_unhealthy);
    visit("geofence_breached", m.geofence_breached);
    visit("fd_critical_failure", m.fd_critical_failure);
  }
};

struct ManualControlSetpoint {
  static constexpr std::string_view kType = "ManualControlSetpoint",
                                    kTopic = "out/manual_control_setpoint";
  bool valid = false;
  bool sticks_moving = false;

  template <typename Self, typename Visitor>
  static void fields(Self& m, Visitor& visit) {
    visit("valid", m.valid);
    visit("sticks_moving", m.sticks_moving);
  }
};

struct VehicleCommandAck {
  static constexpr std::string_view kType = "VehicleCommandAck", kTopic = "out/vehicle_command_ack";
  std::uint32_t command = 0;
  std::uint8_t result = 0;             // 0 accepted, 1 temporarily rejected, 2 denied, ...
  std::uint16_t target_component = 0;  // source_component of the command

  template <typename Self, typename Visitor>
  static void fields(Self& m, Visitor& visit) {
    visit("command", m.command);
    visit("result", m.result);
    visit("target_component", m.target_component);
  }
};

}  // namespace goshawk::px4
