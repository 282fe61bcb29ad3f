#include "goshawk/movers/motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "yaw.hpp"

namespace goshawk::movers {

namespace {

constexpr double kTwoPi = 2.0 * std::numbers::pi;

}  // namespace

BoxState Still::at(double) const {
  return {.position_map = position_map, .q_map_box = from_yaw(yaw_rad)};
}

BoxState Turn::at(double t_s) const {
  const bool swings = amplitude_rad != 0.0;
  const double phase = std::remainder(rate_rad_s * t_s, kTwoPi);
  const double angle = swings ? amplitude_rad * std::sin(phase) : phase;
  const double rate = swings ? amplitude_rad * rate_rad_s * std::cos(phase) : rate_rad_s;
  const Quaternion q(Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis_map)));
  const Vec3 arm = q * arm_map;
  const Vec3 turn = rate * axis_map;
  return {pivot_map + arm, q, turn.cross(arm), turn};
}

double Turn::top_turn_rad_s() const {
  return std::abs(amplitude_rad != 0.0 ? amplitude_rad * rate_rad_s : rate_rad_s);
}

double Turn::top_speed_m_s() const {
  return top_turn_rad_s() * axis_map.cross(arm_map).norm();
}

BoxState Slide::at(double t_s) const {
  const double rate = kTwoPi / period_s, phase = std::remainder(rate * t_s, kTwoPi);
  BoxState state;
  state.position_map = center_map + std::sin(phase) * reach_map;
  state.velocity_map = rate * std::cos(phase) * reach_map;
  return state;
}

double Slide::top_speed_m_s() const {
  return kTwoPi / period_s * reach_map.norm();
}

BoxState Trefoil::at(double t_s) const {
  const double u = t_s / divisor_s + offset_rad;
  const Vec3& s = scale_m;
  BoxState state;
  state.position_map = center_map + Vec3(s.x() / 6.0 * (std::sin(u) + 2.0 * std::sin(2.0 * u)),
                                         s.y() / 5.0 * (std::cos(u) - 2.0 * std::cos(2.0 * u)),
                                         -s.z() / 2.0 * std::sin(3.0 * u));
  state.velocity_map = Vec3(s.x() / 6.0 * (std::cos(u) + 4.0 * std::cos(2.0 * u)),
                            s.y() / 5.0 * (-std::sin(u) + 4.0 * std::sin(2.0 * u)),
                            -1.5 * s.z() * std::cos(3.0 * u)) /
                       divisor_s;
  return state;
}

double Trefoil::top_speed_m_s() const {
  const Vec3 most(5.0 / 6.0 * scale_m.x(), scale_m.y(), 1.5 * scale_m.z());
  return most.norm() / divisor_s;
}

double Trefoil::length_m() const {
  // The sum over a whole period of something smooth and periodic converges geometrically.
  constexpr int kSteps = 512;
  double sum = 0.0;
  for (int i = 0; i < kSteps; ++i) sum += at(divisor_s * kTwoPi * i / kSteps).velocity_map.norm();
  return sum / kSteps * kTwoPi * divisor_s;
}

}  // namespace goshawk::movers
