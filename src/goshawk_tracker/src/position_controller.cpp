#include "goshawk/tracker/position_controller.hpp"

#include <algorithm>
#include <cmath>

#include "goshawk/core/flatness.hpp"

namespace goshawk::tracker {
namespace {

const Vec3 kUp_m_s2(0.0, 0.0, kGravity_m_s2);

Vec3 no_longer_than(double most, const Vec3& v) {
  const double length = v.norm();
  return length > most ? Vec3(most / length * v) : v;
}

}  // namespace

PositionController::PositionController(const Config& c)
    : geometric_(c.controller == "geometric"),
      mass_kg_(c.mass_kg),
      min_force_m_s2_(c.min_thrust_n / c.mass_kg),
      max_force_m_s2_(c.max_thrust_n / c.mass_kg),
      max_slope_(std::tan(c.max_tilt_rad)),
      max_position_error_m_(c.max_position_error_m),
      max_feedback_m_s2_(c.max_feedback_m_s2),
      max_body_rate_rad_s_(c.max_body_rate_rad_s),
      position_gain_1_s2_(c.position_xy_1_s2, c.position_xy_1_s2, c.position_z_1_s2),
      velocity_gain_1_s_(c.velocity_xy_1_s, c.velocity_xy_1_s, c.velocity_z_1_s),
      drag_1_s_(Vec3(c.linear_drag_xy_kg_s, c.linear_drag_xy_kg_s, c.linear_drag_z_kg_s) /
                c.mass_kg),
      observer_(c.disturbance_bandwidth_rad_s, c.max_disturbance_m_s2) {}

void PositionController::reset() {
  observer_.reset();
  last_force_m_s2_ = kGravity_m_s2;
}

AttitudeSetpoint PositionController::step(const RigidBodyState& state, const Target& target,
                                          double dt_s) {
  const Vec3 acceleration_model = modelled_acceleration(state);
  observer_.update(state.velocity_map, acceleration_model, dt_s);

  const Vec3 velocity_error = target.now.velocity - state.velocity_map;
  const Vec3 position_error =
      no_longer_than(max_position_error_m_, target.now.position - state.position_map);
  const Vec3 feedback_now = feedback(position_error, velocity_error);
  const Vec3 drag = drag_1_s_.cwiseProduct(target.ahead.velocity);
  const Vec3 force =
      limited(target.ahead.acceleration + kUp_m_s2 + drag +
              no_longer_than(max_feedback_m_s2_, feedback_now) - observer_.disturbance_map());

  Vec3 force_rate = target.ahead.jerk + drag_1_s_.cwiseProduct(target.ahead.acceleration);
  if (geometric_) {
    const Vec3 acceleration_error =
        target.now.acceleration - acceleration_model - observer_.disturbance_map();
    force_rate += feedback(velocity_error, acceleration_error);
  }

  auto command =
      thrust_attitude_of(force, force_rate, target.yaw_rad, target.yaw_rate_rad_s, mass_kg_);
  command.angular_velocity_base =
      no_longer_than(max_body_rate_rad_s_, command.angular_velocity_base);
  if (geometric_) {
    const double along_z = force.dot(state.q_map_base * Vec3::UnitZ());
    command.thrust_n = mass_kg_ * std::clamp(along_z, min_force_m_s2_, max_force_m_s2_);
  }
  last_force_m_s2_ = command.thrust_n / mass_kg_;
  return command;
}

Vec3 PositionController::feedback(const Vec3& position_error, const Vec3& velocity_error) const {
  return position_gain_1_s2_.cwiseProduct(position_error) +
         velocity_gain_1_s_.cwiseProduct(velocity_error);
}

// Height first: what the vertical part leaves of thrust and tilt is for the sides.
Vec3 PositionController::limited(Vec3 force) const {
  force.z() = std::clamp(force.z(), min_force_m_s2_, max_force_m_s2_);
  const double side = force.head<2>().norm();
  const double side_max = std::min(
      force.z() * max_slope_, std::sqrt(max_force_m_s2_ * max_force_m_s2_ - force.z() * force.z()));
  if (side > side_max) force.head<2>() *= side_max / side;
  return force;
}

// The thrust that was asked for last, along the axis that the body really has.
Vec3 PositionController::modelled_acceleration(const RigidBodyState& state) const {
  return last_force_m_s2_ * (state.q_map_base * Vec3::UnitZ()) - kUp_m_s2 -
         drag_1_s_.cwiseProduct(state.velocity_map);
}

}  // namespace goshawk::tracker
