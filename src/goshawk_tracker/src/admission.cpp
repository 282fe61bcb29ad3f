#include "goshawk/tracker/admission.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "clock_time.hpp"
#include "goshawk/core/vehicle.hpp"

namespace goshawk::tracker {
namespace {

constexpr double kAtRest = 1e-3;  // [m/s], [m/s^2]

Error refuse(const CommittedTrajectory& committed, ErrorCode code, const std::string& why) {
  return fail(code, "trajectory " + std::to_string(committed.id) + " refused: " + why);
}

bool is_finite(const FlatState& s) {
  return s.position.allFinite() && s.velocity.allFinite() && s.acceleration.allFinite();
}

Status check_numbers(const CommittedTrajectory& c) {
  const auto invalid = [&](const std::string& why) {
    return refuse(c, ErrorCode::invalid_input, why);
  };
  if (auto status = c.trajectory.check(); !status) return invalid(status.error().message);
  if (!is_finite(c.start) || !is_finite(c.goal)) return invalid("its start or goal is not finite");
  if (!std::isfinite(c.yaw_rad)) return invalid("its yaw is not finite");
  if (!c.yaw_points_rad.empty()) {
    const bool steps = c.yaw_step_s > 0.0 && std::isfinite(c.yaw_step_s);
    if (!steps || c.yaw_points_rad.size() < 3 ||
        !std::ranges::all_of(c.yaw_points_rad, [](double v) { return std::isfinite(v); })) {
      return invalid("its curve of yaw needs three finite points and a step above zero");
    }
  }
  if (std::abs(double(c.start_time_ns)) > double(kTimeBound_ns)) {
    return invalid("its start time is outside the supported range");
  }
  if (auto status = c.limits.check(); !status) {
    return refuse(c, status.code(), status.error().message);
  }
  return success();
}

Status check_corridor(const CommittedTrajectory& c) {
  for (std::size_t k = 0; k < c.polytopes.size(); ++k) {
    const auto status = c.polytopes[k].check();
    if (status && c.polytopes[k].faces() > 0) continue;
    return refuse(c, ErrorCode::invalid_input,
                  "polytope " + std::to_string(k) + ": " +
                      (status ? "it has no face" : status.error().message));
  }
  for (const auto& piece : c.trajectory.pieces) {
    if (piece.polytope >= 0 && std::size_t(piece.polytope) < c.polytopes.size()) continue;
    return refuse(c, ErrorCode::invalid_input,
                  "a piece names polytope " + std::to_string(piece.polytope) + " of " +
                      std::to_string(c.polytopes.size()));
  }
  return success();
}

Status check_certificate(const CommittedTrajectory& c) {
  const auto certificate = measure(c.trajectory, c.polytopes, c.limits, c.start, c.goal);
  if (!certificate.holds()) {
    return refuse(c, ErrorCode::not_certified,
                  "its certificate does not hold when recomputed: " + certificate.worst());
  }
  const auto& last = c.trajectory.pieces.back();
  const auto end = last.sample(last.duration_s);
  if (!(end.velocity.norm() <= kAtRest && end.acceleration.norm() <= kAtRest)) {
    return refuse(c, ErrorCode::not_certified,
                  "it does not end at rest (velocity " + to_text(end.velocity) +
                      " m/s); plan it to a stop, so that it is safe when no other follows");
  }
  return success();
}

// Forces within a tilt and below a thrust form a convex set, so that the acceleration's control
// points bound the whole curve (hull property). Least thrust is not convex; the height of the
// force bounds it from below and is.
Status check_thrust(const CommittedTrajectory& c, const Config& config) {
  for (const auto& piece : c.trajectory.pieces) {
    const auto points = piece.acceleration_points();
    for (int j = 0; j < points.cols(); ++j) {
      const Vec3 force = config.mass_kg * (points.col(j) + Vec3(0.0, 0.0, kGravity_m_s2));
      const double tilt = std::atan2(force.head<2>().norm(), force.z());
      if (force.norm() <= config.max_thrust_n && force.z() >= config.min_thrust_n &&
          tilt <= config.max_tilt_rad) {
        continue;
      }
      char text[200];
      std::snprintf(text, sizeof text,
                    "it needs a thrust of %.3g N at a tilt of %.3g rad; the vehicle is flown "
                    "between %.3g and %.3g N up to %.3g rad: plan with a lower a_max",
                    force.norm(), tilt, config.min_thrust_n, config.max_thrust_n,
                    config.max_tilt_rad);
      return refuse(c, ErrorCode::trajectory_infeasible, text);
    }
  }
  return success();
}

}  // namespace

Status admit(const CommittedTrajectory& committed, const Config& config) {
  if (auto status = check_numbers(committed); !status) return status;
  if (auto status = check_corridor(committed); !status) return status;
  if (auto status = check_certificate(committed); !status) return status;
  return check_thrust(committed, config);
}

}  // namespace goshawk::tracker
