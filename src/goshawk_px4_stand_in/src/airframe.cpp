#include "goshawk/px4_stand_in/airframe.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

namespace goshawk::px4_stand_in {
namespace {

void must(const Status& status) {
  if (!status) throw std::logic_error(status.error().message);
}

}  // namespace

Status check(const Config& config) {
  ParameterFaults faults;
  describe(config, faults);
  if (faults.empty()) {
    if (const Status vehicle = simulator::check(config.vehicle); !vehicle) {
      faults.add(vehicle.error().message);
    }
  }
  return faults.status("px4_stand_in: ");
}

Result<Airframe> Airframe::create(const Config& config) {
  if (auto status = check(config); !status) return status.error();
  auto quadrotor = simulator::Quadrotor::create(config.vehicle);
  if (!quadrotor) return quadrotor.error();
  return Airframe(*std::move(quadrotor), config);
}

Airframe::Airframe(simulator::Quadrotor quadrotor, const Config& config)
    : quadrotor_(std::move(quadrotor)), ground_z_m_(ground_z_m(config)) {
  standing_.position_map = {config.start_x_m, config.start_y_m, ground_z_m_};
  standing_.q_map_base = Eigen::AngleAxisd(config.start_yaw_rad, Vec3::UnitZ());
}

void Airframe::lift_off() {
  must(quadrotor_.reset(standing_.position_map, yaw_of(standing_.q_map_base)));
  on_ground_ = cut_ = false;
}

void Airframe::step(const AttitudeSetpoint& command) {
  if (on_ground_) return;
  AttitudeSetpoint given = command;
  if (cut_) given.thrust_n = 0.0;
  must(quadrotor_.command(given));
  must(quadrotor_.advance(kStep_s));
  const RigidBodyState& state = quadrotor_.state();
  if (state.position_map.z() > ground_z_m_ || state.velocity_map.z() >= 0.0) return;
  touched_m_s_ = -state.velocity_map.z();
  standing_.position_map = {state.position_map.x(), state.position_map.y(), ground_z_m_};
  standing_.q_map_base = Eigen::AngleAxisd(yaw_of(state.q_map_base), Vec3::UnitZ());
  on_ground_ = true;
}

}  // namespace goshawk::px4_stand_in
