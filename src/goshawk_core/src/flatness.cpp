#include "goshawk/core/flatness.hpp"

#include <cmath>
#include <numbers>

namespace goshawk {

AttitudeSetpoint thrust_attitude_of(const Vec3& specific_force_map,
                                    const Vec3& specific_force_rate_map, double yaw_rad,
                                    double yaw_rate_rad_s, double mass_kg) {
  const double force = specific_force_map.norm();
  const Vec3 heading(std::cos(yaw_rad), std::sin(yaw_rad), 0.0);
  const Vec3 heading_left(-heading.y(), heading.x(), 0.0);
  const Vec3 z = specific_force_map / force;
  const Vec3 x = heading_left.cross(z).normalized();
  const Vec3 y = z.cross(x);

  // The derivative of z is omega x z: its parts along x and y are omega_y and -omega_x.
  const Vec3 z_rate = (specific_force_rate_map - z.dot(specific_force_rate_map) * z) / force;
  const double omega_x = -y.dot(z_rate);
  const double omega_y = x.dot(z_rate);
  // x stays above or below the heading: the derivative of x . heading_left = 0 gives omega_z.
  const double omega_z =
      (omega_y * z.dot(heading_left) + yaw_rate_rad_s * x.dot(heading)) / y.dot(heading_left);

  Eigen::Matrix3d R_map_base;
  R_map_base << x, y, z;
  return {
      mass_kg * force, Eigen::Quaterniond(R_map_base).normalized(), {omega_x, omega_y, omega_z}};
}

double wrapped(double angle_rad) {
  return std::remainder(angle_rad, 2.0 * std::numbers::pi);
}

}  // namespace goshawk
