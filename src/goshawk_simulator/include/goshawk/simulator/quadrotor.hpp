#pragma once

#include <cstdint>

#include "goshawk/core/landing.hpp"
#include "goshawk/simulator/config.hpp"
#include "goshawk/simulator/mixer.hpp"
#include "goshawk/simulator/plant.hpp"
#include "goshawk/simulator/position_hold.hpp"
#include "goshawk/simulator/sensor.hpp"
#include "goshawk/simulator/wind.hpp"

namespace goshawk::simulator {

/// Who flies: the commands that come in, or the onboard controller by itself: it holds, then lands.
enum class Control { commanded, failsafe, landing };

/// A simulated quadrotor with its autopilot: plant, onboard attitude loop and failsafe, all at
/// 1 kHz. It hovers from the start; commands take over; when none came for command_timeout_s it
/// brakes and hovers where that ends, and after failsafe_hold_s it lands there, where the map shows
/// the way down free, until commands come again. Before the first command it only hovers. Same
/// calls, same bits.
///
///     auto quadrotor = Quadrotor::create(config);
///     quadrotor->reset({3, 0, 1}, 0.0);
///     quadrotor->command(tracker_output);   // at any rate
///     quadrotor->advance(0.004);
///     publish(quadrotor->measure());
class Quadrotor {
 public:
  using Config = simulator::Config;
  using Control = simulator::Control;
  static constexpr std::int64_t kStep_ns = 1'000'000;

  /// @param make_plant what is flown: our own rigid body, or another
  /// @return invalid_parameter with every fault of the configuration
  static Result<Quadrotor> create(const Config& config,
                                  const plant::PlantFactory& make_plant = make_rigid_body);

  /// The wind may change in flight, nothing else.
  /// @return invalid_parameter: as create(), or for another part of the config; then as before
  Status reconfigure(const Config& config);

  /// Hover at rest with the motors at hover speed; commands, failsafe and gusts begin anew, time
  /// runs on. @return invalid_input when not finite
  Status reset(const Vec3& position_map, double yaw_rad);

  /// Takes effect with the next step. A refused command changes nothing: the last good one stays
  /// and its timeout runs on. Thrust and torque beyond the motors' power are cut by the mixer.
  /// @return invalid_input: a number is not finite, thrust is negative, the quaternion is not of
  /// unit length (1e-3), or a body rate is above 100 rad/s
  Status command(const ThrustAttitude& command);

  /// What a landing looks at; needs_map() tells when. Where a newer one shows the way down blocked,
  /// a landing stops, and the vehicle hovers where it is. @pre grid->check() ok
  void set_map(std::shared_ptr<const VoxelGrid> grid);
  /// Commands are lost, and there is no map yet.
  bool needs_map() const {
    return control_ == Control::failsafe && was_commanded_ && guard_.needs_map();
  }
  /// Why it holds though it should have landed by now; ok where that is not so.
  const Error& not_landing() const { return not_landing_; }

  /// Lets time pass in whole steps of 1 ms. What is left of dt_s is kept, in nanoseconds, for the
  /// next call: a thousand calls of 0.0004 s are 400 steps.
  /// @param dt_s [s] in [0, 3600], rounded to a nanosecond @return invalid_input else
  Status advance(double dt_s);

  /// The truth.
  const RigidBodyState& state() const { return plant_->state().body; }
  /// What the estimator says: late and noisy, as configured. Draws noise each time it is asked.
  Measurement measure() { return sensor_.measure(); }
  Vec3 acceleration_map() const { return plant_->acceleration_map(wind_.velocity_map()); }
  Vec4 rotor_thrust_n() const;
  Vec3 wind_map() const { return wind_.velocity_map(); }
  /// [ns] simulated time since creation: whole steps only
  std::int64_t time_ns() const { return time_ns_; }
  Control control() const { return control_; }
  const Config& config() const { return config_; }
  const char* plant_name() const { return plant_->name(); }

 private:
  Quadrotor(const Config& config, const plant::PlantFactory& make_plant);
  void step();
  ThrustAttitude onboard_target();
  void learn_disturbance(const Vec3& last_velocity_map);
  void watch_commands();
  void try_to_land();

  Config config_;
  std::unique_ptr<plant::PlantModel> plant_;
  Mixer mixer_;
  Eigen::Matrix3d inertia_kg_m2_;
  Wind wind_;
  Sensor sensor_;
  PositionHold hold_;
  LandingGuard guard_;
  Vec3 disturbance_map_ = Vec3::Zero();  // [m/s^2] as its inertial sensors tell, smoothed
  Error not_landing_{ErrorCode::ok, ""};
  ThrustAttitude command_;
  Control control_ = Control::failsafe;
  std::int64_t time_ns_ = 0;
  std::int64_t remainder_ns_ = 0;
  std::int64_t command_time_ns_ = 0;
  std::int64_t command_timeout_ns_;
  std::int64_t landing_ns_;  // after the last command
  bool was_commanded_ = false;
};

}  // namespace goshawk::simulator
