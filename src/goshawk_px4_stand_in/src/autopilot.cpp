#include "goshawk/px4_stand_in/autopilot.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "goshawk/px4_wire/frames.hpp"

// How it flies.

namespace goshawk::px4_stand_in {

using namespace px4;

namespace {

constexpr std::int64_t kStep_ns = std::int64_t(Airframe::kStep_s * 1e9);
constexpr double kBrake_m_s2 = 3.0;        // MPC_ACC_HOR
constexpr double kLandSpeed_m_s = 0.7;     // MPC_LAND_SPEED
constexpr double kTakeoffSpeed_m_s = 1.5;  // MPC_TKO_SPEED
constexpr std::int64_t kFresh_ns = 1'000'000'000;

// Each axis needs a position, a velocity or an acceleration.
bool is_valid(const TrajectorySetpoint& m) {
  for (std::size_t i = 0; i < 3; ++i) {
    if (!std::isfinite(m.position[i]) && !std::isfinite(m.velocity[i]) &&
        !std::isfinite(m.acceleration[i])) {
      return false;
    }
  }
  return true;
}

}  // namespace

Result<Autopilot> Autopilot::create(const Config& config, Wire& wire, std::int64_t now_ns) {
  auto airframe = Airframe::create(config);
  if (!airframe) return airframe.error();
  return Autopilot(config, *std::move(airframe), wire, now_ns);
}

Autopilot::Autopilot(const Config& config, Airframe airframe, Wire& wire, std::int64_t now_ns)
    : config_(config),
      airframe_(std::move(airframe)),
      wire_(&wire),
      frame_({config.origin_x_m, config.origin_y_m, config.origin_z_m}, config.origin_yaw_rad),
      external_(config.release),
      boot_ns_(now_ns),
      now_ns_(now_ns) {}

void Autopilot::hear(const OffboardControlMode& m) {
  offboard_ = m;
  offboard_ns_ = now_ns_;
}

void Autopilot::hear(const TrajectorySetpoint& m) {
  trajectory_ = m;
  trajectory_ns_ = now_ns_;
}

void Autopilot::hear(const VehicleAttitudeSetpoint& m) {
  attitude_ = m;
  attitude_ns_ = now_ns_;
}

void Autopilot::hear(const VehicleControlMode& m) {
  if (config_.release < Release::v1_18 && m.source_id == external_.mode()) {
    external_attitude_ = !m.position;
  }
}

void Autopilot::hear(const SetpointConfig& m) {
  if (config_.release < Release::v1_18 || m.source_id != external_.mode()) return;
  if (m.should_apply) external_attitude_ = m.type == SetpointConfig::kAttitude;
  SetpointConfigReply reply;
  reply.type = m.type;
  reply.source_id = m.source_id;
  wire_->send(reply);
}

void Autopilot::advance(std::int64_t now_ns) {
  while (now_ns_ + kStep_ns <= now_ns) {
    now_ns_ += kStep_ns;
    step();
  }
}

void Autopilot::step() {
  external_.step(now_ns_, *wire_);
  decide();
  fly();
  const bool is_down = airframe_.on_ground();
  // While somebody still sends setpoints, PX4 does not see that it has landed.
  const bool streams = nav_state_ == nav_state::kOffboard || nav_state_ == external_.mode();
  if (!is_down) flew_ = true;
  if (is_down && !landed_ && !streams) landed_ns_ = now_ns_;
  landed_ = is_down && (landed_ || !streams);
  if (landed_ && flew_ && lift_ == Lift::flying) lift_ = Lift::ready;
  disarm_if_done();
  report();
}

LocalState Autopilot::local() const {
  const RigidBodyState& truth = airframe_.state();
  return {frame_.point(truth.position_map), frame_.vector(truth.velocity_map),
          frame_.attitude(truth.q_map_base)};
}

double Autopilot::yaw() const {
  const Eigen::Matrix3d attitude = frame_.attitude(airframe_.state().q_map_base);
  return std::atan2(attitude(1, 0), attitude(0, 0));
}

void Autopilot::fly() {
  const TrajectorySetpoint wanted = wanted_setpoint();
  lift(wanted);
  if (lift_ != Lift::flying || airframe_.on_ground()) return;
  if (!armed_) airframe_.cut();
  Thrust thrust;
  if (flies_attitude()) {
    const double u = std::clamp(-double(attitude_.thrust_body[2]), 0.0, 1.0);
    thrust.acceleration_m_s2 = u / config_.hover_thrust * kGravity_m_s2;
    const auto& q = attitude_.q_d;
    thrust.attitude = Quaternion(q[0], q[1], q[2], q[3]).normalized().toRotationMatrix();
  } else {
    thrust = control_.step(local(), wanted, config_.hover_thrust, Airframe::kStep_s);
  }
  AttitudeSetpoint command;
  command.thrust_n = airframe_.mass_kg() * thrust.acceleration_m_s2;
  command.q_map_base = frame_.attitude_to_map(thrust.attitude);
  airframe_.step(command);
}

// Motors spool up, thrust waits for a wish to rise, then comes slowly.
void Autopilot::lift(const TrajectorySetpoint& wanted) {
  const double since_s = double(now_ns_ - lift_ns_) * 1e-9;
  const auto go_on = [&](Lift next) {
    lift_ = next;
    lift_ns_ = now_ns_;
  };
  if (!armed_) {
    if (airframe_.on_ground()) lift_ = Lift::off;
  } else if (lift_ == Lift::off) {
    go_on(Lift::spooling);
  } else if (lift_ == Lift::spooling && since_s >= config_.spool_up_s) {
    go_on(Lift::ready);
  } else if (lift_ == Lift::ready && wants_up(wanted)) {
    go_on(Lift::ramping);
  } else if (lift_ == Lift::ramping && since_s >= config_.takeoff_ramp_s) {
    go_on(Lift::flying);
    control_.reset();
    airframe_.lift_off();
    begin_glide();
  } else if (lift_ == Lift::flying && airframe_.on_ground() && wants_up(wanted)) {
    airframe_.lift_off();  // it touched the ground, but nobody landed it
  }
}

// The takeoff trap: an external mode alone never lifts off.
bool Autopilot::wants_up(const TrajectorySetpoint& wanted) const {
  if (nav_state_ == nav_state::kTakeoff) return true;
  const bool fresh = trajectory_ns_ && now_ns_ - *trajectory_ns_ < kFresh_ns;
  if (nav_state_ != nav_state::kOffboard || !fresh) return false;
  return wanted.position[2] < float(local().position.z() - 0.02) || wanted.velocity[2] < 0.0f ||
         wanted.acceleration[2] < 0.0f;
}

bool Autopilot::flies_attitude() const {
  const bool given = attitude_ns_ && *attitude_ns_ > activated_ns_;
  if (nav_state_ == nav_state::kOffboard) {
    return given && offboard_.attitude && !offboard_.position && !offboard_.velocity &&
           !offboard_.acceleration;
  }
  return given && external_attitude_ && nav_state_ == external_.mode();
}

// The last setpoint, however old, if one came since the mode is active; else it stops.
TrajectorySetpoint Autopilot::wanted_setpoint() {
  const bool follows = nav_state_ == nav_state::kOffboard || nav_state_ == external_.mode();
  const bool given = trajectory_ns_ && *trajectory_ns_ >= activated_ns_ && is_valid(trajectory_);
  return follows && given ? trajectory_ : glide_setpoint();
}

void Autopilot::begin_glide() {
  const LocalState state = local();
  glide_ = {state.position, state.velocity, yaw()};
}

TrajectorySetpoint Autopilot::glide_setpoint() {
  const double dt_s = Airframe::kStep_s;
  Vec3 target = Vec3::Zero();  // [m/s]
  if (!airframe_.on_ground()) {
    if (nav_state_ == nav_state::kLand || nav_state_ == nav_state::kDescend) {
      target.z() = kLandSpeed_m_s;
    } else if (nav_state_ == nav_state::kTakeoff) {
      target.z() = std::clamp(climb_to_ned_ - glide_.position.z(), -kTakeoffSpeed_m_s, 0.0);
      if (target.z() > -0.02) intention_ = nav_state::kHold;
    }
  }
  const Vec3 change = target - glide_.velocity;
  const double most = kBrake_m_s2 * dt_s;
  glide_.velocity += change.norm() > most ? Vec3(change * (most / change.norm())) : change;
  glide_.position += dt_s * glide_.velocity;
  TrajectorySetpoint setpoint;
  setpoint.position = to_array(glide_.position);
  setpoint.velocity = to_array(glide_.velocity);
  setpoint.yaw = float(glide_.yaw_rad);
  return setpoint;
}

// What was stored before moves with the estimate.
void Autopilot::reset_estimate(const Vec3& delta_ned, double delta_heading) {
  frame_.reset(delta_ned, delta_heading, airframe_.state().position_map);
  if (delta_ned.head<2>().norm() > 0.0) ++xy_resets_, ++all_resets_;
  if (delta_ned.z() != 0.0) ++z_resets_, ++all_resets_;
  if (delta_heading != 0.0) ++heading_resets_, ++all_resets_;
  delta_ned_ = delta_ned;
  delta_heading_ = delta_heading;
  trajectory_.position = to_array(from_array(trajectory_.position) + delta_ned);
  trajectory_.yaw += float(delta_heading);
  glide_.position += delta_ned;
  glide_.yaw_rad += delta_heading;
  climb_to_ned_ += delta_ned.z();
}

}  // namespace goshawk::px4_stand_in
