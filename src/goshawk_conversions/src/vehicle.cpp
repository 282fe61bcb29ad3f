#include "goshawk/conversions/vehicle.hpp"

#include <fmt/format.h>

#include <cmath>

namespace goshawk::conversions {

namespace {

constexpr double kShortest = 1e-6;  // a shorter quaternion has no direction that could be meant

}  // namespace

Result<Quaternion> from_msg(const geometry_msgs::msg::Quaternion& m) {
  const Quaternion q(m.w(), m.x(), m.y(), m.z());
  const double length = q.coeffs().stableNorm();
  if (!(length >= kShortest && std::isfinite(length))) {  // NaN fails as well
    return fail(ErrorCode::invalid_input,
                fmt::format("a quaternion (x {:.3g}, y {:.3g}, z {:.3g}, w {:.3g}) is no rotation: "
                            "it must be finite and not zero; without a rotation w is 1",
                            m.x(), m.y(), m.z(), m.w()));
  }
  return Quaternion(Eigen::Vector4d(q.coeffs() / length));
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

Result<GoalPose> from_msg(const geometry_msgs::msg::PoseStamped& m) {
  if (auto s = check_frame(m.header(), kMapFrame, "a goal"); !s) return s.error();
  const auto q = from_msg(m.pose().orientation());
  if (!q) return fail(q.code(), "the goal's orientation: " + q.error().message);
  const GoalPose goal{from_msg(m.pose().position()), yaw_of(*q)};
  if (!goal.position_map.allFinite()) {
    return fail(ErrorCode::invalid_input,
                fmt::format("the goal's position {} is not finite", to_text(goal.position_map)));
  }
  return goal;
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

Result<FallbackStop> from_msg(const goshawk_msgs::msg::FallbackStop& m) {
  if (auto s = check_frame(m.header(), kMapFrame, "a fallback stop"); !s) return s.error();
  FallbackStop stop{.step_s = m.step(), .states = {}};
  stop.states.reserve(m.states().size());
  for (const auto& state : m.states()) stop.states.push_back(from_msg(state));
  if (auto status = stop.check(); !status) return status.error();
  return stop;
}

void fill_msg(const FallbackStop& stop, goshawk_msgs::msg::FallbackStop& m) {
  m.step(stop.step_s);
  m.states().resize(stop.states.size());
  for (std::size_t i = 0; i < stop.states.size(); ++i) m.states()[i] = to_msg(stop.states[i]);
}

}  // namespace goshawk::conversions
