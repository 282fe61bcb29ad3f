#include "goshawk/core/certified_trajectory.hpp"

#include <fmt/format.h>

#include <utility>

namespace goshawk {
namespace {

constexpr double kAtRest = 1e-3;  // [m/s], [m/s^2]

// What measure() would throw for, or answer with NaN.
Status check(const Trajectory& trajectory, const std::vector<Polytope>& polytopes,
             const Limits& limits, const FlatState& start, const FlatState& goal) {
  const auto invalid = [](std::string why) {
    return fail(ErrorCode::invalid_input, std::move(why));
  };
  if (auto status = trajectory.check(); !status) return status;
  for (std::size_t k = 0; k < trajectory.pieces.size(); ++k) {
    const int polytope = trajectory.pieces[k].polytope;
    if (polytope >= 0 && std::size_t(polytope) < polytopes.size()) continue;
    return invalid(fmt::format("piece {} names polytope {} of {}", k, polytope, polytopes.size()));
  }
  for (std::size_t k = 0; k < polytopes.size(); ++k) {
    if (auto status = polytopes[k].check(); !status) {
      return invalid(fmt::format("polytope {}: {}", k, status.error().message));
    }
  }
  if (auto status = limits.check(); !status) return status;
  if (!start.is_finite() || !goal.is_finite()) return invalid("its start or goal is not finite");
  return success();
}

}  // namespace

bool CertifiedTrajectory::ends_at_rest() const {
  const BezierPiece& last = trajectory_.pieces.back();
  const FlatState end = last.sample(last.duration_s);
  return end.velocity.norm() <= kAtRest && end.acceleration.norm() <= kAtRest;
}

Result<CertifiedTrajectory> certify(Trajectory trajectory, std::vector<Polytope> polytopes,
                                    const Limits& limits, const FlatState& start,
                                    const FlatState& goal) {
  if (auto status = check(trajectory, polytopes, limits, start, goal); !status) {
    return status.error();
  }
  CertifiedTrajectory certified;
  certified.certificate_ = measure(trajectory, polytopes, limits, start, goal);
  if (!certified.certificate_.holds()) {
    return fail(ErrorCode::not_certified,
                "the certificate does not hold: " + certified.certificate_.worst());
  }
  certified.trajectory_ = std::move(trajectory);
  certified.polytopes_ = std::move(polytopes);
  certified.limits_ = limits;
  certified.start_ = start;
  certified.goal_ = goal;
  return certified;
}

}  // namespace goshawk
