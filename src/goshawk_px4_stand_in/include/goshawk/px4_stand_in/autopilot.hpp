#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "goshawk/px4_stand_in/airframe.hpp"
#include "goshawk/px4_stand_in/external_mode.hpp"
#include "goshawk/px4_stand_in/local_frame.hpp"
#include "goshawk/px4_stand_in/position_control.hpp"
#include "goshawk/px4_stand_in/wire.hpp"

namespace goshawk::px4_stand_in {

/// PX4's part of a flight, as a program beside it sees it: what it accepts and refuses, when it
/// loses patience and what it does then, and how it flies. It has no GNSS: where PX4 would return
/// home it lands. Time is an argument; the same calls give the same bits. Written from PX4's
/// documentation and observed behaviour.
///
///     autopilot.hear(command);          // whatever comes on fmu/in
///     autopilot.advance(now_ns);        // sends what is due
class Autopilot {
 public:
  /// @return invalid_parameter with every fault of the configuration
  static Result<Autopilot> create(const Config& config, Wire& wire, std::int64_t now_ns);

  void hear(const px4::VehicleCommand& m);
  void hear(const px4::OffboardControlMode& m);
  void hear(const px4::TrajectorySetpoint& m);
  void hear(const px4::VehicleAttitudeSetpoint& m);
  void hear(const px4::MessageFormatRequest& m);
  void hear(const px4::RegisterExtComponentRequest& m) { external_.hear(m, armed_, *wire_); }
  void hear(const px4::UnregisterExtComponent& m) { external_.hear(m, armed_); }
  void hear(const px4::ArmingCheckReply& m) { external_.hear(m); }
  void hear(const px4::VehicleControlMode& m);
  void hear(const px4::SetpointConfig& m);

  /// Lets time pass until then, in steps of Airframe::kStep_s.
  void advance(std::int64_t now_ns);

  /// Its estimate jumps, as EKF2's may: new position minus old [m], new heading minus old [rad],
  /// NED.
  void reset_estimate(const Vec3& delta_ned, double delta_heading);
  /// Charge, sticks and claimed uncertainty may change as it runs.
  void reconfigure(const Config& config) { config_ = config; }

  const RigidBodyState& truth() const { return airframe_.state(); }
  std::uint8_t nav_state() const { return nav_state_; }
  bool armed() const { return armed_; }
  bool failsafe() const { return failsafe_; }
  bool landed() const { return landed_; }
  double touched_m_s() const { return airframe_.touched_m_s(); }

 private:
  enum class Lift { off, spooling, ready, ramping, flying };
  /// A setpoint that comes to rest by itself. NED.
  struct Glide {
    Vec3 position = Vec3::Zero();
    Vec3 velocity = Vec3::Zero();
    double yaw_rad = 0.0;
  };
  struct Due {
    std::int64_t period_ns;
    std::int64_t next_ns = 0;
  };

  Autopilot(const Config& config, Airframe airframe, Wire& wire, std::int64_t now_ns);

  // commander.cpp: who decides
  void answer(const px4::VehicleCommand& m, std::uint8_t result);
  std::uint8_t select(std::uint8_t mode);
  std::uint8_t arm(bool wanted);
  bool can_run(std::uint8_t mode) const;
  bool offboard_alive() const;
  std::uint8_t effective_mode();
  void decide();
  void disarm();
  void disarm_if_done();

  // autopilot.cpp: how it flies
  LocalState local() const;
  double yaw() const;
  void step();
  void fly();
  void lift(const px4::TrajectorySetpoint& wanted);
  void begin_glide();
  px4::TrajectorySetpoint glide_setpoint();
  px4::TrajectorySetpoint wanted_setpoint();
  bool flies_attitude() const;
  bool wants_up(const px4::TrajectorySetpoint& wanted) const;

  // telemetry.cpp: what it publishes
  void report();
  bool due(Due& what);
  std::uint64_t stamp_us() const { return std::uint64_t(now_ns_ - boot_ns_) / 1000; }
  px4::VehicleStatus status() const;
  px4::VehicleLocalPosition local_position() const;
  px4::VehicleOdometry odometry() const;
  px4::BatteryStatus battery() const;

  Config config_;
  Airframe airframe_;
  Wire* wire_;
  LocalFrame frame_;
  PositionControl control_;
  ExternalMode external_;
  std::int64_t boot_ns_, now_ns_;

  bool armed_ = false, failsafe_ = false, landed_ = true, flew_ = false, lost_external_ = false;
  std::uint8_t intention_ = px4::nav_state::kHold, nav_state_ = px4::nav_state::kHold;
  int failed_armings_ = 0, recoveries_ = 0;
  std::int64_t armed_ns_ = 0, landed_ns_ = 0, activated_ns_ = 0;

  Lift lift_ = Lift::off;
  std::int64_t lift_ns_ = 0;
  Glide glide_;
  double climb_to_ned_ = 0.0;
  px4::OffboardControlMode offboard_;
  std::optional<std::int64_t> offboard_ns_;
  px4::TrajectorySetpoint trajectory_;
  std::optional<std::int64_t> trajectory_ns_;
  px4::VehicleAttitudeSetpoint attitude_;
  std::optional<std::int64_t> attitude_ns_;
  bool external_attitude_ = false;

  std::uint8_t xy_resets_ = 0, z_resets_ = 0, heading_resets_ = 0, all_resets_ = 0;
  Vec3 delta_ned_ = Vec3::Zero();
  double delta_heading_ = 0.0;
  px4::VehicleStatus said_;
  bool said_landed_ = false;
  Due status_due_{500'000'000}, land_due_{1'000'000'000}, battery_due_{1'000'000'000},
      flags_due_{500'000'000}, sticks_due_{40'000'000}, local_due_{20'000'000},
      odometry_due_{10'000'000};
};

}  // namespace goshawk::px4_stand_in
