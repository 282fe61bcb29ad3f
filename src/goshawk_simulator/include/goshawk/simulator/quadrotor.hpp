#pragma once

#include <cstdint>

#include "goshawk/core/landing.hpp"
#include "goshawk/simulator/config.hpp"
#include "goshawk/simulator/fallback_pilot.hpp"
#include "goshawk/simulator/mixer.hpp"
#include "goshawk/simulator/plant.hpp"
#include "goshawk/simulator/position_hold.hpp"
#include "goshawk/simulator/sensor.hpp"
#include "goshawk/simulator/wind.hpp"

namespace goshawk::simulator {

/// Who flies: the commands that come in, or the onboard controller, which holds and then lands.
enum class Control { commanded, failsafe, landing };

/// A simulated quadrotor with its autopilot: plant, onboard attitude loop and failsafe, all at
/// 1 kHz. It hovers until commands come. When none came for command_timeout_s, it brakes, hovers
/// where that ends, and lands after failsafe_hold_s if the map shows the way down free; new
/// commands take over at any time. Before the first command it only hovers. The same calls give
/// the same bits.
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

  /// Only the wind may change in flight.
  /// @return invalid_parameter: as create(), or for another part of the config; then as before
  Status reconfigure(const Config& config);

  /// Hovers at rest with the motors at hover speed. Commands, failsafe and gusts start over; time
  /// does not. @return invalid_input if not finite
  Status reset(const Vec3& position_map, double yaw_rad);

  /// Takes effect with the next step. A refused command changes nothing: the last good one stays
  /// and its timeout runs on. The mixer limits thrust and torque to the motors' power.
  /// @return invalid_input: a number is not finite, thrust is negative, the quaternion is not of
  /// unit length (1e-3), or a body rate is above 100 rad/s
  Status command(const AttitudeSetpoint& command);

  /// What to fly if commands stop coming. @return as FallbackPilot::offer()
  Status set_fallback(FallbackStop stop) {
    return fallback_.offer(std::move(stop), state(), time_ns_);
  }
  /// Commands are lost, and it is on the fallback stop.
  bool flies_fallback() const { return flies_fallback_; }

  /// The map that a landing checks; needed when needs_map(). If a newer one shows the way down
  /// blocked, a landing stops and the vehicle hovers. @pre grid->check() ok
  void set_map(std::shared_ptr<const VoxelGrid> grid);
  /// Commands are lost, and there is no map yet.
  bool needs_map() const {
    return control_ == Control::failsafe && was_commanded_ && guard_.needs_map();
  }
  /// Why it still holds although it should land; ok: no reason.
  const Error& not_landing() const { return not_landing_; }

  /// Lets time pass in whole steps of 1 ms. What is left of dt_s is kept, in nanoseconds, for the
  /// next call: a thousand calls of 0.0004 s are 400 steps.
  /// @param dt_s [s] in [0, 3600], rounded to a nanosecond @return invalid_input otherwise
  Status advance(double dt_s);

  /// The truth.
  const RigidBodyState& state() const { return plant_->state().body; }
  /// The estimate: late and noisy, as configured. Draws new noise at each call.
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
  AttitudeSetpoint onboard_target();
  void learn_disturbance(const Vec3& last_velocity_map);
  void watch_commands();
  void lose_commands();
  void try_to_land();

  Config config_;
  std::unique_ptr<plant::PlantModel> plant_;
  Mixer mixer_;
  Eigen::Matrix3d inertia_kg_m2_;
  Wind wind_;
  Sensor sensor_;
  PositionHold hold_;
  FallbackPilot fallback_;
  bool flies_fallback_ = false;
  LandingGuard guard_;
  Vec3 disturbance_map_ = Vec3::Zero();  // [m/s^2] from the inertial sensors, smoothed
  Error not_landing_{ErrorCode::ok, ""};
  AttitudeSetpoint command_;
  Control control_ = Control::failsafe;
  std::int64_t time_ns_ = 0;
  std::int64_t remainder_ns_ = 0;
  std::int64_t command_time_ns_ = 0;
  std::int64_t command_timeout_ns_;
  std::int64_t landing_ns_;  // after the last command
  bool was_commanded_ = false;
};

}  // namespace goshawk::simulator
