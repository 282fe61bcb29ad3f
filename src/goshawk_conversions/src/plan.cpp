#include "goshawk/conversions/plan.hpp"

#include <cmath>

namespace goshawk::conversions {
namespace {

bool is_finite(const FlatState& s) {
  return s.position.allFinite() && s.velocity.allFinite() && s.acceleration.allFinite();
}

}  // namespace

Result<PlanRequest> from_msg(const goshawk_msgs::msg::PlanRequest& m) {
  if (auto status = check_frame(m.header(), kMapFrame, "a plan request"); !status) {
    return status.error();
  }
  PlanRequest request;
  request.id = m.id();
  request.stamp_ns = to_ns(m.header().stamp());
  request.start = from_msg(m.start());
  request.goal = from_msg(m.goal());
  request.other_goals_map = from_msg(m.other_goals());
  request.goal_yaw_rad = m.goal_yaw();
  request.deadline_s = m.deadline();
  request.duration_s = m.duration();
  for (const auto& [name, state] :
       {std::pair{"start", &request.start}, std::pair{"goal", &request.goal}}) {
    if (is_finite(*state)) continue;
    return fail(ErrorCode::invalid_input,
                std::string("the ") + name + " state of a plan request is not finite: position " +
                    to_text(state->position) + ", velocity " + to_text(state->velocity) +
                    ", acceleration " + to_text(state->acceleration));
  }
  for (std::size_t k = 0; k < request.other_goals_map.size(); ++k) {
    if (request.other_goals_map[k].allFinite()) continue;
    return fail(ErrorCode::invalid_input,
                "other goal " + std::to_string(k) +
                    " of a plan request is not finite: " + to_text(request.other_goals_map[k]));
  }
  if (!std::isfinite(m.goal_yaw()) || !(m.deadline() >= 0.0 && std::isfinite(m.deadline()))) {
    return fail(ErrorCode::invalid_input,
                "the goal's yaw or the deadline of a plan request is not finite, or the deadline "
                "is below zero");
  }
  if (!(m.duration() >= 0.0 && std::isfinite(m.duration()))) {
    return fail(ErrorCode::invalid_input,
                "the duration of a plan request is " + std::to_string(m.duration()) +
                    " s: 0 (as fast as the limits allow) or more is meant");
  }
  auto limits = from_msg(m.limits());
  if (!limits) return limits.error();
  request.limits = *limits;
  return request;
}

goshawk_msgs::msg::PlanRequest to_msg(const PlanRequest& request) {
  goshawk_msgs::msg::PlanRequest m;
  m.header(make_header(request.stamp_ns));
  m.id(request.id);
  m.start(to_msg(request.start));
  m.goal(to_msg(request.goal));
  m.other_goals(to_points(request.other_goals_map));
  m.goal_yaw(request.goal_yaw_rad);
  m.limits(to_msg(request.limits));
  m.deadline(request.deadline_s);
  m.duration(request.duration_s);
  return m;
}

Status check_deadline(const PlanRequest& request, std::int64_t now_ns) {
  if (request.deadline_s == 0.0) return success();
  const double late_s = double(now_ns - request.stamp_ns) * 1e-9 - request.deadline_s;
  if (late_s <= 0.0) return success();
  return fail(ErrorCode::deadline_exceeded,
              "the request's deadline of " + std::to_string(request.deadline_s) + " s passed " +
                  std::to_string(late_s) +
                  " s ago: allow more time, or is this machine overloaded?");
}

Result<Limits> from_msg(const goshawk_msgs::msg::Limits& m) {
  if (m.norm() > 2) {
    return fail(ErrorCode::invalid_limits,
                "the limits' norm is " + std::to_string(m.norm()) +
                    ": 0 (Euclidean), 1 (each component) or 2 (horizontal and vertical) is meant");
  }
  const Limits limits{.v_max_m_s = m.v_max(),
                      .a_max_m_s2 = m.a_max(),
                      .norm = LimitNorm(m.norm()),
                      .j_max_m_s3 = m.j_max(),
                      .v_max_vertical_m_s = m.v_max_vertical(),
                      .a_max_vertical_m_s2 = m.a_max_vertical()};
  if (auto status = limits.check(); !status) return status.error();
  return limits;
}

goshawk_msgs::msg::Limits to_msg(const Limits& limits) {
  goshawk_msgs::msg::Limits m;
  m.v_max(limits.v_max_m_s);
  m.a_max(limits.a_max_m_s2);
  m.norm(std::uint8_t(limits.norm));
  m.j_max(limits.j_max_m_s3);
  m.v_max_vertical(limits.v_max_vertical_m_s);
  m.a_max_vertical(limits.a_max_vertical_m_s2);
  return m;
}

Result<std::vector<Vec3>> waypoints_of(const goshawk_msgs::msg::Path& m) {
  if (auto status = check_frame(m.header(), kMapFrame, "a path"); !status) return status.error();
  auto waypoints = from_msg(m.waypoints());
  if (waypoints.size() < 2) {
    return fail(ErrorCode::invalid_input, "a path has " + std::to_string(waypoints.size()) +
                                              " waypoints: two or more are needed");
  }
  for (std::size_t i = 0; i < waypoints.size(); ++i) {
    if (!waypoints[i].allFinite()) {
      return fail(ErrorCode::invalid_input,
                  "waypoint " + std::to_string(i) + " of a path is not finite");
    }
  }
  return waypoints;
}

Result<Corridor> from_msg(const goshawk_msgs::msg::Corridor& m) {
  if (auto status = check_frame(m.header(), kMapFrame, "a corridor"); !status) {
    return status.error();
  }
  Corridor corridor;
  corridor.waypoints_map = from_msg(m.waypoints());
  auto polytopes = from_msg(m.polytopes());
  if (!polytopes) return polytopes.error();
  corridor.polytopes = *std::move(polytopes);
  for (std::size_t k = 0; k + 1 < corridor.polytopes.size(); ++k) {
    corridor.overlaps.push_back(chebyshev_ball(corridor.polytopes[k], corridor.polytopes[k + 1]));
  }
  if (auto status = corridor.check(); !status) return status.error();
  return corridor;
}

Result<ReceivedTrajectory> from_msg(const goshawk_msgs::msg::BezierTrajectory& m) {
  if (auto status = check_frame(m.header(), kMapFrame, "a trajectory"); !status) {
    return status.error();
  }
  auto request = from_msg(m.request());
  if (!request) return request.error();
  auto polytopes = from_msg(m.polytopes());
  if (!polytopes) return polytopes.error();
  auto trajectory = from_msg(m.pieces(), polytopes->size());
  if (!trajectory) return trajectory.error();
  ReceivedTrajectory received{
      *std::move(request), *std::move(trajectory), *std::move(polytopes), {}};
  received.certificate = measure(received.trajectory, received.polytopes, received.request.limits,
                                 received.request.start, received.request.goal);
  if (!received.certificate.holds()) {
    return fail(ErrorCode::not_certified,
                "the trajectory of request " + std::to_string(received.request.id) +
                    " does not hold its certificate: " + received.certificate.worst());
  }
  return received;
}

}  // namespace goshawk::conversions
