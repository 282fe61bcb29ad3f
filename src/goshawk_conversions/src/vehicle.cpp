#include "goshawk/conversions/vehicle.hpp"

#include <fmt/format.h>

#include <cmath>

namespace goshawk::conversions {
Result<Quaternion> from_msg(const geometry_msgs::msg::Quaternion& m) {
  const Quaternion q(m.w(), m.x(), m.y(), m.z());
  if (!(std::abs(q.norm() - 1.0) < 1e-3)) {  // NaN fails as well
    return fail(ErrorCode::invalid_input,
                fmt::format("an attitude quaternion has length {:.6g}: it must be 1 (w is the "
                            "scalar part)",
                            q.norm()));
  }
  return Quaternion(q.normalized());
}

geometry_msgs::msg::Quaternion to_msg(const Quaternion& q) {
  geometry_msgs::msg::Quaternion m;
  m.x(q.x());
  m.y(q.y());
  m.z(q.z());
  m.w(q.w());
  return m;
}

Result<RigidBodyState> from_msg(const nav_msgs::msg::Odometry& m) {
  if (auto s = check_frame(m.header(), kMapFrame, "odometry's pose"); !s) return s.error();
  if (m.child_frame_id() != kBodyFrame) {
    return fail(ErrorCode::wrong_frame,
                fmt::format("odometry's twist is in frame '{}', but must be in 'base_link' (FLU)",
                            m.child_frame_id()));
  }
  auto q = from_msg(m.pose().pose().orientation());
  if (!q) return q.error();
  RigidBodyState state;
  state.q_map_base = *q;
  state.position_map = from_msg(m.pose().pose().position());
  state.velocity_map = *q * from_msg(m.twist().twist().linear());
  state.angular_velocity_base = from_msg(m.twist().twist().angular());
  if (!state.is_finite()) {
    return fail(ErrorCode::invalid_input,
                fmt::format("odometry is not finite: position {}, velocity {}",
                            to_text(state.position_map), to_text(state.velocity_map)));
  }
  return state;
}

void fill_msg(const RigidBodyState& state, nav_msgs::msg::Odometry& m) {
  m.header().frame_id(std::string(kMapFrame));
  m.child_frame_id(std::string(kBodyFrame));
  m.pose().pose().position(to_point(state.position_map));
  m.pose().pose().orientation(to_msg(state.q_map_base));
  m.twist().twist().linear(to_vector(state.q_map_base.conjugate() * state.velocity_map));
  m.twist().twist().angular(to_vector(state.angular_velocity_base));
}

Result<AttitudeSetpoint> from_msg(const goshawk_msgs::msg::AttitudeSetpoint& m) {
  if (auto s = check_frame(m.header(), kMapFrame, "a thrust and attitude command"); !s) {
    return s.error();
  }
  auto q = from_msg(m.orientation());
  if (!q) return q.error();
  const AttitudeSetpoint command{m.thrust(), *q, from_msg(m.body_rate())};
  if (!(std::isfinite(m.thrust()) && m.thrust() >= 0.0 &&
        command.angular_velocity_base.allFinite())) {
    return fail(ErrorCode::invalid_input,
                fmt::format("a command's thrust or body rate is not finite, or its thrust of "
                            "{:.3g} N is below zero",
                            m.thrust()));
  }
  return command;
}

void fill_msg(const AttitudeSetpoint& command, goshawk_msgs::msg::AttitudeSetpoint& m) {
  m.thrust(command.thrust_n);
  m.orientation(to_msg(command.q_map_base));
  m.body_rate(to_vector(command.angular_velocity_base));
}

}  // namespace goshawk::conversions
