#include "goshawk/conversions/plan.hpp"

#include <fmt/format.h>

#include <utility>

namespace goshawk::conversions {
namespace {

namespace unknown_in = goshawk_msgs::msg::PlanRequest_Constants;
namespace norm_in = goshawk_msgs::msg::Limits_Constants;

static_assert(int(UnknownSpace::as_configured) == unknown_in::UNKNOWN_AS_CONFIGURED);
static_assert(int(UnknownSpace::blocked) == unknown_in::UNKNOWN_BLOCKED);
static_assert(int(UnknownSpace::free) == unknown_in::UNKNOWN_FREE);
static_assert(int(UnknownSpace::costly) == unknown_in::UNKNOWN_COSTLY);
static_assert(int(LimitNorm::euclidean) == norm_in::NORM_EUCLIDEAN);
static_assert(int(LimitNorm::per_axis) == norm_in::NORM_PER_AXIS);
static_assert(int(LimitNorm::horizontal_vertical) == norm_in::NORM_HORIZONTAL_VERTICAL);

// Names the trajectory in a sentence about it.
Error of_request(std::uint64_t id, const Error& error) {
  return fail(error.code, fmt::format("trajectory of request {}: {}", id, error.message));
}

}  // namespace

Result<PlanRequest> from_msg(const goshawk_msgs::msg::PlanRequest& m) {
  if (auto status = check_frame(m.header(), kMapFrame, "a plan request"); !status) {
    return status.error();
  }
  if (m.unknown() > unknown_in::UNKNOWN_COSTLY) {
    return fail(ErrorCode::invalid_input,
                fmt::format("a plan request takes unknown space as {}: use 0 (as configured), 1 "
                            "(blocked), 2 (free) or 3 (costly)",
                            m.unknown()));
  }
  const auto limits = from_msg(m.limits());
  if (!limits) return limits.error();
  PlanRequest request;
  request.id = m.id();
  request.stamp_ns = to_ns(m.header().stamp());
  if (const auto start_ns = to_ns(m.start_time()); start_ns != 0) request.start_time_ns = start_ns;
  request.start = from_msg(m.start());
  request.start_yaw_rad = m.start_yaw();
  request.start_yaw_rate_rad_s = m.start_yaw_rate();
  request.goal = from_msg(m.goal());
  request.other_goals_map = from_msg(m.other_goals());
  request.goal_yaw_rad = m.goal_yaw();
  request.limits = *limits;
  request.deadline_s = m.deadline();
  request.duration_s = m.duration();
  request.supersedes = m.supersedes();
  request.unknown = UnknownSpace(m.unknown());
  if (auto status = check(request); !status) return status.error();
  return request;
}

goshawk_msgs::msg::PlanRequest to_msg(const PlanRequest& request) {
  goshawk_msgs::msg::PlanRequest m;
  m.header(make_header(request.stamp_ns));
  m.id(request.id);
  m.start_time(to_stamp(request.start_time_ns.value_or(0)));
  m.start(to_msg(request.start));
  m.start_yaw(request.start_yaw_rad);
  m.start_yaw_rate(request.start_yaw_rate_rad_s);
  m.goal(to_msg(request.goal));
  m.other_goals(to_points(request.other_goals_map));
  m.goal_yaw(request.goal_yaw_rad);
  m.limits(to_msg(request.limits));
  m.deadline(request.deadline_s);
  m.duration(request.duration_s);
  m.supersedes(request.supersedes);
  m.unknown(std::uint8_t(request.unknown));
  return m;
}

Result<Limits> from_msg(const goshawk_msgs::msg::Limits& m) {
  if (m.norm() > norm_in::NORM_HORIZONTAL_VERTICAL) {
    return fail(ErrorCode::invalid_limits,
                fmt::format("the limits' norm is {}: use 0 (Euclidean), 1 (each component) or 2 "
                            "(horizontal and vertical)",
                            m.norm()));
  }
  return Limits{.v_max_m_s = m.v_max(),
                .a_max_m_s2 = m.a_max(),
                .norm = LimitNorm(m.norm()),
                .j_max_m_s3 = m.j_max(),
                .v_max_vertical_m_s = m.v_max_vertical(),
                .a_max_vertical_m_s2 = m.a_max_vertical()};
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
    return fail(ErrorCode::invalid_input,
                fmt::format("a path has {} waypoints: it needs two or more", waypoints.size()));
  }
  for (std::size_t i = 0; i < waypoints.size(); ++i) {
    if (!waypoints[i].allFinite()) {
      return fail(ErrorCode::invalid_input, fmt::format("waypoint {} of a path is not finite", i));
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
  return corridor;
}

Result<CertifiedTrajectory> from_msg(const goshawk_msgs::msg::BezierTrajectory& m) {
  const auto& request = m.request();
  if (auto status = check_frame(m.header(), kMapFrame, "a trajectory"); !status) {
    return status.error();
  }
  if (auto status = check_frame(request.header(), kMapFrame, "a trajectory's request"); !status) {
    return status.error();
  }
  const auto limits = from_msg(request.limits());
  if (!limits) return limits.error();
  auto polytopes = from_msg(m.polytopes());
  if (!polytopes) return of_request(request.id(), polytopes.error());
  auto certified = certify(from_msg(m.pieces()), *std::move(polytopes), *limits,
                           from_msg(request.start()), from_msg(request.goal()));
  if (!certified) return of_request(request.id(), certified.error());
  return certified;
}

Result<std::optional<YawCurve>> yaw_curve_of(const goshawk_msgs::msg::BezierTrajectory& m) {
  if (m.yaw_points().empty()) return std::optional<YawCurve>();
  YawCurve curve{m.yaw_step(), m.yaw_points()};
  if (auto status = curve.check(); !status) {
    return of_request(m.request().id(), status.error());
  }
  return std::optional<YawCurve>(std::move(curve));
}

void fill_yaw(const YawCurve& curve, goshawk_msgs::msg::BezierTrajectory& m) {
  m.yaw_step(curve.step_s);
  m.yaw_points(curve.points_rad);
}

namespace {

// From the nominal part's state to rest at the last control point.
Result<std::optional<StopPart>> stop_of(const goshawk_msgs::msg::CommittedTrajectory& m,
                                        const CertifiedTrajectory& nominal) {
  if (m.stop_after() == 0.0 && m.stop_pieces().empty()) return std::optional<StopPart>();
  if (!(m.stop_after() > 0.0 && m.stop_after() <= nominal.duration_s())) {
    return fail(ErrorCode::invalid_input,
                fmt::format("its stop part begins after {:.3g} s of a nominal part of {:.3g} s",
                            m.stop_after(), nominal.duration_s()));
  }
  auto polytopes = from_msg(m.stop_polytopes());
  if (!polytopes) return polytopes.error();
  Trajectory pieces = from_msg(m.stop_pieces());
  FlatState rest;
  if (!pieces.pieces.empty()) rest.position = pieces.pieces.back().control_points.col(5);
  auto certified = certify(std::move(pieces), *std::move(polytopes), nominal.limits(),
                           nominal.trajectory().sample(m.stop_after()), rest);
  if (!certified) {
    return fail(certified.code(), "its stop part: " + certified.error().message);
  }
  return std::optional<StopPart>({m.stop_after(), *std::move(certified)});
}

}  // namespace

Result<CommittedTrajectory> from_msg(const goshawk_msgs::msg::CommittedTrajectory& m) {
  const std::uint64_t id = m.nominal().request().id();
  if (auto status = check_frame(m.header(), kMapFrame, "a committed trajectory"); !status) {
    return status.error();
  }
  auto nominal = from_msg(m.nominal());
  if (!nominal) return nominal.error();
  auto stop = stop_of(m, *nominal);
  if (!stop) return of_request(id, stop.error());
  auto yaw_curve = yaw_curve_of(m.nominal());
  if (!yaw_curve) return yaw_curve.error();
  return CommittedTrajectory::make({.id = id,
                                    .nominal = *std::move(nominal),
                                    .stop = *std::move(stop),
                                    .start_time_ns = to_ns(m.start_time()),
                                    .map_version = m.map_version(),
                                    .yaw_rad = m.yaw(),
                                    .yaw_curve = *std::move(yaw_curve)});
}

void fill_msg(const CommittedTrajectory& committed, goshawk_msgs::msg::CommittedTrajectory& m) {
  m.start_time(to_stamp(committed.start_time_ns()));
  m.yaw(committed.yaw_rad());
  m.map_version(committed.map_version());
  const auto& stop = committed.stop();
  m.stop_after(stop ? stop->after_s : 0.0);
  m.stop_pieces(stop ? to_msg(stop->trajectory.trajectory())
                     : std::vector<goshawk_msgs::msg::BezierPiece>());
  m.stop_polytopes(stop ? to_msg(stop->trajectory.polytopes())
                        : std::vector<goshawk_msgs::msg::Polytope>());
}

}  // namespace goshawk::conversions
