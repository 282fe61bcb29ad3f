#include "plan_messages.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>

#include "goshawk/conversions/geometry.hpp"

namespace goshawk::guard {
namespace {

using conversions::check_frame;
using conversions::kMapFrame;

std::optional<std::int64_t> start_of(const builtin_interfaces::msg::Time& stamp) {
  const std::int64_t start_ns = conversions::to_ns(stamp);
  return start_ns != 0 ? std::optional(start_ns) : std::nullopt;
}

Status check_frames(const nav_msgs::msg::Path& m) {
  if (auto status = check_frame(m.header(), kMapFrame, "a path"); !status) return status;
  for (const auto& pose : m.poses()) {
    if (pose.header().frame_id().empty()) continue;  // the path's own
    if (auto status = check_frame(pose.header(), kMapFrame, "a pose of a path"); !status) {
      return status;
    }
  }
  return success();
}

Result<Sample> sample_of(const trajectory_msgs::msg::MultiDOFJointTrajectoryPoint& m,
                         std::size_t index) {
  if (m.transforms().size() != 1 || m.velocities().size() > 1 || m.accelerations().size() > 1) {
    return fail(
        ErrorCode::invalid_input,
        fmt::format("point {} has {} transforms, {} velocities and {} accelerations: one "
                    "transform is needed, and at most one of the others",
                    index, m.transforms().size(), m.velocities().size(), m.accelerations().size()));
  }
  const auto& after = m.time_from_start();
  Sample sample{.t_s = double(after.sec()) + 1e-9 * double(after.nanosec()),
                .position = conversions::from_msg(m.transforms()[0].translation())};
  if (!m.velocities().empty()) sample.velocity = conversions::from_msg(m.velocities()[0].linear());
  if (!m.accelerations().empty()) {
    sample.acceleration = conversions::from_msg(m.accelerations()[0].linear());
  }
  return sample;
}

}  // namespace

Result<Plan> plan_of(const nav_msgs::msg::Path& m) {
  if (auto status = check_frames(m); !status) return status.error();
  const auto& poses = m.poses();
  const auto time_ns = [&](std::size_t i) { return conversions::to_ns(poses[i].header().stamp()); };
  bool has_times = false;
  for (std::size_t i = 1; i < poses.size(); ++i) has_times |= time_ns(i) != time_ns(0);
  if (!has_times) {
    Waypoints waypoints;
    for (const auto& p : poses) {
      waypoints.points_map.push_back(conversions::from_msg(p.pose().position()));
    }
    return Plan{.kind = PlanKind::path, .shape = std::move(waypoints)};
  }
  Samples samples;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    samples.samples.push_back({.t_s = double(time_ns(i) - time_ns(0)) * 1e-9,
                               .position = conversions::from_msg(poses[i].pose().position())});
  }
  return Plan{.kind = PlanKind::path,
              .start_time_ns = start_of(poses[0].header().stamp()),
              .shape = std::move(samples)};
}

Result<Plan> plan_of(const trajectory_msgs::msg::MultiDOFJointTrajectory& m) {
  if (auto status = check_frame(m.header(), kMapFrame, "a trajectory"); !status) {
    return status.error();
  }
  Samples samples;
  for (std::size_t i = 0; i < m.points().size(); ++i) {
    auto sample = sample_of(m.points()[i], i);
    if (!sample) return sample.error();
    samples.samples.push_back(*std::move(sample));
  }
  auto start_ns = start_of(m.header().stamp());
  // The first point is where the plan begins.
  const double first_s = samples.samples.empty() ? 0.0 : samples.samples.front().t_s;
  for (Sample& sample : samples.samples) sample.t_s -= first_s;
  if (start_ns) *start_ns += std::int64_t(first_s * 1e9);
  return Plan{.kind = PlanKind::trajectory, .start_time_ns = start_ns, .shape = std::move(samples)};
}

Result<Plan> plan_of(const goshawk_msgs::msg::PolynomialPlan& m) {
  if (auto status = check_frame(m.header(), kMapFrame, "a polynomial plan"); !status) {
    return status.error();
  }
  Polynomials polynomials;
  for (const auto& piece : m.pieces()) {
    polynomials.pieces.push_back({piece.duration(), {piece.x(), piece.y(), piece.z()}});
  }
  return Plan{.kind = PlanKind::polynomial,
              .start_time_ns = start_of(m.start_time()),
              .shape = std::move(polynomials)};
}

Result<Plan> plan_of(const goshawk_msgs::msg::BsplinePlan& m) {
  if (auto status = check_frame(m.header(), kMapFrame, "a B-spline plan"); !status) {
    return status.error();
  }
  Bspline spline{.degree = int(std::min<std::uint32_t>(m.degree(), 100)),
                 .knots_s = m.knots(),
                 .control_points_map = conversions::from_msg(m.control_points())};
  return Plan{.kind = PlanKind::bspline,
              .start_time_ns = start_of(m.start_time()),
              .shape = std::move(spline)};
}

}  // namespace goshawk::guard
