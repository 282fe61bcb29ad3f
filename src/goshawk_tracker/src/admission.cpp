#include "goshawk/tracker/admission.hpp"

#include <fmt/format.h>

#include "goshawk/core/thrust.hpp"

namespace goshawk::tracker {

namespace {

constexpr std::size_t kMostPieces = 4096;

}  // namespace

Status admit(const CommittedTrajectory& committed, const Config& config) {
  if (committed.flown().pieces.size() > kMostPieces) {
    return fail(ErrorCode::invalid_input,
                fmt::format("trajectory {} refused: it has {} pieces; each control step looks "
                            "through them, and {} are allowed",
                            committed.id(), committed.flown().pieces.size(), kMostPieces));
  }
  const double mass = config.mass_kg;
  const ThrustUse use = thrust_of(committed.flown());
  if (respects(use,
               {config.max_thrust_n / mass, config.min_thrust_n / mass, config.max_tilt_rad})) {
    return success();
  }
  return fail(
      ErrorCode::trajectory_infeasible,
      fmt::format("trajectory {} refused: it needs thrusts of {:.3g} to {:.3g} N and a tilt "
                  "of {:.3g} rad; the tracker's bounds are {:.3g} to {:.3g} N and {:.3g} "
                  "rad: plan with a lower a_max",
                  committed.id(), mass * use.thrust_least_m_s2, mass * use.thrust_most_m_s2,
                  use.tilt_rad, config.min_thrust_n, config.max_thrust_n, config.max_tilt_rad));
}

}  // namespace goshawk::tracker
