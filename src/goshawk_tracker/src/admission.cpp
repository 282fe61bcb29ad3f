#include "goshawk/tracker/admission.hpp"

#include <fmt/format.h>

#include <cmath>

#include "goshawk/core/vehicle.hpp"

namespace goshawk::tracker {

namespace {

constexpr std::size_t kMostPieces = 4096;

}  // namespace

// Forces within a tilt and below a thrust form a convex set, so that the acceleration's control
// points bound the whole curve (hull property). Least thrust is not convex; the height of the
// force bounds it from below and is.
Status admit(const CommittedTrajectory& committed, const Config& config) {
  if (committed.flown().pieces.size() > kMostPieces) {
    return fail(ErrorCode::invalid_input,
                fmt::format("trajectory {} refused: it has {} pieces; each control step looks "
                            "through them, and {} are allowed",
                            committed.id(), committed.flown().pieces.size(), kMostPieces));
  }
  for (const auto& piece : committed.flown().pieces) {
    const auto points = piece.acceleration_points();
    for (int j = 0; j < points.cols(); ++j) {
      const Vec3 force = config.mass_kg * (points.col(j) + Vec3(0.0, 0.0, kGravity_m_s2));
      const double tilt = std::atan2(force.head<2>().norm(), force.z());
      if (force.norm() <= config.max_thrust_n && force.z() >= config.min_thrust_n &&
          tilt <= config.max_tilt_rad) {
        continue;
      }
      return fail(ErrorCode::trajectory_infeasible,
                  fmt::format("trajectory {} refused: it needs a thrust of {:.3g} N at a tilt of "
                              "{:.3g} rad; the tracker's bounds are {:.3g} to {:.3g} N and {:.3g} "
                              "rad: plan with a lower a_max",
                              committed.id(), force.norm(), tilt, config.min_thrust_n,
                              config.max_thrust_n, config.max_tilt_rad));
    }
  }
  return success();
}

}  // namespace goshawk::tracker
