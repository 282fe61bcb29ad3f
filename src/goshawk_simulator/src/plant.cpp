#include "goshawk/simulator/plant.hpp"

#include <Eigen/LU>

namespace goshawk::simulator {

using plant::PlantModel;
using plant::PlantState;
using plant::VehicleParameters;

namespace {

using Vec4 = Vec4;
using Packed = Eigen::Matrix<double, 17, 1>;

// Layout: position, velocity, quaternion (x, y, z, w), angular velocity, rotor speeds.
Packed pack(const PlantState& s) {
  Packed x;
  x << s.body.position_map, s.body.velocity_map, s.body.q_map_base.coeffs(),
      s.body.angular_velocity_base, s.rotor_speed_rad_s;
  return x;
}

PlantState unpack(const Packed& x) {
  PlantState s;
  s.body.position_map = x.segment<3>(0);
  s.body.velocity_map = x.segment<3>(3);
  s.body.q_map_base.coeffs() = x.segment<4>(6);
  s.body.angular_velocity_base = x.segment<3>(10);
  s.rotor_speed_rad_s = x.segment<4>(13);
  return s;
}

}  // namespace

Plant::Plant(const VehicleParameters& parameters)
    : parameters_(parameters),
      mixer_(parameters),
      inertia_kg_m2_(parameters.inertia_kg_m2()),
      inverse_inertia_(inertia_kg_m2_.inverse()) {}

PlantState Plant::step(const PlantState& state, const Vec4& rotor_command_rad_s,
                       const Vec3& wind_map, double dt_s) const {
  const auto f = [&](const Packed& x) { return derivative(x, rotor_command_rad_s, wind_map); };
  const Packed x = pack(state);
  const Packed k1 = f(x);
  const Packed k2 = f(x + dt_s / 2.0 * k1);
  const Packed k3 = f(x + dt_s / 2.0 * k2);
  const Packed k4 = f(x + dt_s * k3);
  PlantState next = unpack(x + dt_s / 6.0 * (k1 + 2.0 * k2 + 2.0 * k3 + k4));
  next.body.q_map_base.normalize();
  return next;
}

Vec3 Plant::acceleration_map(const PlantState& state, const Vec3& wind_map) const {
  return derivative(pack(state), state.rotor_speed_rad_s, wind_map).segment<3>(3);
}

Vec4 Plant::rotor_thrust_n(const Vec4& rotor_speed_rad_s) const {
  return parameters_.thrust_coefficient_n_s2 * rotor_speed_rad_s.cwiseAbs2();
}

Vec4 Plant::rotor_speed_rad_s(const Vec4& rotor_thrust_n) const {
  return (rotor_thrust_n / parameters_.thrust_coefficient_n_s2).cwiseMax(0.0).cwiseSqrt();
}

Packed Plant::derivative(const Packed& x, const Vec4& rotor_command_rad_s,
                         const Vec3& wind_map) const {
  const PlantState s = unpack(x);
  const auto& p = parameters_;
  // Inside a step the quaternion is not quite of unit length, but a rotation must be orthonormal.
  const Eigen::Matrix3d R_map_base = s.body.q_map_base.normalized().toRotationMatrix();
  const Wrench wrench = mixer_.wrench(rotor_thrust_n(s.rotor_speed_rad_s));

  const Vec3 airspeed_base = R_map_base.transpose() * (s.body.velocity_map - wind_map);
  const Vec3 linear(p.linear_drag_xy_kg_s, p.linear_drag_xy_kg_s, p.linear_drag_z_kg_s);
  const Vec3 drag_base = -linear.cwiseProduct(airspeed_base) -
                         p.quadratic_drag_kg_m * airspeed_base.norm() * airspeed_base;
  const Vec3 force_base = drag_base + Vec3(0.0, 0.0, wrench.thrust_n);

  const Vec3& omega = s.body.angular_velocity_base;
  const Eigen::Quaterniond omega_q(0.0, omega.x(), omega.y(), omega.z());

  Packed dx;
  dx.segment<3>(0) = s.body.velocity_map;
  dx.segment<3>(3) = R_map_base * force_base / p.mass_kg - Vec3(0.0, 0.0, kGravity_m_s2);
  dx.segment<4>(6) = 0.5 * (s.body.q_map_base * omega_q).coeffs();
  dx.segment<3>(10) =
      inverse_inertia_ * (wrench.torque_base_nm - omega.cross(inertia_kg_m2_ * omega));
  dx.segment<4>(13) = (rotor_command_rad_s - s.rotor_speed_rad_s) / p.motor_time_constant_s;
  return dx;
}

namespace {

class RigidBody : public PlantModel {
 public:
  explicit RigidBody(const VehicleParameters& parameters) : plant_(parameters) {}

  void reset(const PlantState& state) override { state_ = state; }
  void step(const Vec4& rotor_command_rad_s, const Vec3& wind_map, double dt_s) override {
    state_ = plant_.step(state_, rotor_command_rad_s, wind_map, dt_s);
  }
  const PlantState& state() const override { return state_; }
  Vec3 acceleration_map(const Vec3& wind_map) const override {
    return plant_.acceleration_map(state_, wind_map);
  }
  const char* name() const override { return "rigid_body_rk4"; }

 private:
  Plant plant_;
  PlantState state_;
};

}  // namespace

std::unique_ptr<PlantModel> make_rigid_body(const VehicleParameters& parameters) {
  return std::make_unique<RigidBody>(parameters);
}

}  // namespace goshawk::simulator
