#include "goshawk/simulator/quadrotor.hpp"

#include <fmt/format.h>

#include <cmath>

namespace goshawk::simulator {

using plant::PlantFactory;
using plant::PlantState;

namespace {

constexpr double kStep_s = double(Quadrotor::kStep_ns) * 1e-9;
constexpr double kDisturbanceBandwidth_rad_s = 3.0;
constexpr double kMaxRate_rad_s = 100.0;
constexpr double kMaxAdvance_s = 3600.0;

Wind::Parameters wind_of(const Config& c) {
  return {.mean_map = {c.wind_x_m_s, c.wind_y_m_s, c.wind_z_m_s},
          .gust_deviation_m_s = c.gust_deviation_m_s,
          .gust_time_s = c.gust_time_s,
          .seed = std::uint64_t(c.gust_seed)};
}

Status check(const AttitudeSetpoint& command) {
  const auto refuse = [](const std::string& why) {
    return fail(ErrorCode::invalid_input, "command refused: " + why);
  };
  if (!std::isfinite(command.thrust_n)) return refuse("the thrust is not finite");
  if (command.thrust_n < 0.0) {
    return refuse(fmt::format("the thrust is {:.3g} N: it must not be negative", command.thrust_n));
  }
  const double norm = command.q_map_base.norm();
  if (!(std::abs(norm - 1.0) <= 1e-3)) {
    return refuse(fmt::format("the attitude's quaternion has length {:.3g}: it must be 1", norm));
  }
  if (!(command.angular_velocity_base.norm() <= kMaxRate_rad_s)) {
    return refuse(fmt::format("the body rates are not finite or above {} rad/s", kMaxRate_rad_s));
  }
  return success();
}

}  // namespace

Result<Quadrotor> Quadrotor::create(const Config& config, const PlantFactory& make_plant) {
  if (auto status = simulator::check(config); !status) return status.error();
  return Quadrotor(config, make_plant);
}

Quadrotor::Quadrotor(const Config& config, const PlantFactory& make_plant)
    : config_(config),
      plant_(make_plant(config.vehicle)),
      mixer_(config.vehicle),
      inertia_kg_m2_(config.vehicle.inertia_kg_m2()),
      wind_(wind_of(config), kStep_s),
      sensor_(config.sensor, kStep_ns),
      hold_(config.vehicle, config.failsafe_tilt_rad),
      fallback_(config.vehicle, config.failsafe_tilt_rad, config.fallback_tolerance_m),
      guard_(config.landing, config.land_height_m),
      command_timeout_ns_(std::llround(config.command_timeout_s * 1e9)),
      landing_ns_(command_timeout_ns_ + std::llround(config.failsafe_hold_s * 1e9)) {
  if (!reset(Vec3::Zero(), 0.0)) throw std::logic_error("a quadrotor cannot hover at the origin");
}

Status Quadrotor::reconfigure(const Config& config) {
  if (auto status = simulator::check(config); !status) return status;
  if (auto status = check_change(config_, config); !status) return status;
  config_ = config;
  wind_.change(wind_of(config).mean_map, config.gust_deviation_m_s);
  return success();
}

Status Quadrotor::reset(const Vec3& position_map, double yaw_rad) {
  if (!position_map.allFinite() || !std::isfinite(yaw_rad)) {
    return fail(ErrorCode::invalid_input,
                fmt::format("cannot reset to {} with yaw {} rad: position and yaw must be finite",
                            to_text(position_map), yaw_rad));
  }
  PlantState state;
  state.body.position_map = position_map;
  state.body.q_map_base = Eigen::AngleAxisd(yaw_rad, Vec3::UnitZ());
  const auto& v = config_.vehicle;
  state.rotor_speed_rad_s.setConstant(std::sqrt(v.weight_n() / 4.0 / v.thrust_coefficient_n_s2));
  plant_->reset(state);
  wind_ = Wind(wind_of(config_), kStep_s);
  sensor_.reset(state.body, time_ns_);
  hold_.engage_at(position_map, yaw_rad);
  control_ = Control::failsafe;
  not_landing_ = {ErrorCode::ok, ""};
  was_commanded_ = flies_fallback_ = false;
  fallback_.forget();
  disturbance_map_.setZero();
  remainder_ns_ = 0;
  return success();
}

Status Quadrotor::command(const AttitudeSetpoint& command) {
  if (auto status = check(command); !status) return status;
  command_ = command;
  command_.q_map_base.normalize();
  command_time_ns_ = time_ns_;
  control_ = Control::commanded;
  not_landing_ = {ErrorCode::ok, ""};
  was_commanded_ = true;
  flies_fallback_ = false;
  return success();
}

Vec4 Quadrotor::rotor_thrust_n() const {
  return config_.vehicle.thrust_coefficient_n_s2 * plant_->state().rotor_speed_rad_s.cwiseAbs2();
}

Status Quadrotor::advance(double dt_s) {
  if (!(dt_s >= 0.0 && dt_s <= kMaxAdvance_s)) {
    return fail(ErrorCode::invalid_input,
                fmt::format("cannot advance by {} s: a time step must be from 0 to {} s", dt_s,
                            kMaxAdvance_s));
  }
  remainder_ns_ += std::llround(dt_s * 1e9);
  for (; remainder_ns_ >= kStep_ns; remainder_ns_ -= kStep_ns) step();
  return success();
}

void Quadrotor::step() {
  const auto wrench = attitude_control(config_.attitude, inertia_kg_m2_, state(), onboard_target());
  const Vec4 thrust_n = mixer_.allocate(wrench);
  const Vec4 rotor_command =
      (thrust_n / config_.vehicle.thrust_coefficient_n_s2).cwiseMax(0.0).cwiseSqrt();
  const Vec3 velocity_map = state().velocity_map;
  plant_->step(rotor_command, wind_.velocity_map(), kStep_s);
  learn_disturbance(velocity_map);
  wind_.step();
  time_ns_ += kStep_ns;
  sensor_.record(state(), time_ns_);
}

// The accelerometer measures thrust and air forces; thrust is known, the rest is the disturbance.
// It is estimated all the time, so that a failsafe in wind begins with the right compensation.
void Quadrotor::learn_disturbance(const Vec3& last_velocity_map) {
  const Vec3 acceleration = (state().velocity_map - last_velocity_map) / kStep_s;
  const Vec3 thrust =
      rotor_thrust_n().sum() / config_.vehicle.mass_kg * (state().q_map_base * Vec3::UnitZ());
  const Vec3 felt = acceleration + Vec3(0.0, 0.0, kGravity_m_s2) - thrust;
  disturbance_map_ += kDisturbanceBandwidth_rad_s * kStep_s * (felt - disturbance_map_);
}

AttitudeSetpoint Quadrotor::onboard_target() {
  watch_commands();
  if (control_ == Control::commanded) return command_;
  if (flies_fallback_) return fallback_.step(state(), time_ns_, disturbance_map_);
  if (control_ == Control::landing) {
    hold_.lower(config_.land_speed_m_s * kStep_s, config_.land_height_m);
  }
  return hold_.step(state(), disturbance_map_);
}

// When commands stop coming, the vehicle comes to rest, holds, then lands.
void Quadrotor::watch_commands() {
  const std::int64_t silent_ns = time_ns_ - command_time_ns_;
  if (control_ == Control::commanded && silent_ns >= command_timeout_ns_) lose_commands();
  if (flies_fallback_) {
    if (const auto end = fallback_.ended(time_ns_)) {
      hold_.engage_at(*end, yaw_of(state().q_map_base));
      flies_fallback_ = false;
    }
  }
  if (control_ == Control::failsafe && was_commanded_ && !flies_fallback_ && !hold_.braking() &&
      silent_ns >= landing_ns_ && not_landing_.code == ErrorCode::ok) {
    try_to_land();
  }
}

void Quadrotor::lose_commands() {
  control_ = Control::failsafe;
  flies_fallback_ = fallback_.engage(state(), time_ns_);
  if (!flies_fallback_) hold_.engage(state());
}

// Checks once per map. It looks below the vehicle, not below the point that it holds: wind keeps
// the two apart all the way down.
void Quadrotor::try_to_land() {
  const Status answer = guard_.check(state().position_map);
  if (answer) {
    control_ = Control::landing;
  } else {
    not_landing_ = answer.error();
  }
}

void Quadrotor::set_map(std::shared_ptr<const VoxelGrid> grid) {
  guard_.set_map(std::move(grid));
  not_landing_ = {ErrorCode::ok, ""};
  const bool is_down = hold_.position_map().z() <= config_.land_height_m;
  if (control_ != Control::landing || is_down) return;
  try_to_land();
  if (not_landing_.code == ErrorCode::ok) return;
  control_ = Control::failsafe;
  hold_.engage(state());
}

}  // namespace goshawk::simulator
